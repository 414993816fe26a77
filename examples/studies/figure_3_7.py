"""What figure-3-7.toml runs: any function that takes a seed and the grid's parameters."""

import fuzzyrs as fz

PLANT = fz.WallFollowing(fz.Wall.sin(), time_step=0.1)
EXPERT = fz.PD(1.2, 1.5)


def fitness(seed: int, iterations: int, population: int, control: fz.Control) -> dict[str, float]:
    """Return the mean squared error of the steering angle (1e-3 rad2) after stage 1."""
    training = fz.WallIgbflcTraining(
        population=population, iterations=iterations, repetitions=0, start=(0, 1.45)
    )
    trained = fz.train(PLANT, training, seed=seed, expert=EXPERT, control=control)
    return {"fitness": 1e3 * trained.stages[0].fitness[-1]}
