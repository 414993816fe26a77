use super::*;

const STATES: usize = 7;
const ACTIONS: usize = 5;
const OPPONENT: usize = 9;
const JOINT: usize = ACTIONS * OPPONENT;

const SETTINGS: MinimaxQSettings = MinimaxQSettings {
    states: STATES,
    actions: ACTIONS,
    opponent_actions: OPPONENT,
    discount: 0.5,
    trace_decay: 0.3,
    trace: Trace::ReplacingState,
    play: Play::Answer,
    ties: Ties::Random,
};

/// (8.1) as it is printed, with the traces of 2.47 and 2.48, over the whole table.
struct FullSweep {
    values: Vec<f64>,
    traces: Vec<f64>,
    discount: f64,
    trace_decay: f64,
}

impl FullSweep {
    fn value(&self, state: usize, play: Play) -> f64 {
        let payoffs = &self.values[state * JOINT..][..JOINT];
        if play == Play::Mixed {
            return MatrixGame::new(ACTIONS, OPPONENT).unwrap().solve(payoffs).unwrap();
        }
        let minima = payoffs.chunks(OPPONENT).map(|row| row.iter().copied().fold(9e9, f64::min));
        minima.fold(-9e9, f64::max)
    }

    fn learn(&mut self, s: usize, joint: usize, r: f64, ahead: f64, rate: f64) {
        let visited = s * JOINT + joint;
        let error = r + self.discount * ahead - self.values[visited];
        for pair in 0..self.values.len() {
            self.traces[pair] = match () {
                () if pair == visited => 1.0,
                () if pair / JOINT == s => 0.0,
                () => self.trace_decay * self.discount * self.traces[pair],
            };
            self.values[pair] += rate * error * self.traces[pair];
        }
    }
}

#[test]
fn live_traces_equal_the_full_sweep() {
    for play in [Play::Answer, Play::Security, Play::Mixed] {
        for (discount, trace_decay) in [(0.5, 0.3), (0.9, 0.9)] {
            let settings = MinimaxQSettings { play, discount, trace_decay, ..SETTINGS };
            let mut learner = MinimaxQ::new(settings).unwrap();
            let pairs = STATES * JOINT;
            let (values, traces) = (vec![0.0; pairs], vec![0.0; pairs]);
            let mut sweep = FullSweep { values, traces, discount, trace_decay };
            let mut rng = Rng::new(11, 0);
            let (mut state, mut chosen) = (0, (0, 0));
            for step in 0..4000 {
                let next = rng.below(STATES);
                let reward = rng.uniform_in(-1.0, 1.0);
                let ahead = sweep.value(next, play);
                // Whether the next actions are chosen before or after must not matter.
                let early = step % 2 == 0;
                let ahead_choice = learner.choose(next, 0.3, &mut rng).unwrap();
                if !early {
                    learner.evaluated = None;
                }
                learner.learn(state, chosen, reward, Some(next), 0.1).unwrap();
                let joint = chosen.0 * OPPONENT + chosen.1;
                sweep.learn(state, joint, reward, ahead, 0.1);
                (state, chosen) = (next, ahead_choice);
                assert!((learner.value(0).unwrap() - sweep.value(0, play)).abs() < 1e-9);
            }
            let worst = learner.values().iter().zip(&sweep.values).map(|(a, b)| (a - b).abs());
            assert!(worst.fold(0.0, f64::max) < 1e-10, "{settings:?}");
        }
    }
}

/// Payoffs of one state with ties.
fn tied(seed: u64) -> Vec<f64> {
    let mut rng = Rng::new(seed, 0);
    (0..JOINT).map(|_| rng.below(3) as f64).collect()
}

#[test]
fn choices_come_with_the_probabilities_of_the_strategies() {
    for play in [Play::Answer, Play::Security, Play::Mixed] {
        for ties in [Ties::First, Ties::Random] {
            // Where a matrix game has several solutions the order decides which.
            let first = if play == Play::Mixed && ties == Ties::Random {
                (0..JOINT).map(|i| ((i * i * 37) % 101) as f64).collect()
            } else {
                tied(5)
            };
            let settings = MinimaxQSettings { states: 1, play, ties, ..SETTINGS };
            let mut learner = MinimaxQ::new(settings).unwrap().starting_from(&first).unwrap();
            let (own, other) = learner.strategies(0).unwrap();
            let mut rng = Rng::new(2, 0);
            let mut counts = ([0.0; ACTIONS], [0.0; OPPONENT]);
            const DRAWS: usize = 20_000;
            for _ in 0..DRAWS {
                let (action, opponent) = learner.choose(0, 0.0, &mut rng).unwrap();
                counts.0[action] += 1.0;
                counts.1[opponent] += 1.0;
            }
            let pairs = own.iter().zip(counts.0).chain(other.iter().zip(counts.1));
            for (p, count) in pairs {
                // Five standard deviations.
                let error = (count / DRAWS as f64 - p).abs();
                assert!(error <= 5.0 * (p * (1.0 - p) / DRAWS as f64).sqrt() + 1e-9, "{p}");
            }
        }
    }
}

#[test]
fn the_readings_of_the_opponent_differ_where_there_is_no_saddle_point() {
    // Row 0 secures 1, row 1 nothing; column 0 answers row 0, column 1 concedes less in all.
    let settings = MinimaxQSettings { states: 1, actions: 2, opponent_actions: 2, ..SETTINGS };
    let with = |play| {
        let settings = MinimaxQSettings { play, ..settings };
        let payoffs = [1.0, 2.0, 3.0, 0.0];
        let mut learner = MinimaxQ::new(settings).unwrap().starting_from(&payoffs).unwrap();
        let chosen = learner.choose(0, 0.0, &mut Rng::new(0, 0)).unwrap();
        (chosen, learner.value(0).unwrap())
    };
    assert_eq!(with(Play::Answer), ((0, 0), 1.0));
    assert_eq!(with(Play::Security), ((0, 1), 1.0));
    assert!((with(Play::Mixed).1 - 1.5).abs() < 1e-12);
}

#[test]
fn each_player_explores_by_itself() {
    let settings = MinimaxQSettings { states: 1, ties: Ties::First, ..SETTINGS };
    let mut learner = MinimaxQ::new(settings).unwrap();
    let mut rng = Rng::new(4, 0);
    let chosen: Vec<_> = (0..20_000).map(|_| learner.choose(0, 0.4, &mut rng).unwrap()).collect();
    let share = |holds: &dyn Fn(&(usize, usize)) -> bool| {
        chosen.iter().filter(|&pair| holds(pair)).count() as f64 / 20_000.0
    };
    let (own, other) = (0.4 * 4.0 / 5.0, 0.4 * 8.0 / 9.0);
    assert!((share(&|pair| pair.0 != 0) - own).abs() < 0.018);
    assert!((share(&|pair| pair.1 != 0) - other).abs() < 0.018);
    assert!((share(&|pair| pair.0 != 0 && pair.1 != 0) - own * other).abs() < 0.018);
}

#[test]
fn impossible_settings_and_steps_are_refused() {
    for bad in [
        MinimaxQSettings { states: 0, ..SETTINGS },
        MinimaxQSettings { actions: 0, ..SETTINGS },
        MinimaxQSettings { opponent_actions: 0, ..SETTINGS },
        MinimaxQSettings { opponent_actions: usize::MAX, ..SETTINGS },
        MinimaxQSettings { discount: -0.1, ..SETTINGS },
        MinimaxQSettings { trace_decay: f64::NAN, ..SETTINGS },
    ] {
        assert!(MinimaxQ::new(bad).is_err());
    }
    let mut learner = MinimaxQ::new(SETTINGS).unwrap();
    learner.learn(0, (1, 2), 1.0, Some(3), 0.5).unwrap();
    let before = learner.values().to_vec();
    assert!(learner.learn(1, (0, 0), f64::NAN, Some(0), 0.5).is_err());
    let error = learner.learn(1, (0, 0), 1e300, None, 1.0).unwrap_err();
    assert_eq!(error.kind(), "learning_diverged");
    assert_eq!(learner.values(), before);
    assert!(MinimaxQ::new(SETTINGS).unwrap().starting_from(&[0.0; 3]).is_err());
}

#[test]
fn the_value_of_a_state_is_forgotten_with_the_table() {
    let settings = MinimaxQSettings { states: 1, trace_decay: 0.0, ..SETTINGS };
    let mut learner = MinimaxQ::new(settings).unwrap();
    learner.choose(0, 0.0, &mut Rng::new(0, 0)).unwrap();
    let mut learner = learner.starting_from(&[2.0; JOINT]).unwrap();
    let error = learner.learn(0, (0, 0), 0.0, Some(0), 1.0).unwrap();
    assert_eq!(error, 0.5 * 2.0 - 2.0);
}
