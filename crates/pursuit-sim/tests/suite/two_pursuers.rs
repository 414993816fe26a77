//! Section 8.4: two pursuers, one evader.

use pursuit_sim::rollout::two_pursuers::play;
use pursuit_sim::{Aim, Controller, TwoPursuers, TwoPursuersStart};

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
