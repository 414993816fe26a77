"""Time fuzzyrs beside other libraries: the same works, one thread, in turns.

Every library's outputs are checked against the equations first. Then all take turns, and the least
CPU time of the rounds counts: on shared machines it is what repeats; ratios repeat better still.

    pip install ".[peers]"
    python benches/peers/run.py [--quick]
"""

import importlib
import itertools
import os
import platform
import sys
import time
from importlib.metadata import version

# Whoever uses threads uses one.
os.environ.update(
    {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "NUMBA", "RAYON")}
)

import numpy as np
from works import SEARCH, WORKS, Tsk, draw, reference, training

QUICK = "--quick" in sys.argv[1:]
ROUNDS = 2 if QUICK else 9
SECONDS = 0.02 if QUICK else 0.5
"""How long a round of one contender may take; the slow ones get fewer points."""

ADAPTERS = {
    "ours": "fuzzyrs",
    "ferrifuzz": "ferrifuzz",
    "fuzzytool": "fuzzytool",
    "scikit_fuzzy": "scikit-fuzzy",
    "simpful": "simpful",
    "pyfuzzylite": "pyfuzzylite",
    "anfis_toolbox": "anfis-toolbox",
    "by_hand": "numpy",
    "compiled": "numba",
    "by_deap": "deap",
    "by_pymoo": "pymoo",
    "by_pygad": "pygad",
}


def adapters():
    """Import what is installed and say what is not."""
    found = [(name, _adapter(module, name)) for module, name in ADAPTERS.items()]
    installed = [f"{name} {version(name)}" for name, module in found if module]
    print(", ".join([f"Python {platform.python_version()}", *installed]))
    return [module for _, module in found if module]


def _adapter(module, distribution):
    try:
        return importlib.import_module(f"adapters.{module}")
    except ModuleNotFoundError as error:
        print(f"{distribution} is left out: {error}")
        return None


def check(work, contender):
    """Compare a contender's outputs with the equations."""
    points = draw(work, 20 if QUICK else 60)
    expected = reference(work, points, contender.sampling)
    tolerance = contender.sampling.tolerance if contender.sampling else 1e-9
    pairs = [tuple(map(float, point)) for point in points]
    outputs = [contender.calls(pairs)]
    outputs += [contender.batch(points)] if contender.batch else []
    for output in outputs:
        np.testing.assert_allclose(output, expected, rtol=0, atol=tolerance, err_msg=contender.name)


class Task:
    """Work that is timed again and again: a function and as many points as fit into a round."""

    def __init__(self, name, function, points):
        self.name, self.function = name, function
        size, spent = 3, 0.0
        while size < len(points) and spent < SECONDS / 4:
            size *= 4
            self.points = points[:size]
            _, spent = self.seconds()
        self.cpu = self.wall = float("inf")

    def seconds(self):
        """Return the CPU time and the time that all points take."""
        cpu, wall = time.process_time(), time.perf_counter()
        self.function(self.points)
        return time.process_time() - cpu, time.perf_counter() - wall

    def run(self):
        """Keep what one point cost if it never cost less."""
        cpu, wall = self.seconds()
        self.cpu = min(self.cpu, cpu / len(self.points))
        self.wall = min(self.wall, wall / len(self.points))


def table(title, tasks, loop=None):
    """Let the tasks take turns, and print what one evaluation costs, without the loop around."""
    everything = [*tasks, loop] if loop else tasks
    for _, task in itertools.product(range(ROUNDS), everything):
        task.run()
    cpu, wall = (loop.cpu, loop.wall) if loop else (0.0, 0.0)
    rows = [(task, task.cpu - cpu, task.wall - wall) for task in tasks]
    unit = min(own for task, own, _ in rows if task.name.startswith("fuzzyrs"))
    print(f"\n{title}\n{'':24}{'CPU ns':>14}{'wall ns':>14}{'ratio':>10}{'points':>9}")
    for task, own, whole in rows:
        numbers = f"{own * 1e9:14,.1f}{whole * 1e9:14,.1f}{own / unit:10,.1f}{len(task.points):9}"
        print(f"{task.name:24}{numbers}")


def table_of_trainings(found):
    """Time an epoch of ANFIS, and print how well each library has then fitted the samples."""
    work = training(100 if QUICK else 1000)
    makers = [module.anfis for module in found if hasattr(module, "anfis")]
    trainers = [each for make in makers for each in make(work)]
    tasks = [
        Task(each.name, lambda epochs, own=each: own.train(len(epochs)), range(48))
        for each in trainers
    ]
    table(f"{work.name}, one epoch (points: epochs of a round)", tasks)
    print("\nThe root mean squared error after ten epochs")
    for trainer in trainers:
        error = np.sqrt(np.mean((trainer.train(10) - work.targets) ** 2))
        print(f"{trainer.name:24}{error:14.2e}")


def loop_alone(points):
    """What is around the calls."""
    return [x for x, y in points]


def search(found):
    """Time one generation of a genetic search, after a look at what comes out of a few."""
    breeders = [module.search(SEARCH) for module in found if hasattr(module, "search")]
    rng = np.random.default_rng(3)
    drawn = SEARCH.errors(rng.uniform(-1, 1, (SEARCH.population, SEARCH.genes))).min()
    for breeder in breeders:
        genes, error = breeder.run(30)
        np.testing.assert_allclose(SEARCH.errors(genes[None]), error, rtol=1e-9)
        assert np.abs(genes).max() <= 1, breeder.name
        assert error < 0.8 * drawn, breeder.name
    # A generation stands for a point.
    tasks = [
        Task(each.name, lambda rounds, run=each.run: run(len(rounds)), range(10_000))
        for each in breeders
    ]
    table(f"{SEARCH.name}, one generation", tasks)


def main():
    found = adapters()
    search(found)
    for work in WORKS:
        build = "tsk" if isinstance(work, Tsk) else "mamdani"
        makers = [getattr(module, build) for module in found if hasattr(module, build)]
        contenders = [each for make in makers for each in make(work)]
        for contender in contenders:
            check(work, contender)
        many = draw(work, work.batch // 50 if QUICK else work.batch)
        pairs = [tuple(map(float, point)) for point in many[:200_000]]
        calls = [Task(each.name, each.calls, pairs) for each in contenders]
        table(f"{work.name}, one call", calls, Task("loop", loop_alone, pairs))
        batches = [Task(each.name, each.batch, many) for each in contenders if each.batch]
        table(f"{work.name}, batch of {len(many)}", batches)
        if not isinstance(work, Tsk):
            print("\nThe centroid is taken of")
            print("\n".join(f"{each.name:24}{each.sampling.name}" for each in contenders))
    table_of_trainings(found)


if __name__ == "__main__":
    main()
