//! What the techniques must reach (the full comparison is the experiment `table-6-3`), and what
//! they must refuse.

use fuzzy_core::{Control, parallel};
use pursuit_sim::training::{
    GeneRanges, GeneticPhase, QLambdaTraining, QlbgflcTraining, RewardGaTraining, Technique,
    Trained,
};
use pursuit_sim::{Controller, OneOnOne, Start, play_many};

const SEEDS: u64 = 20;

/// Capture times from the four published starts for each seed; infinite if not caught in 60 s.
fn capture_times(train: impl Fn(&OneOnOne, u64) -> Trained + Sync) -> Vec<[f64; 4]> {
    let game = OneOnOne::thesis().unwrap();
    let starts =
        [(-6.0, 7.0), (-7.0, -7.0), (2.0, 4.0), (3.0, -8.0)].map(|(x, y)| Start::evader_at(x, y));
    let seeds = (2000..2000 + SEEDS).collect();
    parallel::map(0, seeds, |seed| {
        let pursuer = train(&game, seed).controller;
        let outcomes =
            play_many(&game, &pursuer, &Controller::Classical, &starts, 600, 1, &Control::new());
        let outcomes = outcomes.unwrap();
        Ok::<_, fuzzy_core::Error>(std::array::from_fn(|i| {
            outcomes[i].capture_time(0.1).unwrap_or(f64::INFINITY)
        }))
    })
    .unwrap()
}

/// Seeds whose four times all lie within `margin` of the classical ones.
fn near_classical(times: &[[f64; 4]], margin: f64) -> usize {
    let classical = [9.6, 10.4, 4.5, 8.5];
    times.iter().filter(|t| (0..4).all(|i| t[i] <= classical[i] + margin + 1e-9)).count()
}

// The bounds below leave room for chance: with the share of seeds that the specification's
// larger samples show, fewer would happen in one of a thousand sets of twenty.

#[test]
fn qlbgflc_catches_and_mostly_comes_near_the_classical_pursuer() {
    let times = capture_times(|game, seed| {
        let training = QlbgflcTraining::default();
        training.train(game, &Controller::Classical, seed, &Control::new()).unwrap()
    });
    assert!(near_classical(&times, 10.0) >= 17, "{times:?}");
    assert!(near_classical(&times, 4.0) >= 14, "{times:?}");
}

#[test]
fn the_reward_ga_comes_near_the_classical_pursuer() {
    let times = capture_times(|game, seed| {
        let training = RewardGaTraining::default();
        training.train(game, &Controller::Classical, seed, &Control::new()).unwrap()
    });
    assert!(near_classical(&times, 2.0) >= 16, "{times:?}");
}

#[test]
fn q_lambda_needs_more_exploration_than_the_thesis_gave_it() {
    let train = |exploration| {
        capture_times(move |game, seed| {
            let training = QLambdaTraining { exploration, ..QLambdaTraining::default() };
            training.train(game, &Controller::Classical, seed, &Control::new()).unwrap()
        })
    };
    let (little, much) = (near_classical(&train(0.1), 1.0), near_classical(&train(1.0), 1.0));
    assert!(much >= 6 && little + 3 <= much, "{little} and {much} of {SEEDS}");
}

#[test]
fn impossible_settings_are_refused_in_words() {
    let game = OneOnOne::thesis().unwrap();
    let (evader, control) = (Controller::Classical, Control::new());
    let q = |training: QLambdaTraining| {
        training.train(&game, &evader, 0, &control).unwrap_err().to_string()
    };
    let thesis = QLambdaTraining::default;
    assert_eq!(
        q(QLambdaTraining { episodes: 0, ..thesis() }),
        "episodes must be at least 1, got 0"
    );
    assert_eq!(q(QLambdaTraining { steps: 0, ..thesis() }), "steps must be at least 1, got 0");
    assert_eq!(
        q(QLambdaTraining { exploration: 1.5, ..thesis() }),
        "exploration rate must be between 0 and 1, got 1.5"
    );
    assert!(q(QLambdaTraining { starts: vec![], ..thesis() }).contains("starting positions"));
    assert!(q(QLambdaTraining { starts: vec![(f64::NAN, 0.0)], ..thesis() }).contains("finite"));
    assert!(q(QLambdaTraining { actions: 1, ..thesis() }).contains("actions"));

    let small = GeneticPhase { iterations: 5, population: 3, ..GeneticPhase::default() };
    let reward = RewardGaTraining { genetic: small, ..RewardGaTraining::default() };
    let message = reward.train(&game, &evader, 0, &control).unwrap_err().to_string();
    assert_eq!(message, "population must be at least 4, got 3");
    let ranges = GeneRanges { width: (0.0, 1.0), ..GeneRanges::default() };
    let reward = RewardGaTraining { ranges, ..RewardGaTraining::default() };
    let message = reward.train(&game, &evader, 0, &control).unwrap_err().to_string();
    assert_eq!(message, "smallest width must be positive, got 0");
    let qlbgflc = QlbgflcTraining {
        stage_1: GeneticPhase { population: 8, crossover: 0.25, ..GeneticPhase::default() },
        ..QlbgflcTraining::default()
    };
    let message = qlbgflc.train(&game, &evader, 0, &control).unwrap_err().to_string();
    assert!(message.contains("stage 1 keeps for stage 2 must be at least 10"), "{message}");
    let unprepared = QlbgflcTraining { prepared: false, ..qlbgflc };
    let trained = unprepared.train(&game, &evader, 0, &control).unwrap();
    assert_eq!(trained.history.len(), 1, "stage 2 alone needs nothing from stage 1");
}
