//! Chapter 4 without learning: who catches the turning evader, when, and why.

use std::f64::consts::PI;

use pursuit_sim::{
    Capture, Controller, EvasiveTurn, OneOnOne, Pd, SpeedLaw, Start, Trajectory, Vehicle, play,
};

/// Starts of the evader (m): those of Tables 4.6 and 4.7.
const STARTS: [(f64, f64); 8] = [
    (3.0, 3.0),
    (-2.0, 4.0),
    (2.0, 5.0),
    (-1.0, 5.0),
    (1.0, 6.0),
    (-3.0, 5.0),
    (4.0, -2.0),
    (7.0, 1.0),
];
/// Published capture times (s).
const CLASSICAL: [f64; 8] = [7.0, 8.7, 9.2, 9.3, 10.7, 11.5, 7.6, 13.0];
const PD: [f64; 8] = [18.8, 21.5, 21.3, 22.0, 23.1, 24.3, 19.2, 24.4];
const IANFIS: [f64; 8] = [7.5, 10.1, 10.0, 10.5, 11.6, 12.9, 7.9, 13.1];

fn game(pursuer: SpeedLaw) -> OneOnOne {
    let robot = |speed, limit| Vehicle::new(speed, 1.0, limit).unwrap();
    let pursuer = robot(1.0, PI / 6.0).with_speed_law(pursuer);
    let evader = robot(0.5, PI / 3.0).with_speed_law(SpeedLaw::Cosine);
    OneOnOne::new(pursuer, evader, 0.1, 0.1).unwrap()
}

fn pd(gain: f64) -> Controller {
    Controller::Pd(Pd::new(0.99 * gain, 0.02 * gain).unwrap())
}

fn pursue(game: &OneOnOne, pursuer: &Controller, switching_distance: f64) -> Vec<Trajectory> {
    let evader = Controller::EvasiveTurn(EvasiveTurn::new(switching_distance, false).unwrap());
    let one = |&(x, y): &(f64, f64)| play(game, pursuer, &evader, Start::evader_at(x, y), 600);
    STARTS.iter().map(|start| one(start).unwrap()).collect()
}

fn times(paths: &[Trajectory]) -> Vec<f64> {
    paths.iter().map(|path| path.outcome.capture_time(0.1).unwrap_or(f64::INFINITY)).collect()
}

fn farthest(ours: &[f64], published: &[f64]) -> f64 {
    ours.iter().zip(published).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn the_classical_row_is_bang_bang_at_constant_speed() {
    let paths = pursue(&game(SpeedLaw::Constant), &Controller::BangBang, 1.6);
    assert_eq!(times(&paths), CLASSICAL);
    // With the turning radius as the switching distance each capture is a step earlier.
    let paths = pursue(&game(SpeedLaw::Constant), &Controller::BangBang, 3.0_f64.sqrt());
    let earlier: Vec<f64> = CLASSICAL.iter().map(|time| time - 0.1).collect();
    assert!(farthest(&times(&paths), &earlier) < 0.05);
}

#[test]
fn the_classical_law_as_printed_misses_its_row() {
    let slowed = game(SpeedLaw::Cosine);
    let literal = times(&pursue(&slowed, &Controller::Classical, 1.6));
    assert!(literal.iter().zip(CLASSICAL).all(|(ours, print)| ours - print > 10.0), "{literal:?}");
    let bang_bang = times(&pursue(&slowed, &Controller::BangBang, 1.6));
    assert!(bang_bang.iter().zip(CLASSICAL).all(|(ours, print)| ours - print > 2.0));
}

#[test]
fn the_pd_misses_by_centimetres_and_flies_one_more_circle() {
    let paths = pursue(&game(SpeedLaw::Cosine), &pd(1.0), 1.6);
    let ours = times(&paths);
    assert!(farthest(&ours, &PD) < 0.5, "{ours:?}");
    // A circle lasts 2π/(V sin u_max / L) = 12.6 s.
    let doubled = times(&pursue(&game(SpeedLaw::Cosine), &pd(2.0), 1.6));
    for (path, (&late, &early)) in paths.iter().zip(ours.iter().zip(&doubled)) {
        let first_pass = &path.distance[..(early * 10.0) as usize + 10];
        let nearest = first_pass.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(nearest > 0.1 && nearest < 0.13, "{nearest}");
        assert!(late > 15.0 && (late - early - 4.0 * PI).abs() < 1.5, "{late} after {early}");
    }
}

#[test]
fn doubled_gains_are_the_row_of_ianfis() {
    let ours = times(&pursue(&game(SpeedLaw::Cosine), &pd(2.0), 1.6));
    assert_eq!(ours, IANFIS);
}

/// The pursuer passes by because it steers too little, not because nobody looks between samples.
#[test]
fn sweeping_between_the_samples_changes_no_capture_time() {
    let sampled = game(SpeedLaw::Cosine);
    let swept = sampled.with_capture(Capture::Swept);
    for gain in [1.0, 2.0] {
        let of_ways = times(&pursue(&swept, &pd(gain), 1.6));
        assert_eq!(of_ways, times(&pursue(&sampled, &pd(gain), 1.6)));
    }
}

#[test]
fn a_pursuer_that_dashes_past_between_two_samples_catches_only_when_swept() {
    let robot = |speed| Vehicle::new(speed, 1.0, 0.5).unwrap();
    let sampled = OneOnOne::new(robot(5.0), robot(0.0), 0.1, 1.0).unwrap();
    let play = |game: &OneOnOne| {
        let start = Start::evader_at(7.5, 0.0);
        play(game, &Controller::Classical, &Controller::Classical, start, 3).unwrap().outcome
    };
    assert!(!play(&sampled).captured);
    let swept = play(&sampled.with_capture(Capture::Swept));
    assert_eq!((swept.captured, swept.steps), (true, 2));
    assert!(swept.miss_distance < 1e-12 && swept.last_distance > 2.0);
}
