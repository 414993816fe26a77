//! Chapter 3: the controller that the thesis ended with, beside the PD controller that taught it.

use pursuit_sim::strategy::{FuzzySystem, THESIS_READINGS};
use pursuit_sim::{FuzzyRegulator, Pd, Pose, Regulator, Vehicle, Wall, WallFollowing, WallRun};

fn expert() -> Regulator {
    Regulator::Pd(Pd::new(1.2, 1.5).unwrap())
}

fn fuzzy(regulator: FuzzyRegulator) -> Regulator {
    Regulator::Fuzzy(Box::new(regulator))
}

/// 600 s along a wall.
fn run(wall: &Wall, regulator: &Regulator, y: f64, time_step: f64) -> WallRun {
    let robot = Vehicle::new(0.5, 0.1, 1.2).unwrap();
    let plant = WallFollowing::new(robot, wall.clone(), 1.0, 10.0, time_step).unwrap();
    let steps = (600.0 / time_step).round() as u32;
    plant.follow(regulator, Pose { x: 0.0, y, heading: 0.0 }, steps).unwrap()
}

/// The integral of the absolute error and the mean squared one, both relative to the expert's.
fn ratios(wall: &Wall, regulator: &Regulator, y: f64, time_step: f64) -> (f64, f64) {
    let own = run(wall, regulator, y, time_step);
    let expert = run(wall, &expert(), y, time_step);
    assert!(!own.lost && !expert.lost);
    let (own, expert) = (own.measures(0.0).unwrap(), expert.measures(0.0).unwrap());
    (own.iae / expert.iae, own.mse / expert.mse)
}

fn smooth_walls() -> [Wall; 3] {
    [Wall::jog().unwrap(), Wall::poly().unwrap(), Wall::sine().unwrap()]
}

#[test]
fn the_thesis_controller_beats_its_expert_on_smooth_walls() {
    let tuned = fuzzy(FuzzyRegulator::thesis().unwrap());
    let measured = [(0.78, 0.58), (0.73, 0.47), (0.51, 0.29)];
    for (wall, (iae, mse)) in smooth_walls().iter().zip(measured) {
        for (y, time_step) in
            [(1.0, 0.1), (1.2, 0.1), (1.45, 0.1), (1.0, 0.05), (1.2, 0.05), (1.45, 0.05)]
        {
            let (iae, mse) = ratios(wall, &tuned, y, time_step);
            assert!(iae < 0.85 && mse < 0.80, "{iae} {mse}");
        }
        let found = ratios(wall, &tuned, 1.2, 0.1);
        assert!((found.0 - iae).abs() < 0.01 && (found.1 - mse).abs() < 0.01, "{found:?}");
    }
}

#[test]
fn fourteen_rules_do_as_well_whatever_the_scan_lost() {
    for reading in 0..THESIS_READINGS {
        let pruned = fuzzy(FuzzyRegulator::thesis_pruned(reading).unwrap());
        for wall in smooth_walls() {
            let (iae, mse) = ratios(&wall, &pruned, 1.2, 0.1);
            assert!(iae < 0.85 && mse < 0.90, "reading {reading}: {iae} {mse}");
        }
    }
}

#[test]
fn what_the_robot_measures_must_not_jump() {
    let tuned = fuzzy(FuzzyRegulator::thesis().unwrap());
    let (iae, _) = ratios(&Wall::step().unwrap(), &tuned, 1.2, 0.1);
    assert!((1.2..1.4).contains(&iae), "{iae}");
}

#[test]
fn the_minimum_leaves_an_offset_where_the_product_does_not() {
    let text = FuzzyRegulator::thesis().unwrap().to_json().unwrap();
    let clipped = FuzzyRegulator::from_json(&text.replace("\"product\"", "\"min\"")).unwrap();
    let mut scratch = vec![0.0; clipped.scratch_count()];
    assert!((clipped.output(0.0, 0.0, &mut scratch) + 0.03).abs() < 0.005);
    for (wall, iae) in smooth_walls().iter().zip([6.8, 6.4, 3.8]) {
        let found = ratios(wall, &fuzzy(clipped.clone()), 1.2, 0.1);
        assert!((found.0 - iae).abs() < 0.1, "{found:?}");
    }
}

#[test]
fn no_rule_of_the_fourteen_asks_for_errors_below_half_a_metre() {
    let pruned = FuzzyRegulator::thesis_pruned(4).unwrap();
    assert!(matches!(pruned.system(), FuzzySystem::Rules(_)));
    let mut scratch = vec![0.0; pruned.scratch_count()];
    assert!(pruned.output(-0.48, 0.0, &mut scratch) < 0.0);
    assert_eq!(pruned.output(-0.50, 0.0, &mut scratch), 0.0);
    let run = run(&Wall::straight().unwrap(), &fuzzy(pruned), 1.55, 0.1);
    assert!(run.error.iter().all(|&e| e < -0.5), "it drives on beside the wall");
}
