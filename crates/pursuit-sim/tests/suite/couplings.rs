//! Learning who goes for whom: right, and the same on any number of threads.

use fuzzy_core::Control;
use fuzzy_core::learn::assignment::{Objective, assign};
use pursuit_sim::training::{
    CoupledRobotsTraining, CouplingReward, CouplingTask, CouplingTechnique, CouplingTraining,
    LearnedCoupling, PairExploration, PairwiseTraining, Steering,
};
use pursuit_sim::{Controller, Crew, ManyOnMany, ManyStart, Pose, capture_times};

fn start(pursuers: &[(f64, f64)], evaders: &[(f64, f64)]) -> ManyStart {
    let poses =
        |places: &[(f64, f64)]| places.iter().map(|&(x, y)| Pose { x, y, heading: 0.0 }).collect();
    ManyStart { pursuers: poses(pursuers), evaders: poses(evaders) }
}

/// Positions that give the capture times of Table 8.14.
fn three() -> (ManyOnMany, ManyStart) {
    let pursuers = [(-5.0, -4.0), (-1.0, -6.0), (0.0, 0.0)];
    let evaders = [(-4.0, -4.0), (1.0, -4.0), (-3.0, -1.0)];
    (ManyOnMany::thesis(3).unwrap(), start(&pursuers, &evaders))
}

fn learn(technique: &dyn CouplingTechnique, seed: u64, threads: usize) -> LearnedCoupling {
    let (game, start) = three();
    let task = CouplingTask { game: &game, start: &start, seed, threads };
    technique.learn(&task, &Control::new()).unwrap()
}

#[test]
fn the_same_seed_gives_the_same_bits_on_any_number_of_threads() {
    let few = PairwiseTraining { episodes: 20, ..PairwiseTraining::default() };
    let techniques: [&dyn CouplingTechnique; 3] = [
        &CouplingTraining { episodes: 20, ..CouplingTraining::default() },
        &few,
        &PairwiseTraining { exploration: PairExploration::Softmax, ..few.clone() },
    ];
    for technique in techniques {
        let one = learn(technique, 3, 1);
        assert_eq!(one, learn(technique, 3, 2));
        assert_ne!(one.games, learn(technique, 4, 1).games);
        assert_eq!(one.visits.iter().sum::<u64>() % 20, 0);
    }
}

#[test]
fn every_technique_finds_the_printed_coupling() {
    for steering in [Steering::Classical, Steering::Softmax, Steering::EpsilonGreedy] {
        let robots = CoupledRobotsTraining { steering, ..CoupledRobotsTraining::default() };
        for reward in [CouplingReward::OverSquaredTime, CouplingReward::OverSteps] {
            let table = CouplingTraining { robots, reward, ..CouplingTraining::default() };
            assert_eq!(learn(&table, 1, 1).coupling, [1, 2, 0], "{steering:?} {reward:?}");
        }
        for exploration in [PairExploration::Optimistic, PairExploration::Softmax] {
            let pairs = PairwiseTraining {
                robots,
                exploration,
                episodes: 100,
                ..PairwiseTraining::default()
            };
            let learned = learn(&pairs, 1, 1);
            assert_eq!(learned.coupling, [1, 2, 0], "{steering:?} {exploration:?}");
        }
    }
}

#[test]
fn pairs_learn_the_assignment_on_classical_capture_times() {
    let (game, start) = three();
    let crews = [Crew::Same(&Controller::Classical); 2];
    let times = capture_times(&game, &start, crews, 600, 1, &Control::new()).unwrap();
    let robots =
        CoupledRobotsTraining { steering: Steering::Classical, ..CoupledRobotsTraining::default() };
    for objective in [Objective::Sum, Objective::Bottleneck] {
        let pairs = PairwiseTraining { robots, objective, episodes: 10, ..Default::default() };
        assert_eq!(learn(&pairs, 0, 1).coupling, assign(&times, 3, objective).unwrap());
    }
}

#[test]
fn where_nobody_can_be_caught_as_many_as_can_are() {
    // Pursuer 0 is slower than both evaders, pursuer 1 faster than evader 1 only.
    let robot = |speed| pursuit_sim::Vehicle::new(speed, 0.3, 0.5).unwrap();
    let game =
        ManyOnMany::new(vec![robot(0.5), robot(1.5)], vec![robot(2.0), robot(1.0)], 0.1, 0.1)
            .unwrap();
    let start = start(&[(0.0, 0.0), (0.0, 1.0)], &[(3.0, 0.0), (3.0, 1.0)]);
    let task = CouplingTask { game: &game, start: &start, seed: 0, threads: 1 };
    let robots =
        CoupledRobotsTraining { steering: Steering::Classical, ..CoupledRobotsTraining::default() };
    let pairs =
        PairwiseTraining { robots, episodes: 10, steps: 300, ..PairwiseTraining::default() };
    let learned = pairs.learn(&task, &Control::new()).unwrap();
    assert_eq!(learned.coupling, [0, 1]);
    assert_eq!(learned.games.iter().map(|game| game.captured).max(), Some(1));
    assert!(learned.games.iter().all(|game| game.duration == 30.0));
}
