//! Same seed, same bits: one game or eight in lock-step, any number of threads, twice in a row.

use fuzzy_core::learn::rl::{Cut, Discretiser, Exploring, TableAgent, TableAgentSettings, Trace};
use fuzzy_core::learn::schedule::Schedule;
use fuzzy_core::{Control, Inference, MembershipFunction, Rng, Tsk, Variable};
use pursuit_sim::training::{
    GeneticPhase, Practice, QLambdaTraining, QlbgflcTraining, RewardGaTraining, Role, Technique,
};
use pursuit_sim::{
    Capture, Controller, Entrant, EvasiveTurn, FuzzyController, MixedTableController, OneOnOne,
    Outcome, Pd, SpeedLaw, Start, TableController, Vehicle, play, play_many, play_pairs,
    play_population,
};

fn fuzzy() -> FuzzyController {
    let variable = |name| {
        let mut variable = Variable::new(name, -1.0, 1.0).unwrap();
        for (term, mean) in [("N", -1.0), ("Z", 0.0), ("P", 1.0)] {
            let function = MembershipFunction::gaussian_width(mean, 0.6).unwrap();
            variable = variable.with_term(term, function).unwrap();
        }
        variable
    };
    let consequents = vec![-0.9, -0.4, -0.4, -0.4, 0.0, 0.4, 0.4, 0.4, 0.9];
    let system =
        Tsk::zero_order("pursuer", vec![variable("angle"), variable("rate")], consequents).unwrap();
    FuzzyController::new(system, 1.0, 1.0).unwrap()
}

fn table() -> TableController {
    let states = Discretiser::new(&[(-1.0, 1.0, 11), (-1.0, 1.0, 11)]).unwrap();
    let angles = (0..121).map(|s| states.centre(s)[0].clamp(-0.5, 0.5)).collect();
    TableController::new(states, angles).unwrap()
}

/// A strategy that draws among three angles.
fn mixed() -> MixedTableController {
    let states = Discretiser::new(&[(-1.0, 1.0, 11), (-1.0, 1.0, 11)]).unwrap();
    let probabilities = (0..121).flat_map(|s| {
        let share = (s / 11) as f64 / 10.0;
        [0.8 * (1.0 - share), 0.2, 0.8 * share]
    });
    let probabilities = probabilities.collect();
    MixedTableController::new(states, vec![-0.5, 0.0, 0.5], probabilities, 3).unwrap()
}

fn starts(count: usize) -> Vec<Start> {
    let mut rng = Rng::new(8, 0);
    (0..count)
        .map(|_| Start::evader_at(rng.uniform_in(-9.0, 9.0), rng.uniform_in(-9.0, 9.0)))
        .collect()
}

fn bits(outcome: &Outcome) -> (bool, u32, [u64; 3]) {
    let distances = [outcome.first_distance, outcome.last_distance, outcome.miss_distance];
    (outcome.captured, outcome.steps, distances.map(f64::to_bits))
}

#[test]
fn lock_step_equals_one_by_one_on_any_number_of_threads() {
    let constant = OneOnOne::thesis().unwrap();
    let slowed = |robot: &Vehicle| robot.with_speed_law(SpeedLaw::Cosine);
    let cosine =
        OneOnOne::new(slowed(constant.pursuer()), slowed(constant.evader()), 0.1, 0.1).unwrap();
    let swept = cosine.with_capture(Capture::Swept);
    let pd = Controller::Pd(Pd::new(1.2, 0.1).unwrap());
    let fuzzy = Controller::Fuzzy(Box::new(fuzzy()));
    let turning = |wrapped| Controller::EvasiveTurn(EvasiveTurn::new(0.6, wrapped).unwrap());
    // Three blocks and a rest, so that several threads have work.
    let starts = starts(3 * 256 + 11);
    for (game, pursuer, evader) in [
        (constant, Controller::Classical, Controller::Classical),
        (constant, fuzzy.clone(), Controller::Classical),
        (constant, Controller::Table(table()), Controller::Classical),
        (constant, Controller::MixedTable(mixed()), Controller::Classical),
        (constant, Controller::Classical, Controller::MixedTable(mixed())),
        (cosine, Controller::BangBang, turning(false)),
        (swept, pd.clone(), turning(true)),
        (cosine, Controller::Parallel(Box::new((pd, fuzzy))), turning(false)),
    ] {
        let alone: Vec<_> = starts
            .iter()
            .map(|&start| bits(&play(&game, &pursuer, &evader, start, 150).unwrap().outcome))
            .collect();
        assert!(alone.iter().any(|o| o.0) && alone.iter().any(|o| !o.0 || o.1 > 40));
        for threads in [1, 2, 7] {
            let control = Control::new();
            let many =
                play_many(&game, &pursuer, &evader, &starts, 150, threads, &control).unwrap();
            assert!(many.iter().map(bits).eq(alone.iter().copied()), "{threads} threads");
            assert_eq!(control.done(), starts.len() as u64);
        }
    }
}

#[test]
fn pairs_of_different_robots_play_as_each_would_alone() {
    let mut rng = Rng::new(5, 0);
    let mut robot = || {
        let (speed, limit) = (rng.uniform_in(0.5, 2.0), rng.uniform_in(0.3, 1.0));
        Vehicle::new(speed, rng.uniform_in(0.2, 0.5), limit).unwrap()
    };
    let starts = starts(256 + 40);
    let games: Vec<OneOnOne> =
        starts.iter().map(|_| OneOnOne::new(robot(), robot(), 0.1, 0.1).unwrap()).collect();
    let fuzzy = Controller::Fuzzy(Box::new(fuzzy()));
    for pursuer in [Controller::Classical, fuzzy] {
        let alone: Vec<_> = games
            .iter()
            .zip(&starts)
            .map(|(game, &start)| play(game, &pursuer, &Controller::Classical, start, 200).unwrap())
            .map(|path| bits(&path.outcome))
            .collect();
        assert!(alone.iter().any(|o| o.0) && alone.iter().any(|o| !o.0));
        for threads in [1, 3] {
            let classical = &Controller::Classical;
            let control = Control::new();
            let pairs = play_pairs(&games, &pursuer, classical, &starts, 200, threads, &control);
            assert!(pairs.unwrap().iter().map(bits).eq(alone.iter().copied()));
        }
    }
}

#[test]
fn pairs_under_different_rules_are_refused() {
    let (game, start) = (OneOnOne::thesis().unwrap(), Start::evader_at(2.0, 1.0));
    let swept = game.with_capture(Capture::Swept);
    let slowed = game.evader().with_speed_law(SpeedLaw::Cosine);
    let slowed = OneOnOne::new(*game.pursuer(), slowed, 0.1, 0.1).unwrap();
    let played = |games: &[OneOnOne]| {
        let (classical, control) = (&Controller::Classical, Control::new());
        play_pairs(games, classical, classical, &[start; 2], 100, 1, &control)
    };
    for other in [swept, slowed] {
        let message = played(&[game, other]).unwrap_err().to_string();
        assert!(message.contains("one capture radius"), "{message}");
    }
    assert!(played(&[game]).is_err());
    assert_eq!(played(&[game, game]).unwrap().len(), 2);
}

#[test]
fn a_population_plays_as_its_members_would() {
    let game = OneOnOne::thesis().unwrap();
    let (controller, start) = (fuzzy(), Start::evader_at(-6.0, 7.0));
    let mut rng = Rng::new(3, 0);
    let mut population = Vec::new();
    let members: Vec<FuzzyController> = (0..37)
        .map(|_| {
            let mut vector = controller.system().parameters().to_vec();
            vector.iter_mut().skip(12).for_each(|k| *k = rng.uniform_in(-1.5, 1.5));
            population.extend_from_slice(&vector);
            controller.with_parameters(&vector).unwrap()
        })
        .collect();
    let starts = [start, Start::evader_at(5.0, -1.0)];
    let together = play_population(
        &game,
        Entrant::Population(&controller, &population),
        Entrant::Same(&Controller::Classical),
        &starts,
        300,
        &Control::new(),
    )
    .unwrap();
    assert_eq!(together.len(), 2 * members.len());
    for (start, together) in starts.into_iter().zip(together.chunks(members.len())) {
        for (member, outcome) in members.iter().zip(together) {
            let member = Controller::Fuzzy(Box::new(member.clone()));
            let alone = play(&game, &member, &Controller::Classical, start, 300).unwrap();
            assert_eq!(bits(&alone.outcome), bits(outcome));
        }
    }
}

#[test]
fn two_populations_meet_place_by_place() {
    let game = OneOnOne::thesis().unwrap();
    let (controller, start) = (fuzzy(), Start::evader_at(2.0, 4.0));
    let mut rng = Rng::new(5, 0);
    let mut drawn = |count: usize| -> Vec<Vec<f64>> {
        let mut population = vec![controller.system().parameters().to_vec(); count];
        let consequents = population.iter_mut().flat_map(|vector| vector.iter_mut().skip(12));
        consequents.for_each(|k| *k += rng.uniform_in(-0.3, 0.3));
        population
    };
    let (pursuers, evaders) = (drawn(11), drawn(11));
    let (all, others) = (pursuers.concat(), evaders.concat());
    let play_all = |pursuers, evaders| {
        play_population(&game, pursuers, evaders, &[start], 300, &Control::new())
    };
    let first = Entrant::Population(&controller, &all);
    let together = play_all(first, Entrant::Population(&controller, &others)).unwrap();
    let member = |vector: &Vec<f64>| {
        Controller::Fuzzy(Box::new(controller.with_parameters(vector).unwrap()))
    };
    for ((pursuer, evader), outcome) in pursuers.iter().zip(&evaders).zip(&together) {
        let alone = play(&game, &member(pursuer), &member(evader), start, 300).unwrap();
        assert_eq!(bits(&alone.outcome), bits(outcome));
    }
    let fewer = Entrant::Population(&controller, &others[..others.len() / 11 * 10]);
    let message = play_all(first, fewer).unwrap_err().to_string();
    assert_eq!(message, "individuals of another population: expected 11, got 10");
}

#[test]
fn robots_that_learn_together_need_the_same_games() {
    let (game, control) = (OneOnOne::thesis().unwrap(), Control::new());
    let own = QLambdaTraining { episodes: 2, ..QLambdaTraining::default() };
    let learn = |other: QLambdaTraining| {
        own.train_both(&other, &game, 0, &control).map_err(|error| error.to_string())
    };
    let other = QLambdaTraining { episodes: 3, ..own.clone() };
    let message = learn(other).unwrap_err();
    assert!(message.ends_with("of the evader's settings, as of the pursuer's: expected 2, got 3"));
    let other = QLambdaTraining { starts: vec![(1.0, 1.0)], ..own.clone() };
    assert!(learn(other).unwrap_err().contains("give both the same starts"));
    let other = QLambdaTraining { actions: 21, exploration: 1.0, ..own.clone() };
    assert!(learn(other).unwrap().evader.is_some());
}

fn agent() -> TableAgent {
    let axis = (-1.0, 1.0, 11);
    TableAgent::new(TableAgentSettings {
        states: Discretiser::new(&[axis, axis]).unwrap(),
        actions: (-5..=5).map(|k| vec![0.1 * f64::from(k)]).collect(),
        discount: 0.5,
        trace_decay: 0.3,
        trace: Trace::ReplacingState,
        cut: Cut::Never,
        learning_rate: Schedule::power("learning rate", 1.0, 0.7).unwrap(),
        exploring: Exploring::EpsilonGreedy,
        exploration: Schedule::power("exploration rate", 1.0, 1.0).unwrap(),
    })
    .unwrap()
}

#[test]
fn practice_in_two_parts_is_the_same_as_in_one() {
    let (game, control) = (OneOnOne::thesis().unwrap(), Control::new());
    let starts = [(2.0, 4.0), (3.0, -8.0), (-6.0, 7.0)];
    for role in [Role::Pursuer, Role::Evader] {
        let practice = Practice {
            game: &game,
            role,
            opponent: &Controller::Classical,
            starts: &starts,
            steps: 300,
            bootstrap_at_capture: true,
        };
        let play = |parts: &[[u64; 2]]| {
            let (mut agent, mut rng) = (agent(), Rng::new(4, 0));
            let outcomes: Vec<_> = parts
                .iter()
                .flat_map(|part| {
                    practice.play(&mut agent, &mut rng, part[0]..part[1], 9, &control).unwrap()
                })
                .map(|outcome| bits(&outcome))
                .collect();
            (outcomes, agent.learner().values().to_vec())
        };
        let whole = play(&[[1, 13]]);
        assert_eq!(whole, play(&[[1, 6], [6, 13]]));
        assert_eq!(whole.0.len(), 12);
        assert!(whole.1.iter().any(|&value| value != 0.0));
    }
}

#[test]
fn practice_is_for_agents_that_fit_the_game() {
    let (game, control) = (OneOnOne::thesis().unwrap(), Control::new());
    let practice = Practice {
        game: &game,
        role: Role::Pursuer,
        opponent: &Controller::Classical,
        starts: &[(2.0, 4.0)],
        steps: 300,
        bootstrap_at_capture: true,
    };
    let mut settings = agent().settings().clone();
    settings.states = Discretiser::new(&[(-1.0, 1.0, 3)]).unwrap();
    let mut narrow = TableAgent::new(settings).unwrap();
    let error = practice.play(&mut narrow, &mut Rng::new(0, 0), 1..2, 0, &control).unwrap_err();
    assert_eq!(error.to_string(), "observations of an agent in this game: expected 2, got 1");
}

#[test]
fn every_technique_gives_the_same_twice_and_another_with_another_seed() {
    let game = OneOnOne::thesis().unwrap();
    let phase = |population| GeneticPhase { iterations: 20, population, ..GeneticPhase::default() };
    let q_lambda = QLambdaTraining { episodes: 30, ..QLambdaTraining::default() };
    let reward_ga = RewardGaTraining { genetic: phase(40), ..RewardGaTraining::default() };
    let qlbgflc = QlbgflcTraining {
        phase_1: q_lambda.clone(),
        stage_1: phase(40),
        stage_2: phase(10),
        ..QlbgflcTraining::default()
    };
    let control = Control::new();
    let evader = Controller::Classical;
    let runs = |seed| {
        [
            q_lambda.train(&game, &evader, seed, &control).unwrap(),
            reward_ga.train(&game, &evader, seed, &control).unwrap(),
            qlbgflc.train(&game, &evader, seed, &control).unwrap(),
            q_lambda.train_both(&q_lambda, &game, seed, &control).unwrap(),
            reward_ga.train_both(&reward_ga, &game, seed, &control).unwrap(),
            qlbgflc.train_both(&qlbgflc, &game, seed, &control).unwrap(),
        ]
    };
    assert_eq!(runs(1), runs(1));
    for (one, other) in runs(1).iter().zip(&runs(2)) {
        assert_ne!(one, other);
    }
}

#[test]
fn training_stops_on_request() {
    let game = OneOnOne::thesis().unwrap();
    let control = Control::new();
    control.cancel();
    let evader = Controller::Classical;
    let stopped = [
        QLambdaTraining::default().train(&game, &evader, 0, &control),
        RewardGaTraining::default().train(&game, &evader, 0, &control),
        QlbgflcTraining::default().train(&game, &evader, 0, &control),
    ];
    for result in stopped {
        assert_eq!(result.unwrap_err().kind(), "cancelled");
    }
}
