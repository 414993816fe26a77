"""Q(λ)-learning on an environment of your own: a walk to the right end of a corridor."""

import fuzzyrs as fz

LENGTH = 20
LEFT, RIGHT = 0, 1

learner = fz.QLambda(LENGTH, 2, discount=0.95, trace_decay=0.8, seed=0)
for episode in range(1, 101):
    learner.clear_traces()
    position, steps = 0, 0
    while position < LENGTH - 1:
        action = learner.choose(position, exploration=1 / episode)
        reached = max(position - 1, 0) if action == LEFT else position + 1
        arrived = reached == LENGTH - 1
        reward = 1.0 if arrived else 0.0
        learner.learn(position, action, reward, None if arrived else reached, learning_rate=0.5)
        position, steps = reached, steps + 1
    if episode in (1, 10, 100):
        print(f"episode {episode}: {steps} steps")

assert all(learner.greedy_action(position) == RIGHT for position in range(LENGTH - 1))
