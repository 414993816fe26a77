//! Table 6.3, first row: classical against classical, exactly.

use pursuit_sim::{Controller, OneOnOne, Pose, Start, Vehicle, play};

/// Starts of the evader (m) and the published capture times (s).
const PUBLISHED: [((f64, f64), f64); 4] =
    [((-6.0, 7.0), 9.6), ((-7.0, -7.0), 10.4), ((2.0, 4.0), 4.5), ((3.0, -8.0), 8.5)];

#[test]
fn capture_times_are_the_published_ones() {
    let game = OneOnOne::thesis().unwrap();
    for ((x, y), published) in PUBLISHED {
        let start = Start::evader_at(x, y);
        let path = play(&game, &Controller::Classical, &Controller::Classical, start, 600).unwrap();
        assert_eq!(path.outcome.capture_time(game.time_step()), Some(published));
        assert_eq!(path.pursuer.len(), path.outcome.steps as usize + 1);
        assert_eq!(path.reward.len(), path.outcome.steps as usize);
    }
}

/// The integrator is decided by the table: the position along the old heading misses it.
#[test]
fn the_old_heading_would_miss_the_table() {
    let game = OneOnOne::thesis().unwrap();
    let explicit = |robot: &Vehicle, pose: Pose, angle: f64| {
        let steering = robot.limit(angle);
        let next = robot.advance(pose, steering, 0.1);
        let straight = robot.advance(pose, 0.0, 0.1);
        Pose { heading: next.heading, ..straight }
    };
    let mut exact = 0;
    for ((x, y), published) in PUBLISHED {
        let Start { mut pursuer, mut evader } = Start::evader_at(x, y);
        let mut steps = 0;
        loop {
            let sight = pursuit_sim::observation::Sight::between(&pursuer, &evader);
            if sight.distance < 0.1 || steps == 600 {
                break;
            }
            pursuer = explicit(game.pursuer(), pursuer, sight.pursuer_angle);
            evader = explicit(game.evader(), evader, sight.evader_angle);
            steps += 1;
        }
        exact += u32::from((f64::from(steps) * 0.1 - published).abs() < 0.01);
    }
    assert_eq!(exact, 1);
}

#[test]
fn rewards_telescope() {
    let game = OneOnOne::thesis().unwrap();
    let start = Start::evader_at(5.0, -3.0);
    let path = play(&game, &Controller::Classical, &Controller::Classical, start, 600).unwrap();
    let closed = (path.outcome.first_distance - path.outcome.last_distance) / 0.3;
    assert!((path.reward.iter().sum::<f64>() - closed).abs() < 1e-9);
    assert!(path.reward.iter().all(|r| r.abs() <= 1.0 + 1e-9));
    let nearest = path.distance.iter().copied().fold(f64::INFINITY, f64::min);
    assert_eq!(path.outcome.miss_distance, nearest);
}

#[test]
fn a_game_that_begins_within_the_radius_is_over() {
    let game = OneOnOne::thesis().unwrap();
    let start = Start::evader_at(0.05, 0.0);
    let path = play(&game, &Controller::Classical, &Controller::Classical, start, 600).unwrap();
    assert_eq!(path.outcome.capture_time(0.1), Some(0.0));
    assert!(path.reward.is_empty());
}

#[test]
fn bad_requests_are_refused_in_words() {
    let game = OneOnOne::thesis().unwrap();
    let classical = &Controller::Classical;
    let message =
        |start, steps| play(&game, classical, classical, start, steps).unwrap_err().to_string();
    assert_eq!(message(Start::evader_at(1.0, 1.0), 0), "number of steps must be at least 1, got 0");
    assert_eq!(
        message(Start::evader_at(1.0, f64::NAN), 10),
        "starting y of the evader must be finite, got NaN"
    );
    let fast = Vehicle::new(1e308, 0.3, 0.5).unwrap();
    let game = OneOnOne::new(fast, *game.evader(), 0.1, 0.1).unwrap();
    let error = play(&game, classical, classical, Start::evader_at(1.0, 1.0), 600).unwrap_err();
    assert!(error.to_string().contains("the game diverged at"), "{error}");
}
