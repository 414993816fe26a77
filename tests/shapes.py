"""Parameters for every shape of membership functions."""

from __future__ import annotations

from hypothesis import strategies as st

import oracle

# Of a function around m that is about 2s wide.
AROUND = {
    "gaussian": lambda m, s: [m, s],
    "gaussian_width": lambda m, s: [m, s],
    "two_sided_gaussian": lambda m, s: [m - s / 4, s, m + s / 4, s],
    "bell": lambda m, s: [m, s, 1.5],
    "sigmoid": lambda m, s: [m, 4 / s],
    "sigmoid_difference": lambda m, s: [m - s, 4 / s, m + s, 4 / s],
    "sigmoid_product": lambda m, s: [m - s, 4 / s, m + s, -4 / s],
    "s_shape": lambda m, s: [m - s, m + s],
    "z_shape": lambda m, s: [m - s, m + s],
    "pi_shape": lambda m, s: [m - s, m - s / 4, m + s / 4, m + s],
    "triangular": lambda m, s: [m - s, m, m + s],
    "trapezoidal": lambda m, s: [m - s, m - s / 4, m + s / 4, m + s],
    "ramp": lambda m, s: [m + s, m - s],
    "rectangle": lambda m, s: [m - s, m + s],
    "singleton": lambda m, s: [m],  # noqa: ARG005
    "step": lambda m, s: [m, s],
    "concave": lambda m, s: [m, m + s],
    "cosine": lambda m, s: [m, 2 * s],
    "semi_ellipse": lambda m, s: [m - s, m + s],
    "arc": lambda m, s: [m - s, m + s],
    "spike": lambda m, s: [m, 10 * s],
    "points": lambda m, s: [m - s, 0.25, m, 1.0, m + s, 0.5],
}
assert set(AROUND) == set(oracle.SHAPES)

WITH_VERTICAL_SIDES = ["triangular", "trapezoidal", "pi_shape"]
EITHER_WAY = ["ramp", "concave", "arc"]

places = st.floats(-100, 100)
sizes = st.floats(1e-3, 100)
slopes = sizes | st.floats(-100, -1e-3)
sides = st.floats(1e-3, 50)


@st.composite
def functions(draw):
    """Draw a shape and valid parameters; sides are vertical or have a slope below 1000."""
    shape = draw(st.sampled_from(sorted(oracle.SHAPES)))
    first = draw(places)
    if shape.startswith("sigmoid"):
        pairs = draw(st.lists(st.tuples(places, slopes), min_size=2, max_size=2))
        return shape, [number for pair in pairs for number in pair][: oracle.PARAMETERS[shape]]
    if shape == "two_sided_gaussian":
        return shape, [first, draw(sizes), draw(places), draw(sizes)]
    if shape == "bell":
        return shape, [first, draw(sizes), draw(st.floats(0.1, 10))]
    if shape in ["gaussian", "gaussian_width", "cosine", "spike"]:
        return shape, [first, draw(sizes)]
    if shape == "step":
        return shape, [first, draw(st.sampled_from([1.0, -1.0]))]
    count = draw(st.integers(2, 6)) if shape == "points" else oracle.PARAMETERS[shape]
    gap = sides | st.just(0.0) if shape in WITH_VERTICAL_SIDES else sides
    vertices = [first]
    for _ in range(count - 1):
        vertices.append(vertices[-1] + draw(gap))
    if shape in WITH_VERTICAL_SIDES and vertices[0] == vertices[-1]:
        vertices[-1] += 1.0
    if shape in EITHER_WAY and draw(st.booleans()):
        vertices.reverse()
    if shape == "points":
        return shape, [number for x in vertices for number in (x, draw(st.floats(0, 1)))]
    return shape, vertices
