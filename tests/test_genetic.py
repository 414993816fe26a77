"""Genetic searches: operators, kinds of genes, constraints, checkpoints, fitting of any system."""

from __future__ import annotations

import pickle
import re

import hypothesis
import hypothesis.strategies as st
import numpy as np
import pytest

import fuzzyrs as fz
from fuzzyrs import errors

few = hypothesis.settings(max_examples=60, deadline=None)

CHAPTER_3 = {
    "population": 40,
    "elite": 20,
    "immigrants": 4,
    "selection": fz.Selection.neighbours(),
    "crossover": fz.Crossover.average(0.5),
    "bit_crossover": fz.Crossover.one_point(),
    "mutation": fz.Mutation.none(),
    "bit_flip": 0.0,
}


def sphere(population):
    return ((population - 0.25) ** 2).sum(axis=-1)


rates = st.floats(0, 1)
places = st.floats(-1e9, 1e9)
genes = st.one_of(
    st.tuples(places, places).map(lambda ends: fz.Gene.real(min(ends), max(ends))),
    st.tuples(st.integers(-9, 9), st.integers(0, 9)).map(
        lambda ends: fz.Gene.integer(ends[0], ends[0] + ends[1])
    ),
    st.just(fz.Gene.bit()),
)
weights = st.tuples(st.floats(-2, 2), st.floats(-2, 2)).map(sorted)
operators = st.fixed_dictionaries(
    {
        "elite": st.integers(11, 13),
        "mutants": st.integers(0, 3),
        "immigrants": st.integers(0, 3),
        "selection": st.sampled_from([fz.Selection.pairs(), fz.Selection.neighbours()])
        | st.integers(1, 20).map(fz.Selection.tournament),
        "crossover": st.sampled_from([fz.Crossover.one_point(), fz.Crossover.uniform()])
        | weights.map(lambda ends: fz.Crossover.average(*ends))
        | weights.map(lambda ends: fz.Crossover.blend(*ends))
        | st.floats(0, 50).map(fz.Crossover.simulated_binary),
        "bit_crossover": st.sampled_from([fz.Crossover.one_point(), fz.Crossover.uniform()]),
        "mutation": st.builds(fz.Mutation.gaussian, rates, st.floats(0, 3))
        | st.builds(fz.Mutation.polynomial, rates, st.floats(0, 50))
        | st.builds(fz.Mutation.redraw, rates)
        | st.just(fz.Mutation.none()),
        "bit_flip": rates,
        "seed": st.integers(0, 2**64 - 1),
    }
)


@few
@hypothesis.given(st.lists(genes, min_size=1, max_size=6), operators)
def test_every_gene_of_any_mix_stays_in_its_range_and_of_its_kind(chromosome, keywords):
    search = fz.Genetic(chromosome, population=20, **keywords)
    assert search.genes == chromosome
    for _ in range(4):
        population = search.ask()
        for column, gene in zip(population.T, chromosome, strict=True):
            low, high = gene.range
            assert ((low <= column) & (column <= high)).all()
            assert "real" in repr(gene) or (column == column.round()).all()
        search.tell(population.sum(axis=1))


@few
@hypothesis.given(operators, st.data())
def test_what_is_not_finite_is_never_the_best(keywords, data):
    search = fz.Genetic([(0, 1), fz.Gene.bit()], population=20, **keywords)
    numbers = st.one_of(st.floats(), st.sampled_from([np.nan, np.inf, -np.inf]))
    finite = []
    for _ in range(3):
        fitness = np.array(data.draw(st.lists(numbers, min_size=20, max_size=20)))
        population = search.ask()
        search.tell(fitness)
        finite += [
            (f, tuple(x)) for f, x in zip(fitness, population, strict=True) if np.isfinite(f)
        ]
        if not finite:
            assert search.best is None
            continue
        genes, best = search.best
        assert best == min(f for f, _ in finite)
        assert (best, tuple(genes)) in finite


@few
@hypothesis.given(operators)
def test_a_search_continues_from_a_checkpoint_to_the_bit(keywords):
    search = fz.Genetic([(-1, 2), fz.Gene.bit(), (0, 1 / 3)], population=20, **keywords)
    for _ in range(2):
        search.tell(sphere(search.ask()))
    again = pickle.loads(pickle.dumps(search))
    for _ in range(3):
        np.testing.assert_array_equal(again.ask(), search.ask())
        for each in (search, again):
            each.tell(sphere(each.ask()))
    assert again.to_json() == search.to_json()


def test_a_search_is_saved_and_loaded(tmp_path):
    search = fz.Genetic([(0, 1)] * 2, seed=3)
    search.tell(np.full(40, np.nan))
    search.save(tmp_path / "search.json")
    again = fz.Genetic.load(tmp_path / "search.json")
    assert again.to_json() == search.to_json()
    assert again.generation == 1
    assert np.isnan(again.history["best"]).all()
    with pytest.raises(errors.FormatError, match='document type "genetic" is not supported'):
        fz.TSK.from_json(search.to_json())
    with pytest.raises(errors.FuzzyrsError, match="individuals: expected 4, got 40"):
        fz.Genetic.from_json(search.to_json().replace('"population": 40', '"population": 4'))


def test_the_search_of_chapter_3_is_what_numpy_says():
    search = fz.Genetic([(0, 1)] * 48 + [fz.Gene.bit()] * 25, **CHAPTER_3, seed=1)
    first = search.ask()
    search.tell(sphere(first))
    second = search.ask()
    ranked = first[np.argsort(sphere(first), kind="stable")]
    np.testing.assert_array_equal(second[:20], ranked[:20])
    average = 0.5 * (ranked[:16, :48] + ranked[1:17, :48])
    np.testing.assert_allclose(second[20:36, :48], average, rtol=1e-14)
    for number, child in enumerate(second[20:36, 48:]):
        a, b = ranked[number, 48:], ranked[number + 1, 48:]
        cuts = [np.array_equal(child, [*a[:cut], *b[cut:]]) for cut in range(1, 25)]
        assert any(cuts)
    assert not (second[36:, None, :48] == first[None, :, :48]).any()


def test_a_mutant_differs_from_one_of_the_elite_in_one_gene():
    keywords = {**CHAPTER_3, "population": 80, "elite": 40, "immigrants": 0, "mutants": 8}
    search = fz.Genetic([(0, 1)] * 45, **keywords)
    search.tell(sphere(search.ask()))
    second = search.ask()
    differences = (second[72:, None, :] != second[None, :40, :]).sum(axis=2)
    assert (differences.min(axis=1) == 1).all()


@pytest.mark.parametrize(
    "crossover", [fz.Crossover.blx(0.3), fz.Crossover.simulated_binary(), fz.Crossover.uniform()]
)
@pytest.mark.parametrize("mutation", [fz.Mutation.gaussian(), fz.Mutation.polynomial()])
def test_modern_searches_find_the_minimum_of_a_bowl_and_of_waves(crossover, mutation):
    def waves(x):
        return (10 + (x - 1) ** 2 - 10 * np.cos(2 * np.pi * (x - 1))).sum(axis=-1)

    for function, enough in [(sphere, 0.02), (waves, 3.0)]:
        search = fz.Genetic(
            [(-5, 5)] * 4, population=100, crossover=crossover, mutation=mutation, seed=2
        )
        fz.minimise(search, function, 150, vectorised=True)
        assert search.best[1] < enough < search.history["best"][0]


def test_a_mixed_chromosome_is_solved():
    chromosome = [(-3, 3), fz.Gene.integer(0, 100)] + [fz.Gene.bit()] * 20

    def function(x):
        return (x[0] - 1) ** 2 + abs(x[1] - 42) / 10 + (1 - x[2:]).sum()

    search = fz.minimise(fz.Genetic(chromosome, population=60, seed=4), function, 200)
    genes, fitness = search.best
    assert fitness < 1e-2
    assert genes[1:].tolist() == [42] + [1] * 20


def test_constraints_go_before_fitness():
    # The nearest point to the origin on the far side of the line x + y = 1.
    def function(x):
        return x @ x, 1 - x.sum()

    search = fz.minimise(fz.Genetic([(-2, 2)] * 2, seed=1), function, 150)
    genes, fitness = search.best
    assert genes.sum() >= 1
    assert fitness == pytest.approx(0.5, abs=0.01)
    whole = fz.Genetic([(-2, 2)] * 2, seed=1)
    both = lambda p: ((p**2).sum(axis=1), 1 - p.sum(axis=1))  # noqa: E731
    fz.minimise(whole, both, 150, vectorised=True)
    assert whole.best[1] == pytest.approx(0.5, abs=0.01)
    search = fz.Genetic([(0, 1)], population=4)
    search.tell([1, 2, 3, 4], [1, 2, np.nan, 3])
    assert search.best is None


def test_history_and_stop_rules():
    search = fz.Genetic([(-1, 1)] * 2, seed=1)
    generations = []
    fz.minimise(search, sphere, 500, vectorised=True, target=1e-3, progress=generations.append)
    assert search.best[1] <= 1e-3
    assert generations == list(range(1, search.generation + 1))
    assert search.generation < 500
    history = search.history
    assert history["best"].shape == history["mean"].shape == (search.generation,)
    assert (history["best"] <= history["mean"]).all()
    flat = fz.minimise(fz.Genetic([(0, 1)]), lambda _: 1.0, 500, stagnation=9)
    assert (flat.generation, flat.stagnation) == (10, 9)
    assert flat.is_done(stagnation=9)
    assert not flat.is_done(target=0.9, stagnation=10)


@pytest.mark.parametrize("raised", [KeyboardInterrupt, ZeroDivisionError])
def test_what_stops_a_search_does_not_lose_its_best(raised):
    calls = 0

    def function(population):
        nonlocal calls
        calls += 1
        if calls == 6:
            raise raised
        return sphere(population)

    search = fz.Genetic([(-1, 1)] * 2, seed=1)
    with pytest.raises(raised):
        fz.minimise(search, function, 20, vectorised=True)
    assert search.generation == 5
    assert search.best[1] == search.history["best"].min()
    whole = fz.minimise(fz.Genetic([(-1, 1)] * 2, seed=1), sphere, 20, vectorised=True)
    fz.minimise(search, function, 15, vectorised=True)
    assert search.to_json() == whole.to_json()


def test_a_progress_bar_is_shown(capsys):
    fz.minimise(fz.Genetic([(0, 1)]), lambda x: x[0], 3, progress=True)
    assert "3/3" in capsys.readouterr().err


def both():
    x = fz.Variable.evenly("x", (-1, 1), "NZP", shape="triangular")
    u = fz.Variable.evenly("u", (-2, 2), "NZP", shape="trapezoidal")
    v = fz.Output.sugeno("v", {"low": 0, "high": 0})
    rules = ["if x is N then u is N and v is low", "if x is Z then u is Z"]
    rules += ["if x is P then u is P and v is high with 0.5"]
    return fz.System(x, [u, v], rules)


def test_a_system_of_two_outputs_is_fitted_on_any_number_of_threads():
    points = np.linspace(-1, 1, 21)[:, None]
    y = np.hstack([1.5 * points, 3 - points])
    fits = [fz.fit_genetic(both(), points, y, generations=60, threads=n, seed=2) for n in (1, 2, 5)]
    system, history = fits[0]
    assert isinstance(system, fz.System)
    assert all(other == system for other, _ in fits)
    error = np.mean((system(points) - y) ** 2)
    assert error == pytest.approx(history[-1], rel=1e-12)
    assert error < 0.3 * history[0]
    assert system.parameters[-3:].tolist() == [1, 1, 0.5]
    with pytest.raises(errors.ShapeError, match="an array of shape"):
        fz.fit_genetic(both(), points, y[:, 0])


def test_a_fit_stops_at_its_target_and_takes_operators():
    x = fz.Variable.evenly("x", (0, 1), "ab")
    points = np.linspace(0, 1, 9)[:, None]
    options = {"crossover": fz.Crossover.simulated_binary(), "mutation": fz.Mutation.polynomial()}
    _, history = fz.fit_genetic(fz.TSK([x], [0, 0]), points, points[:, 0], target=1e-3, **options)
    assert history[-1] <= 1e-3 < history[-2]
    _, history = fz.fit_genetic(fz.TSK([x], [0, 0]), points, points, stagnation=3, **options)
    assert history[-1] == history[-4]


BAD = {
    "an unknown gene": (
        lambda: fz.Genetic([fz.Gene.bit(), "x"]),
        "gene 1 must be a Gene or a pair",
    ),
    "crossed ends": (
        lambda: fz.Gene.real(2, 1),
        "upper end of the range of a gene must be above 2",
    ),
    "a huge whole number": (lambda: fz.Gene.integer(0, 2**60), "must be from -2^53 to 2^53"),
    "no genes": (lambda: fz.Genetic([]), "genes"),
    "no list": (lambda: fz.Genetic(3), "genes must be a list of pairs or Gene objects"),
    "an empty tournament": (
        lambda: fz.Selection.tournament(0),
        "size of a tournament must be at l",
    ),
    "mixed bits": (
        lambda: fz.Genetic([(0, 1)], bit_crossover=fz.Crossover.blx()),
        "bits cannot be mixed",
    ),
    "few parents": (
        lambda: fz.Genetic([(0, 1)], selection=fz.Selection.pairs()),
        "elite, whose members are the parents, must be at least 38, got 2",
    ),
    "a bad weight": (lambda: fz.Crossover.blx(float("nan")), "least weight of the crossover"),
    "a bad rate": (lambda: fz.Mutation.redraw(1.5), "rate of the mutation must be between 0 and 1"),
    "a start outside": (
        lambda: fz.Genetic([fz.Gene.bit()]).start_from([[0.5]]),
        "starting vector 0: gene 0 must be a whole number from 0 to 1, got 0.5",
    ),
    "no generations": (
        lambda: fz.minimise(fz.Genetic([(0, 1)]), sphere, 0),
        "generations must be at least 1, got 0",
    ),
    "a bad target": (lambda: fz.Genetic([(0, 1)]).is_done(target=float("nan")), "target fitness"),
    "few violations": (
        lambda: fz.Genetic([(0, 1)], population=4).tell([1] * 4, [0]),
        "constraint violations: expected 4, got 1",
    ),
    "no system": (lambda: fz.fit_genetic(3, [[0.0]], [0.0]), "system must be a TSK or a System"),
}


@pytest.mark.parametrize(("call", "message"), BAD.values(), ids=BAD)
def test_bad_input_is_refused_in_words(call, message):
    with pytest.raises(errors.FuzzyrsError, match=re.escape(message)):
        call()
