//! The forms of membership functions: their names, their parameters, what these may be.

use std::borrow::Cow;

use super::ParameterKind;
use crate::check;
use crate::error::{Error, Result};

/// The form of a membership function. [The module](super) has the names that other software uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Shape {
    /// exp(−½((x − m)/σ)²) with parameters `mean` m and `sigma` σ > 0, the standard deviation.
    Gaussian,
    /// exp(−((x − m)/w)²) with parameters `mean` m and `width` w > 0, the distance at which the
    /// degree has fallen to 1/e (w = √2 σ). The form of the thesis's equation 2.2, whose
    /// gradients 2.25–2.26 and learning rates belong to it.
    GaussianWidth,
    /// The product of exp(−½((x − m₁)/σ₁)²) left of `left_mean` m₁ and exp(−½((x − m₂)/σ₂)²)
    /// right of `right_mean` m₂, each 1 elsewhere, with `left_sigma` σ₁ > 0 and `right_sigma`
    /// σ₂ > 0. 1 from m₁ to m₂; where m₁ > m₂ it stays below 1.
    TwoSidedGaussian,
    /// 1/(1 + |(x − c)/w|²ˢ) with `centre` c, `width` w > 0, the distance at which the degree is
    /// ½, and `slope` s > 0, which is without unit: s/2w is the steepness there.
    Bell,
    /// σ(x) = 1/(1 + e^(−s(x − c))) with `centre` c, where the degree is ½, and `slope` s ≠ 0,
    /// positive to rise and negative to fall.
    Sigmoid,
    /// |σ₁(x) − σ₂(x)|, the difference of two sigmoids with `left_centre`, `left_slope`,
    /// `right_centre` and `right_slope`.
    SigmoidDifference,
    /// σ₁(x)·σ₂(x), the product of two sigmoids with `left_centre`, `left_slope`,
    /// `right_centre` and `right_slope`.
    SigmoidProduct,
    /// 0 at `a` and before, 1 at `b` and beyond, a < b, two parabolas between:
    /// 2u² up to the middle, 1 − 2(1 − u)² from there, with u = (x − a)/(b − a).
    SShape,
    /// 1 at `a` and before, 0 at `b` and beyond, a < b: 1 − [`SShape`](Self::SShape).
    ZShape,
    /// [`SShape`](Self::SShape) from `a` to `b`, 1 to `c`, [`ZShape`](Self::ZShape) from c to
    /// `d`; a ≤ b ≤ c ≤ d and a < d.
    PiShape,
    /// 0 at `a`, 1 at `b`, 0 at `c`, straight between; a ≤ b ≤ c and a < c.
    Triangular,
    /// 0 at `a`, 1 from `b` to `c`, 0 at `d`, straight between (2.1); a ≤ b ≤ c ≤ d and a < d.
    Trapezoidal,
    /// 0 at `start` and before, 1 at `end` and beyond, straight between; falls if start > end.
    Ramp,
    /// 1 from `a` to `b`, both included, 0 elsewhere; a < b.
    Rectangle,
    /// 1 exactly at `x`, 0 elsewhere.
    Singleton,
    /// 1 at `at` and on one side of it, the right if `direction` is positive, the left if it is
    /// negative; 0 on the other.
    Step,
    /// g/(g + (e − x)) before `end` e and 1 beyond, where g = e − i and the degree is ½ at
    /// `inflection` i ≠ e; rises to the right if i < e, to the left if i > e.
    Concave,
    /// ½(1 + cos(2π(x − c)/w)) within w/2 of `centre` c, 0 elsewhere, with `width` w > 0.
    Cosine,
    /// √(1 − ((x − c)/r)²) between `a` and `b`, a < b, with their middle c and r = (b − a)/2; 0
    /// elsewhere.
    SemiEllipse,
    /// A quarter of an ellipse: √(1 − ((x − e)/r)²) from `start` s to `end` e with r = e − s, 0
    /// before and 1 beyond; falls if s > e.
    Arc,
    /// exp(−|10(x − c)/w|) with `centre` c and `width` w > 0.
    Spike,
    /// Straight lines between points with parameters `x0`, `y0`, `x1`, `y1`, …: two points at
    /// least, x increasing, degrees y from 0 to 1; outside the degree of the nearest end.
    Points,
}

/// What has to hold between the parameters, beyond the range of each.
#[derive(Debug, Clone, Copy)]
pub(super) enum Relation {
    /// Nothing.
    None,
    /// They are vertices that don't decrease, the last above the first.
    Sorted,
    /// The two of them differ.
    Apart,
    /// They are pairs whose first numbers increase, two at least.
    Increasing,
}

impl Shape {
    /// Every shape.
    pub const ALL: [Self; 22] = [
        Self::Gaussian,
        Self::GaussianWidth,
        Self::TwoSidedGaussian,
        Self::Bell,
        Self::Sigmoid,
        Self::SigmoidDifference,
        Self::SigmoidProduct,
        Self::SShape,
        Self::ZShape,
        Self::PiShape,
        Self::Triangular,
        Self::Trapezoidal,
        Self::Ramp,
        Self::Rectangle,
        Self::Singleton,
        Self::Step,
        Self::Concave,
        Self::Cosine,
        Self::SemiEllipse,
        Self::Arc,
        Self::Spike,
        Self::Points,
    ];

    /// The name, the parameters (for points those of one), and what relates them.
    fn describe(self) -> (&'static str, &'static [(&'static str, ParameterKind)], Relation) {
        use ParameterKind::{Centre, Degree, Direction, Power, Slope, Vertex, Width};
        use Relation::{Apart, Increasing, None, Sorted};
        const SIGMOIDS: &[(&str, ParameterKind)] = &[
            ("left_centre", Centre),
            ("left_slope", Slope),
            ("right_centre", Centre),
            ("right_slope", Slope),
        ];
        const ENDS: &[(&str, ParameterKind)] = &[("start", Vertex), ("end", Vertex)];
        const VERTICES: &[(&str, ParameterKind)] =
            &[("a", Vertex), ("b", Vertex), ("c", Vertex), ("d", Vertex)];
        match self {
            Self::Gaussian => ("gaussian", &[("mean", Centre), ("sigma", Width)], None),
            Self::GaussianWidth => ("gaussian_width", &[("mean", Centre), ("width", Width)], None),
            Self::TwoSidedGaussian => (
                "two_sided_gaussian",
                &[
                    ("left_mean", Centre),
                    ("left_sigma", Width),
                    ("right_mean", Centre),
                    ("right_sigma", Width),
                ],
                None,
            ),
            Self::Bell => ("bell", &[("centre", Centre), ("width", Width), ("slope", Power)], None),
            Self::Sigmoid => ("sigmoid", &[("centre", Centre), ("slope", Slope)], None),
            Self::SigmoidDifference => ("sigmoid_difference", SIGMOIDS, None),
            Self::SigmoidProduct => ("sigmoid_product", SIGMOIDS, None),
            Self::SShape => ("s_shape", &VERTICES[..2], Sorted),
            Self::ZShape => ("z_shape", &VERTICES[..2], Sorted),
            Self::PiShape => ("pi_shape", VERTICES, Sorted),
            Self::Triangular => ("triangular", &VERTICES[..3], Sorted),
            Self::Trapezoidal => ("trapezoidal", VERTICES, Sorted),
            Self::Ramp => ("ramp", ENDS, Apart),
            Self::Rectangle => ("rectangle", &VERTICES[..2], Sorted),
            Self::Singleton => ("singleton", &[("x", Centre)], None),
            Self::Step => ("step", &[("at", Centre), ("direction", Direction)], None),
            Self::Concave => ("concave", &[("inflection", Vertex), ("end", Vertex)], Apart),
            Self::Cosine => ("cosine", &[("centre", Centre), ("width", Width)], None),
            Self::SemiEllipse => ("semi_ellipse", &VERTICES[..2], Sorted),
            Self::Arc => ("arc", ENDS, Apart),
            Self::Spike => ("spike", &[("centre", Centre), ("width", Width)], None),
            Self::Points => ("points", &[("x", Vertex), ("y", Degree)], Increasing),
        }
    }

    /// The name that files and messages use.
    pub fn name(self) -> &'static str {
        self.describe().0
    }

    /// The shape with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("membership function", name, Self::ALL, Self::name)
    }

    /// What has to hold between the parameters.
    pub(super) fn relation(self) -> Relation {
        self.describe().2
    }

    /// The number of parameters; `None` for points, which take any even number from 4.
    pub fn parameter_count(self) -> Option<usize> {
        let (_, parameters, _) = self.describe();
        (self != Self::Points).then_some(parameters.len())
    }

    /// The names of `count` parameters, in their order.
    pub fn parameter_names(self, count: usize) -> Vec<Cow<'static, str>> {
        let (_, parameters, _) = self.describe();
        let name = |index: usize| match (self, parameters[index % parameters.len()].0) {
            (Self::Points, name) => Cow::Owned(format!("{name}{}", index / parameters.len())),
            (_, name) => Cow::Borrowed(name),
        };
        (0..count).map(name).collect()
    }

    /// What the parameter with this index means.
    pub fn parameter_kind(self, index: usize) -> ParameterKind {
        let (_, parameters, _) = self.describe();
        parameters[index % parameters.len()].1
    }

    /// Whether the function consists of straight lines, with jumps between them at most: it then
    /// has [`vertices`](super::MembershipFunction::vertices).
    pub fn is_piecewise_linear(self) -> bool {
        matches!(
            self,
            Self::Triangular | Self::Trapezoidal | Self::Ramp | Self::Rectangle | Self::Points
        )
    }

    /// Whether the function rises or falls all the way from 0 to 1, so that a degree between
    /// belongs to one number: what Tsukamoto's rules conclude with.
    pub fn is_monotone(self) -> bool {
        matches!(
            self,
            Self::Ramp | Self::Sigmoid | Self::SShape | Self::ZShape | Self::Concave | Self::Arc
        )
    }

    /// Whether these are valid parameters of the shape, as many as it has.
    pub fn accepts(self, parameters: &[f64]) -> bool {
        let (_, known, relation) = self.describe();
        let kinds = known.iter().cycle().map(|(_, kind)| kind);
        self.takes(parameters.len())
            && parameters.iter().zip(kinds).all(|(&value, kind)| kind.accepts(value))
            && relation.size(parameters).is_finite()
            && relation.breach(parameters).is_none()
    }

    /// Nothing, if these are valid parameters of the shape; otherwise what is wrong with them.
    pub fn check(self, parameters: &[f64]) -> Result<()> {
        if self.accepts(parameters) {
            return Ok(());
        }
        let noun = self.noun();
        if !self.takes(parameters.len()) {
            let expected = match self.parameter_count() {
                Some(count) => count.to_string(),
                None => "an even number from 4".to_owned(),
            };
            let what = format!("parameters of {noun}");
            return Err(Error::wrong_shape(what, expected, parameters.len()));
        }
        let names = self.parameter_names(parameters.len());
        for (index, (name, &value)) in names.iter().zip(parameters).enumerate() {
            self.parameter_kind(index).check(&format!("{name} of {noun}"), value)?;
        }
        let (_, _, relation) = self.describe();
        check::finite(&format!("size of {noun}"), relation.size(parameters))?;
        let Some((index, other)) = relation.breach(parameters) else { return Ok(()) };
        let (value, rival) = (parameters[index], parameters[other]);
        if matches!(relation, Relation::Sorted) && value < rival {
            return Err(Error::CrossedVertices { function: noun, vertices: parameters.to_vec() });
        }
        let word = if matches!(relation, Relation::Apart) { "different from" } else { "above" };
        Err(Error::OutOfRange {
            what: format!("{} of {noun}", names[index]),
            expected: format!("{word} {} ({rival})", names[other]),
            value,
        })
    }

    /// Whether the shape can have so many parameters.
    fn takes(self, count: usize) -> bool {
        match self.parameter_count() {
            Some(expected) => count == expected,
            None => count >= 4 && count.is_multiple_of(2),
        }
    }

    /// What a message calls a function of this shape.
    fn noun(self) -> String {
        let article = if matches!(self, Self::Arc | Self::SShape) { "an" } else { "a" };
        format!("{article} {} membership function", self.name())
    }
}

impl Relation {
    /// The first parameter that breaks the relation, and the one that it breaks it with.
    fn breach(self, p: &[f64]) -> Option<(usize, usize)> {
        let last = p.len() - 1;
        match self {
            Self::None => None,
            Self::Sorted => (1..=last)
                .find(|&i| p[i] < p[i - 1])
                .map(|i| (i, i - 1))
                .or((p[last] <= p[0]).then_some((last, 0))),
            Self::Apart => (p[0] == p[1]).then_some((1, 0)),
            // Across a gap that is no normal number a line could be infinitely steep.
            Self::Increasing => (2..last)
                .step_by(2)
                .find(|&i| p[i] - p[i - 2] < f64::MIN_POSITIVE)
                .map(|i| (i, i - 2)),
        }
    }

    /// The distance from the first vertex to the last.
    fn size(self, p: &[f64]) -> f64 {
        match self {
            Self::None => 0.0,
            Self::Sorted | Self::Apart => p[p.len() - 1] - p[0],
            Self::Increasing => p[p.len() - 2] - p[0],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_to_their_shape() {
        for shape in Shape::ALL {
            assert_eq!(Shape::from_name(shape.name()).unwrap(), shape);
            let count = shape.parameter_count().unwrap_or(6);
            let mut names = shape.parameter_names(count);
            names.sort();
            names.dedup();
            assert_eq!(names.len(), count, "{shape:?}");
        }
        assert_eq!(Shape::Points.parameter_names(4), ["x0", "y0", "x1", "y1"]);
        assert_eq!(Shape::Bell.parameter_names(3), ["centre", "width", "slope"]);
    }

    #[test]
    fn bad_parameters_are_refused_in_words() {
        let cases: [(Shape, &[f64], &str); 18] = [
            (
                Shape::Gaussian,
                &[0.0, 0.0],
                "sigma of a gaussian membership function must be positive, got 0",
            ),
            (
                Shape::Gaussian,
                &[f64::NAN, 1.0],
                "mean of a gaussian membership function must be finite, got NaN",
            ),
            (
                Shape::Triangular,
                &[1.0, 1.0, 1.0],
                "c of a triangular membership function must be above a (1), got 1",
            ),
            (
                Shape::Trapezoidal,
                &[0.0, 2.0, 1.0, 3.0],
                "trapezoidal membership function must not decrease, got [0.0, 2.0, 1.0, 3.0]",
            ),
            (
                Shape::Bell,
                &[0.0, 1.0],
                "parameters of a bell membership function: expected 3, got 2",
            ),
            (
                Shape::Bell,
                &[0.0, 1.0, -2.0],
                "slope of a bell membership function must be positive",
            ),
            (Shape::Spike, &[0.0, 1e200], "must be from 1e-150 to 1e150"),
            (
                Shape::Sigmoid,
                &[0.0, 0.0],
                "slope of a sigmoid membership function must be other than 0",
            ),
            (Shape::Sigmoid, &[0.0, -1e200], "to 1e150, or the negative of such a number"),
            (
                Shape::SShape,
                &[2.0, 1.0],
                "the vertices of an s_shape membership function must not decrease",
            ),
            (
                Shape::Rectangle,
                &[1.0, 1.0],
                "b of a rectangle membership function must be above a (1)",
            ),
            (
                Shape::Arc,
                &[1.0, 1.0],
                "end of an arc membership function must be different from start (1)",
            ),
            (Shape::Ramp, &[-1e308, 1e308], "size of a ramp membership function must be finite"),
            (Shape::Step, &[0.0, 0.0], "direction of a step membership function must be 1 or -1"),
            (Shape::Points, &[0.0, 1.0], "expected an even number from 4, got 2"),
            (Shape::Points, &[0.0, 1.0, 2.0, 1.0, 3.0], "expected an even number from 4, got 5"),
            (
                Shape::Points,
                &[0.0, 1.0, 0.0, 0.5],
                "x1 of a points membership function must be above x0 (0), got 0",
            ),
            (
                Shape::Points,
                &[0.0, 1.0, 2.0, 1.5],
                "y1 of a points membership function must be between 0 and 1",
            ),
        ];
        for (shape, parameters, expected) in cases {
            assert!(!shape.accepts(parameters));
            let message = shape.check(parameters).unwrap_err().to_string();
            assert!(message.contains(expected), "{message}");
        }
    }
}
