//! What holds in every game, whoever plays it.

use fuzzy_core::{NoRuleFires, Shape, Tsk, Variable};
use proptest::prelude::*;
use pursuit_sim::{Controller, FuzzyController, OneOnOne, Pose, Start, Vehicle, play};

fn game() -> impl Strategy<Value = OneOnOne> {
    let vehicle =
        || (0.1..3.0, 0.2..1.0, 0.1..1.2).prop_map(|(v, l, u)| Vehicle::new(v, l, u).unwrap());
    (vehicle(), vehicle(), 0.02..0.2)
        .prop_map(|(pursuer, evader, step)| OneOnOne::new(pursuer, evader, 0.1, step).unwrap())
}

fn start() -> impl Strategy<Value = Start> {
    let pose =
        || (-9.0..9.0, -9.0..9.0, -3.0..3.0).prop_map(|(x, y, heading)| Pose { x, y, heading });
    (pose(), pose()).prop_map(|(pursuer, evader)| Start { pursuer, evader })
}

/// A controller that steers to the left as to the right.
fn fuzzy() -> Controller {
    let inputs = ["angle", "rate"].map(|name| {
        Variable::evenly(name, (-1.0, 1.0), Shape::GaussianWidth, &["N", "Z", "P"]).unwrap()
    });
    let consequents = vec![-0.9, -0.5, -0.2, -0.4, 0.0, 0.4, 0.2, 0.5, 0.9];
    let system = Tsk::zero_order("fuzzy", inputs.to_vec(), consequents)
        .and_then(|system| system.when_no_rule_fires(NoRuleFires::Value(0.0)))
        .unwrap();
    Controller::Fuzzy(Box::new(FuzzyController::new(system, 1.0, 1.0).unwrap()))
}

fn controller() -> impl Strategy<Value = Controller> {
    prop::sample::select(vec![Controller::Classical, fuzzy()])
}

fn mirrored(pose: Pose) -> Pose {
    Pose { x: pose.x, y: -pose.y, heading: -pose.heading }
}

/// The larger of two poses' differences in position and heading.
fn gap(one: Pose, other: Pose) -> f64 {
    let position = (one.x - other.x).abs().max((one.y - other.y).abs());
    position.max((one.heading - other.heading).abs())
}

proptest! {
    /// Short games: rounding grows from step to step.
    #[test]
    fn a_mirrored_start_gives_the_mirrored_path(
        game in game(), start in start(), pursuer in controller(), evader in controller(),
    ) {
        let path = play(&game, &pursuer, &evader, start, 20).unwrap();
        let other =
            Start { pursuer: mirrored(start.pursuer), evader: mirrored(start.evader) };
        let other = play(&game, &pursuer, &evader, other, 20).unwrap();
        prop_assert_eq!(path.outcome.steps, other.outcome.steps);
        let robots = [(path.pursuer, other.pursuer), (path.evader, other.evader)];
        for (pose, image) in robots.into_iter().flat_map(|(own, other)| own.into_iter().zip(other)) {
            prop_assert!(gap(pose, mirrored(image)) <= 1e-9, "{pose:?} {image:?}");
        }
    }

    #[test]
    fn nothing_moves_faster_than_it_can(
        game in game(), start in start(), pursuer in controller(), evader in controller(),
    ) {
        let path = play(&game, &pursuer, &evader, start, 200).unwrap();
        let most = (game.pursuer().speed() + game.evader().speed()) * game.time_step();
        for pair in path.distance.windows(2) {
            prop_assert!((pair[0] - pair[1]).abs() <= most + 1e-12, "{pair:?}, at most {most}");
        }
        for (robot, poses) in [(game.pursuer(), &path.pursuer), (game.evader(), &path.evader)] {
            let (way, turn) = (robot.speed() * game.time_step(), robot.turning_radius());
            for pair in poses.windows(2) {
                let moved = (pair[1].x - pair[0].x).hypot(pair[1].y - pair[0].y);
                prop_assert!((moved - way).abs() <= 1e-12);
                let turned = (pair[1].heading - pair[0].heading).abs();
                prop_assert!(turned <= way / turn + 1e-12, "{turned}");
            }
        }
    }

    #[test]
    fn rewards_add_up_to_the_way_closed(
        game in game(), start in start(), pursuer in controller(), evader in controller(),
    ) {
        let path = play(&game, &pursuer, &evader, start, 200).unwrap();
        let most = (game.pursuer().speed() + game.evader().speed()) * game.time_step();
        let closed = (path.outcome.first_distance - path.outcome.last_distance) / most;
        prop_assert!((path.reward.iter().sum::<f64>() - closed).abs() <= 1e-9);
        prop_assert!(path.reward.iter().all(|reward| reward.abs() <= 1.0 + 1e-9));
    }
}
