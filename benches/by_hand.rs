//! The yardstick: the games of sections 6.5.2 and 8.4 as one writes them by hand, one game at a
//! time, with the standard library's functions.

use std::f64::consts::PI;

const TIME_STEP: f64 = 0.1;
const CAPTURE_RADIUS: f64 = 0.1;

struct Robot {
    speed: f64,
    wheelbase: f64,
    max_steering: f64,
    x: f64,
    y: f64,
    heading: f64,
}

impl Robot {
    fn advance(&mut self, steering: f64) {
        let steering = steering.clamp(-self.max_steering, self.max_steering);
        self.heading += self.speed / self.wheelbase * steering.tan() * TIME_STEP;
        let (sine, cosine) = self.heading.sin_cos();
        self.x += self.speed * cosine * TIME_STEP;
        self.y += self.speed * sine * TIME_STEP;
    }
}

fn wrap(angle: f64) -> f64 {
    angle - 2.0 * PI * (angle / (2.0 * PI)).round()
}

/// Plays against the classical evader, which starts at (x, y), and returns the number of steps.
/// `steer` turns the pursuer's δ and δ̇ into its steering angle.
pub fn play((x, y): (f64, f64), max_steps: u32, steer: impl Fn(f64, f64) -> f64) -> u32 {
    let at = |speed, max_steering, x, y| Robot {
        speed,
        wheelbase: 0.3,
        max_steering,
        x,
        y,
        heading: 0.0,
    };
    let mut pursuer = at(2.0, 0.5, 0.0, 0.0);
    let mut evader = at(1.0, 1.0, x, y);
    let mut last = None;
    for step in 0..max_steps {
        let (dx, dy) = (evader.x - pursuer.x, evader.y - pursuer.y);
        if (dx * dx + dy * dy).sqrt() < CAPTURE_RADIUS {
            return step;
        }
        let direction = dy.atan2(dx);
        let angle = wrap(direction - pursuer.heading);
        let rate = wrap(angle - last.unwrap_or(angle)) / TIME_STEP;
        last = Some(angle);
        pursuer.advance(steer(angle, rate));
        evader.advance(wrap(direction - evader.heading));
    }
    max_steps
}

/// Plays two classical pursuers, which start at these positions, against the classical evader in
/// the origin, and returns the number of steps. With `predict` pursuers steer to where they would
/// meet the evader (8.19-8.24).
pub fn play_two(positions: [(f64, f64); 2], max_steps: u32, predict: bool) -> u32 {
    let at = |speed, max_steering, (x, y)| Robot {
        speed,
        wheelbase: 0.2,
        max_steering,
        x,
        y,
        heading: 0.0,
    };
    let mut pursuers = positions.map(|position| at(0.5, 0.5, position));
    let mut evader = at(0.3, 0.8, (0.0, 0.0));
    for step in 0..max_steps {
        let offsets = [0, 1].map(|i: usize| (evader.x - pursuers[i].x, evader.y - pursuers[i].y));
        let distances = offsets.map(|(dx, dy)| (dx * dx + dy * dy).sqrt());
        if distances[0] < CAPTURE_RADIUS || distances[1] < CAPTURE_RADIUS {
            return step;
        }
        let weight = distances[1] / distances[0];
        let flight = (offsets[0].1 * weight + offsets[1].1 / weight)
            .atan2(offsets[0].0 * weight + offsets[1].0 / weight);
        for (i, pursuer) in pursuers.iter_mut().enumerate() {
            let mut sight = offsets[i];
            if predict {
                let (sine, cosine) = evader.heading.sin_cos();
                let along = -(sight.0 * cosine + sight.1 * sine) / distances[i];
                let beta = along.clamp(-1.0, 1.0).acos();
                let alpha = (evader.speed / pursuer.speed * beta.sin()).asin();
                let way = distances[i] * alpha.sin() / (alpha + beta).sin();
                sight = (sight.0 + way * cosine, sight.1 + way * sine);
            }
            pursuer.advance(wrap(sight.1.atan2(sight.0) - pursuer.heading));
        }
        evader.advance(wrap(flight - evader.heading));
    }
    max_steps
}
