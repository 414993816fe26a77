//! The yardstick: the game of section 6.5.2 as one writes it by hand, one game at a time, with
//! the standard library's functions.

use std::f64::consts::PI;

const TIME_STEP: f64 = 0.1;
const WHEELBASE: f64 = 0.3;
const CAPTURE_RADIUS: f64 = 0.1;

struct Robot {
    speed: f64,
    max_steering: f64,
    x: f64,
    y: f64,
    heading: f64,
}

impl Robot {
    fn advance(&mut self, steering: f64) {
        let steering = steering.clamp(-self.max_steering, self.max_steering);
        self.heading += self.speed / WHEELBASE * steering.tan() * TIME_STEP;
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
    let mut pursuer = Robot { speed: 2.0, max_steering: 0.5, x: 0.0, y: 0.0, heading: 0.0 };
    let mut evader = Robot { speed: 1.0, max_steering: 1.0, x, y, heading: 0.0 };
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
