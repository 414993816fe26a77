"""DEAP: tournaments of two, blend crossover, Gaussian mutation; the fitness is NumPy's."""

import random

import numpy as np
from deap import base, creator, tools
from works import Breeder, Search

creator.create("Least", base.Fitness, weights=(-1.0,))
creator.create("Genes", list, fitness=creator.Least)


def search(work: Search) -> Breeder:
    def evaluate(population):
        for genes, error in zip(population, work.errors(np.array(population)), strict=True):
            genes.fitness.values = (error,)

    def child(parent):
        copy = creator.Genes(parent)
        copy.fitness.values = parent.fitness.values
        return copy

    def run(generations):
        random.seed(1)
        drawn = ([random.uniform(-1, 1) for _ in range(work.genes)] for _ in range(work.population))
        population = [creator.Genes(genes) for genes in drawn]
        evaluate(population)
        for _ in range(generations):
            best = tools.selBest(population, 1)
            children = [child(each) for each in tools.selTournament(population, work.population, 2)]
            for first, second in zip(children[::2], children[1::2], strict=True):
                tools.cxBlend(first, second, 0.3)
            for genes in children:
                tools.mutGaussian(genes, 0, 0.2, 0.1)
                genes[:] = [min(max(gene, -1.0), 1.0) for gene in genes]
            population = best + children[1:]
            evaluate(population)
        best = tools.selBest(population, 1)[0]
        return np.array(best), best.fitness.values[0]

    return Breeder("DEAP", run)
