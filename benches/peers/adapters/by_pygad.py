"""pygad: tournaments, one-point crossover, random mutation; the fitness is NumPy's."""

import numpy as np
import pygad
from works import Breeder, Search


def search(work: Search) -> Breeder:
    def fitness(_search, population, _indices):
        return -work.errors(np.asarray(population, dtype=float))

    def run(generations):
        search = pygad.GA(
            num_generations=generations,
            sol_per_pop=work.population,
            num_parents_mating=work.population // 2,
            num_genes=work.genes,
            init_range_low=-1.0,
            init_range_high=1.0,
            gene_space={"low": -1.0, "high": 1.0},
            fitness_func=fitness,
            fitness_batch_size=work.population,
            parent_selection_type="tournament",
            K_tournament=2,
            mutation_probability=0.02,
            keep_elitism=1,
            random_seed=1,
            suppress_warnings=True,
        )
        search.run()
        genes, best, _ = search.best_solution(search.last_generation_fitness)
        return np.asarray(genes, dtype=float), -best

    return Breeder("pygad", run)
