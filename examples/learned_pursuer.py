"""Let QLBGFLC learn to pursue, look at what it learned, and draw a game."""

import matplotlib.pyplot as plt

import fuzzyrs as fz

game = fz.OneOnOne()
trained = fz.train(game, fz.QlbgflcTraining(), seed=0)
pursuer = trained.controller
print(f"learned in {trained.learning_time:.0f} simulated seconds")
for phase, values in trained.history.items():
    print(f"  {phase}: {values[0]:.3g} at first, {values[-1]:.3g} at last")

for start in [(-6, 7), (-7, -7), (2, 4), (3, -8)]:
    learned = game.play(pursuer, evader_start=start)
    classical = game.play(evader_start=start)
    times = f"learned {learned.capture_time} s, classical {classical.capture_time} s"
    print(f"evader from {start}: {times}")

axes = fz.plot.paths(game.play(pursuer, evader_start=(-6, 7)), capture_radius=game.capture_radius)
fz.plot.paths(game.play(evader_start=(-6, 7)), ax=axes, label="classical", style="--")
plt.savefig("pursuit.png")
