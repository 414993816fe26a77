//! Section 8.4: two pursuers, one evader.

use fuzzy_core::{Control, Inference, Rng, Shape, Tsk, Variable};
use pursuit_sim::rollout::two_pursuers::{play, play_many, play_population};
use pursuit_sim::training::{
    GeneticPhase, Pairing, TwoPursuersQLambdaTraining, TwoPursuersQlbgflcTraining,
};
use pursuit_sim::{
    Aim, Capture, Controller, Entrant, Flight, FuzzyController, Outcome, Pose, TwoPursuers,
    TwoPursuersStart,
};

/// The starts of Figures 8.4 and 8.7, (a) to (f) (m).
const STARTS: [[(f64, f64); 2]; 6] = [
    [(-3.0, -6.0), (4.0, -4.0)],
    [(-4.0, 3.0), (5.0, -2.0)],
    [(-3.0, 6.0), (-2.0, -5.0)],
    [(-4.0, 5.0), (3.0, 4.0)],
    [(-6.0, -2.0), (5.0, 3.0)],
    [(-5.0, 3.0), (-2.0, 6.0)],
];

fn capture_times(game: &TwoPursuers) -> [Option<f64>; 6] {
    STARTS.map(|positions| {
        let start = TwoPursuersStart::pursuers_at(positions);
        let path = play(game, [&Controller::Classical; 3], start, 600).unwrap();
        path.outcome.capture_time(game.time_step())
    })
}

#[test]
fn classical_capture_times_stay() {
    let game = TwoPursuers::thesis().unwrap();
    let expected = [
        (Aim::LineOfSight, [27.2, 18.7, 21.8, 23.9, 20.5, 28.2]),
        (Aim::Intercept, [26.9, 16.2, 19.9, 23.8, 16.8, 28.0]),
        (Aim::InterceptFlight, [26.7, 15.0, 19.9, 23.6, 16.8, 27.9]),
    ];
    for (aim, times) in expected {
        assert_eq!(capture_times(&game.with_aim(aim)), times.map(Some), "{}", aim.name());
    }
}

const AIMS: [Aim; 3] = [Aim::LineOfSight, Aim::Intercept, Aim::InterceptFlight];
const FLIGHTS: [Flight; 5] =
    [Flight::Weighted, Flight::WeightedUnits, Flight::Nearest, Flight::Sum, Flight::SumOfUnits];

#[test]
fn flights_rank_as_their_distance_from_the_print() {
    // Figure 8.4: the weighted flights come nearest, the sum of the vectors is far off.
    let printed = [26.4, 20.7, 22.2, 25.7, 21.3, 28.4];
    let off = FLIGHTS.map(|flight| {
        let times = capture_times(&TwoPursuers::thesis().unwrap().with_flight(flight));
        times.iter().zip(printed).map(|(time, print)| (time.unwrap() - print).abs()).sum::<f64>()
            / 6.0
    });
    let expected = [1.00, 0.92, 1.37, 3.2, 1.53];
    for (flight, (off, expected)) in FLIGHTS.into_iter().zip(off.into_iter().zip(expected)) {
        assert!((off - expected).abs() < 0.06, "{}: {off}", flight.name());
    }
}

fn fuzzy(consequents: [f64; 9]) -> FuzzyController {
    let inputs = ["angle", "rate"].map(|name| {
        Variable::evenly(name, (-1.0, 1.0), Shape::GaussianWidth, &["N", "Z", "P"]).unwrap()
    });
    let system = Tsk::zero_order("robot", inputs.to_vec(), consequents.to_vec()).unwrap();
    FuzzyController::new(system, 1.0, 1.0).unwrap()
}

fn pursuer() -> FuzzyController {
    fuzzy([-0.9, -0.6, -0.3, -0.2, 0.0, 0.2, 0.3, 0.6, 0.9])
}

fn starts(count: usize) -> Vec<TwoPursuersStart> {
    let mut rng = Rng::new(4, 0);
    let mut pose = || Pose {
        x: rng.uniform_in(-6.0, 6.0),
        y: rng.uniform_in(-6.0, 6.0),
        heading: rng.uniform_in(-3.0, 3.0),
    };
    (0..count).map(|_| TwoPursuersStart { pursuers: [pose(), pose()], evader: pose() }).collect()
}

fn bits(outcome: &Outcome) -> (bool, u32, [u64; 3]) {
    let Outcome { captured, steps, first_distance, last_distance, miss_distance } = *outcome;
    (captured, steps, [first_distance, last_distance, miss_distance].map(f64::to_bits))
}

#[test]
fn games_in_lanes_are_the_games_alone_to_the_bit() {
    let fuzzy = Controller::Fuzzy(Box::new(pursuer()));
    let controllers = [&fuzzy, &Controller::Classical, &Controller::BangBang];
    let starts = starts(50);
    for aim in AIMS {
        for flight in FLIGHTS {
            let game = TwoPursuers::thesis().unwrap().with_aim(aim).with_flight(flight);
            let game = game.with_capture(Capture::Swept);
            let control = Control::new();
            let many = play_many(&game, controllers, &starts, 300, 2, &control).unwrap();
            for (start, outcome) in starts.iter().zip(&many) {
                let alone = play(&game, controllers, *start, 300).unwrap();
                assert_eq!(bits(&alone.outcome), bits(outcome));
            }
            assert_eq!(control.done(), 50);
        }
    }
}

#[test]
fn individuals_of_three_populations_meet_place_by_place_from_every_start() {
    let (game, control) = (TwoPursuers::thesis().unwrap(), Control::new());
    let (template, starts) = (pursuer(), starts(3));
    let mut rng = Rng::new(8, 0);
    let mut population = || -> Vec<f64> {
        let mut vectors = template.system().parameters().repeat(11);
        vectors.iter_mut().for_each(|number| *number += rng.uniform_in(-0.05, 0.05));
        vectors
    };
    let populations = [population(), population(), population()];
    let entrants = populations.each_ref().map(|p| Entrant::Population(&template, p));
    let together = play_population(&game, entrants, &starts, 200, &control).unwrap();
    assert_eq!(together.len(), 33);
    let size = template.system().parameters().len();
    for (index, outcome) in together.iter().enumerate() {
        let member = index % 11 * size..(index % 11 + 1) * size;
        let own = populations.each_ref().map(|population| {
            let fuzzy = template.with_parameters(&population[member.clone()]).unwrap();
            Controller::Fuzzy(Box::new(fuzzy))
        });
        let alone = play(&game, own.each_ref(), starts[index / 11], 200).unwrap();
        assert_eq!(bits(&alone.outcome), bits(outcome));
    }
    let mut fewer = entrants;
    fewer[2] = Entrant::Population(&template, &populations[2][..size]);
    assert!(play_population(&game, fewer, &starts, 200, &control).is_err());
}

#[test]
fn a_game_ends_with_the_first_capture_and_its_rewards_telescope() {
    let game = TwoPursuers::thesis().unwrap();
    let start = TwoPursuersStart::pursuers_at(STARTS[0]);
    let path = play(&game, [&Controller::Classical; 3], start, 600).unwrap();
    let steps = path.outcome.steps as usize;
    assert!(path.robots.iter().all(|poses| poses.len() == steps + 1));
    assert!(path.steering.iter().chain(&path.rewards).all(|values| values.len() == steps));
    let captor = path.captor.unwrap();
    assert!(path.distances[captor][steps] < 0.1 && path.distances[1 - captor][steps] >= 0.1);
    for (distances, rewards) in path.distances.iter().zip(&path.rewards) {
        let closed = (distances[0] - distances[steps]) / 0.08;
        assert!((rewards.iter().sum::<f64>() - closed).abs() < 1e-9);
        assert!(distances[..steps].iter().all(|&distance| distance >= 0.1));
    }
    for step in 0..steps {
        assert_eq!(path.rewards[2][step], -(path.rewards[0][step] + path.rewards[1][step]));
    }
}

#[test]
fn a_pursuer_in_the_evaders_place_has_caught_it() {
    let game = TwoPursuers::thesis().unwrap();
    let start = TwoPursuersStart::pursuers_at([(3.0, 0.0), (0.0, 0.0)]);
    for aim in AIMS {
        let game = game.with_aim(aim);
        let path = play(&game, [&Controller::Classical; 3], start, 600).unwrap();
        assert_eq!((path.outcome.steps, path.captor), (0, Some(1)));
    }
    let far = TwoPursuersStart::pursuers_at([(1e300, 0.0), (0.0, 1e300)]);
    assert!(play(&game, [&Controller::Classical; 3], far, 600).is_err());
    assert!(play(&game, [&Controller::Classical; 3], start, 0).is_err());
}

fn small() -> TwoPursuersQlbgflcTraining {
    let thesis = TwoPursuersQlbgflcTraining::default();
    TwoPursuersQlbgflcTraining {
        phase_1: TwoPursuersQLambdaTraining { episodes: 60, ..Default::default() },
        stage_1: GeneticPhase { iterations: 30, population: 40, ..thesis.stage_1 },
        stage_2: GeneticPhase { iterations: 6, ..thesis.stage_2 },
        ..thesis
    }
}

#[test]
fn all_three_robots_learn_reproducibly() {
    let (game, control) = (TwoPursuers::thesis().unwrap(), Control::new());
    let trained = small().train(&game, 3, &control).unwrap();
    assert_eq!(trained, small().train(&game, 3, &Control::new()).unwrap());
    assert_ne!(trained, small().train(&game, 4, &Control::new()).unwrap());
    // Episodes, three searches of stage 1, one of stage 2.
    assert_eq!(control.done(), 60 + 3 * 30 + 6);
    let lengths: Vec<usize> = trained.history.iter().map(|(_, values)| values.len()).collect();
    assert_eq!(lengths, [60, 30, 30, 30, 6, 6, 6]);
    let [first, second, evader] = &trained.controllers;
    assert!(first != second && second != evader);
    for pairing in [Pairing::Best, Pairing::Place] {
        let stage_2 = GeneticPhase { fresh_mutants: true, ..small().stage_2 };
        let settings = TwoPursuersQlbgflcTraining { pairing, stage_2, ..small() };
        assert!(settings.train(&game, 3, &Control::new()).is_ok());
    }
    let stopped = Control::new();
    stopped.cancel();
    assert!(small().train(&game, 3, &stopped).is_err());
}

#[test]
fn what_no_training_can_be_done_with_is_said_before_the_first_game() {
    let game = TwoPursuers::thesis().unwrap();
    let message = |settings: TwoPursuersQlbgflcTraining| {
        let control = Control::new();
        let message = settings.train(&game, 0, &control).unwrap_err().to_string();
        assert_eq!(control.done(), 0);
        message
    };
    let none = message(TwoPursuersQlbgflcTraining { starts_per_generation: 0, ..small() });
    assert_eq!(none, "starts of a generation must be between 1 and 10000, got 0");
    let larger = GeneticPhase { population: 60, ..small().stage_2 };
    let larger = message(TwoPursuersQlbgflcTraining { stage_2: larger, ..small() });
    assert!(larger.contains("keeps for stage 2"), "{larger}");
    let phase_1 = TwoPursuersQLambdaTraining { clearance: 9.0, ..small().phase_1 };
    let clearance = message(TwoPursuersQlbgflcTraining { phase_1, ..small() });
    assert!(clearance.contains("clearance"), "{clearance}");
}
