"""Tune a pursuer for a fitness of your own: ask for the population, tell the fitness.

The library's own techniques run in Rust from end to end; this is how to use any other measure.
Here: the mean capture time over many starts, where an escape costs the full minute.
"""

import numpy as np

import fuzzyrs as fz

game = fz.OneOnOne()
starts = [(x, y) for x in (-8, -4, 4, 8) for y in (-8, -4, 4, 8)]

terms = [fz.Variable.evenly(name, (-1, 1), "NZP") for name in ("angle", "rate")]
template = fz.TSK(terms, np.zeros((3, 3)), no_rule_fires=0.0)

# Only the nine consequents are searched; the membership functions stay as they are.
fixed = template.parameters[:-9]
search = fz.Genetic([(-1.0, 1.0)] * 9, population=20, seed=2)


def controller(consequents):
    """Return the pursuer with these consequents."""
    system = template.with_parameters(np.concatenate([fixed, consequents]))
    return fz.FuzzyController(system, angle_limit=1.0, rate_limit=1.0)


for _ in range(60):
    population = search.ask()
    played = [game.play_many(controller(c), evader_starts=starts) for c in population]
    search.tell([outcomes.duration.mean() for outcomes in played])

consequents, fitness = search.best
classical = game.play_many(evader_starts=starts).duration.mean()
print(f"mean duration of a game: ours {fitness:.2f} s, classical {classical:.2f} s")
