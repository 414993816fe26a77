"""pymoo: its genetic algorithm as it comes; the fitness is NumPy's."""

from pymoo.algorithms.soo.nonconvex.ga import GA
from pymoo.core.problem import Problem
from pymoo.optimize import minimize
from works import Breeder, Search


def search(work: Search) -> Breeder:
    class Fit(Problem):
        def __init__(self):
            super().__init__(n_var=work.genes, n_obj=1, xl=-1.0, xu=1.0)

        def _evaluate(self, x, out, *_arguments, **_options):
            out["F"] = work.errors(x)

    def run(generations):
        # pymoo counts the first population as a generation.
        end = ("n_gen", generations + 1)
        found = minimize(Fit(), GA(pop_size=work.population), end, seed=1, verbose=False)
        return found.X, found.F[0]

    return Breeder("pymoo", run)
