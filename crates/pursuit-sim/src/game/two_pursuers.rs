//! Two pursuers, one evader.

use fuzzy_core::check;
use fuzzy_core::math::{Real, atan2, sin_cos, wrap_angle};

use crate::error::Result;
use crate::game::one_on_one::{Capture, check_poses};
use crate::observation::{Observation, nearest_approach, rate};
use crate::vehicle::{Motion, Pose, Vehicle};

/// Two pursuers want one of them to come nearer to an evader than the capture radius, the evader
/// to prevent it (section 8.4).
///
/// Time is sampled and captures are tested as in [`OneOnOne`](super::one_on_one::OneOnOne); the
/// game ends with the first capture. The [`Aim`] says where the pursuers steer to, the [`Flight`]
/// where the evader wants to go. Each robot observes the angle from its heading to that direction
/// and the angle's rate of change, so that the controllers of a game of two robots serve here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoPursuers {
    pursuers: [Vehicle; 2],
    evader: Vehicle,
    capture_radius: f64,
    time_step: f64,
    capture: Capture,
    aim: Aim,
    flight: Flight,
}

/// Where a pursuer steers to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aim {
    /// To where the evader is (8.7).
    LineOfSight,
    /// To where it would be caught if it drove straight on along its heading (8.24).
    Intercept,
    /// To where it would be caught if it drove straight along its [`Flight`] (8.22 as printed).
    InterceptFlight,
}

impl Aim {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::LineOfSight => "line-of-sight",
            Self::Intercept => "intercept",
            Self::InterceptFlight => "intercept-flight",
        }
    }

    /// The aim with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices = [Self::LineOfSight, Self::Intercept, Self::InterceptFlight];
        Ok(check::named("aim", name, choices, Self::name)?)
    }
}

/// The direction in which an evader flees from two pursuers, D₂ᵏ·P₁E + D₁ᵏ·P₂E: P_iE is the vector
/// from pursuer i to the evader, D_i its length. The larger k, the more the nearer pursuer counts.
///
/// The printed forms have denominators; without them directions stay and nothing is 0/0. Where the
/// sum is the null vector, as between equally distant pursuers, the evader flees from the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Flight {
    /// k = 2: W·P₁E + P₂E/W with W = D₂/D₁ (8.10, 8.11).
    Weighted,
    /// k = 3: the same of the unit vectors, (W/D₁)·P₁E + P₂E/(W·D₂).
    WeightedUnits,
    /// k → ∞: away from the nearer pursuer, from the first of two equally near (8.8).
    Nearest,
    /// k = 0: P₁E + P₂E (8.9).
    Sum,
    /// k = 1: the same of the unit vectors, P₁E/D₁ + P₂E/D₂.
    SumOfUnits,
}

impl Flight {
    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Weighted => "weighted",
            Self::WeightedUnits => "weighted-units",
            Self::Nearest => "nearest",
            Self::Sum => "sum",
            Self::SumOfUnits => "sum-of-units",
        }
    }

    /// The direction with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let choices =
            [Self::Weighted, Self::WeightedUnits, Self::Nearest, Self::Sum, Self::SumOfUnits];
        Ok(check::named("direction of flight", name, choices, Self::name)?)
    }

    /// A vector in this direction, of any length, from the offsets of the evader as seen from the
    /// pursuers and their lengths.
    #[inline(always)]
    fn direction<R: Real>(self, offsets: [(R, R); 2], distances: [R; 2]) -> (R, R) {
        let [first, second] = offsets;
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        let second_is_nearer = distances[1].lt(distances[0]);
        // Shares of the larger distance: their powers stay within the numbers.
        let longest = distances[0].max(distances[1]);
        let scale = one / R::select(longest.le(zero), one, longest);
        let [d, e] = distances.map(|distance| distance * scale);
        let weights = match self {
            Self::Sum => (one, one),
            Self::SumOfUnits => (e, d),
            Self::Weighted => (e * e, d * d),
            Self::WeightedUnits => (e * e * e, d * d * d),
            Self::Nearest => {
                (R::select(second_is_nearer, zero, one), R::select(second_is_nearer, one, zero))
            }
        };
        let x = first.0.mul_add(weights.0, second.0 * weights.1);
        let y = first.1.mul_add(weights.0, second.1 * weights.1);
        let null = x.abs().max(y.abs()).le(zero);
        (R::select(null, first.0, x), R::select(null, first.1, y))
    }
}

/// Where a game begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoPursuersStart {
    /// The pursuers' first poses.
    pub pursuers: [Pose; 2],
    /// The evader's first pose.
    pub evader: Pose,
}

impl TwoPursuersStart {
    /// The pursuers at these positions, the evader in the origin, all looking along the x axis
    /// (section 8.4.1).
    pub fn pursuers_at(positions: [(f64, f64); 2]) -> Self {
        let pursuers = positions.map(|(x, y)| Pose { x, y, heading: 0.0 });
        Self { pursuers, evader: Pose { x: 0.0, y: 0.0, heading: 0.0 } }
    }

    /// The same start, if all its numbers are finite and the headings within 2³⁰ rad, where their
    /// sines are exact. Robots may begin at the same place; then the capture is at time 0.
    pub fn checked(self) -> Result<Self> {
        let [first, second] = self.pursuers;
        let robots =
            [("first pursuer", first), ("second pursuer", second), ("evader", self.evader)];
        check_poses(&robots)?;
        Ok(self)
    }
}

impl TwoPursuers {
    /// A game with a capture radius ℓ > 0 (m) and a time step T > 0 (s), in which pursuers follow
    /// the line of sight and the evader's flight is weighted.
    pub fn new(
        pursuers: [Vehicle; 2],
        evader: Vehicle,
        capture_radius: f64,
        time_step: f64,
    ) -> Result<Self> {
        check::positive("capture radius", capture_radius)?;
        check::positive("time step", time_step)?;
        for (who, robot) in ["first", "second"].into_iter().zip(&pursuers) {
            let what = format!("sum of the speeds of the {who} pursuer and the evader");
            check::positive(&what, robot.speed() + evader.speed())?;
        }
        let (capture, aim, flight) = (Capture::Sampled, Aim::LineOfSight, Flight::Weighted);
        Ok(Self { pursuers, evader, capture_radius, time_step, capture, aim, flight })
    }

    /// The game of section 8.4.1: V_p = 0.5, V_e = 0.3 m/s, L = 0.2 m, |u_p| ≤ 0.5,
    /// |u_e| ≤ 0.8 rad, ℓ = 0.1 m, T = 0.1 s.
    pub fn thesis() -> Result<Self> {
        let pursuer = Vehicle::new(0.5, 0.2, 0.5)?;
        Self::new([pursuer; 2], Vehicle::new(0.3, 0.2, 0.8)?, 0.1, 0.1)
    }

    /// The same game with another test of capture; [`new`](Self::new) gives the sampled one.
    pub fn with_capture(self, capture: Capture) -> Self {
        Self { capture, ..self }
    }

    /// The same game with pursuers that aim otherwise.
    pub fn with_aim(self, aim: Aim) -> Self {
        Self { aim, ..self }
    }

    /// The same game with an evader that flees otherwise.
    pub fn with_flight(self, flight: Flight) -> Self {
        Self { flight, ..self }
    }

    /// The pursuers.
    pub fn pursuers(&self) -> &[Vehicle; 2] {
        &self.pursuers
    }

    /// The evader.
    pub fn evader(&self) -> &Vehicle {
        &self.evader
    }

    /// The pursuers, then the evader.
    pub fn robots(&self) -> [&Vehicle; 3] {
        [&self.pursuers[0], &self.pursuers[1], &self.evader]
    }

    /// ℓ (m).
    pub fn capture_radius(&self) -> f64 {
        self.capture_radius
    }

    /// T (s).
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// How captures are tested.
    pub fn capture(&self) -> Capture {
        self.capture
    }

    /// Where the pursuers steer to.
    pub fn aim(&self) -> Aim {
        self.aim
    }

    /// Where the evader wants to go.
    pub fn flight(&self) -> Flight {
        self.flight
    }

    /// How the robots move.
    #[inline(always)]
    pub(crate) fn motions(&self) -> [Motion; 3] {
        self.robots().map(|robot| robot.motion(self.time_step))
    }

    /// For each pursuer the distance (m) that decides on capture at a sample, when the evader was
    /// at the offsets `before` at the last sample.
    #[inline(always)]
    pub fn nearness<R: Real>(&self, before: &[(R, R); 2], view: &View<R>) -> [R; 2] {
        match self.capture {
            Capture::Sampled => view.distances,
            Capture::Swept => [0, 1].map(|i| nearest_approach(before[i], view.offsets[i])),
        }
    }

    /// The vector from pursuer `i` to where it steers to; `ahead` is the direction in which it
    /// expects the evader to drive on, a unit vector.
    ///
    /// Equal to (8.19–8.23): the time t of capture solves |P_iE + V_e·t·h| = V_p·t, a quadratic
    /// that stays regular where the sine rule is 0/0. An evader that is as fast as the pursuer need
    /// not be caught at all; such a pursuer follows the line of sight.
    #[inline(always)]
    fn target<R: Real>(&self, i: usize, offset: (R, R), distance: R, ahead: (R, R)) -> (R, R) {
        let (pursuer, evader) = (self.pursuers[i].speed(), self.evader.speed());
        if evader >= pursuer {
            return offset;
        }
        let faster = R::splat(pursuer * pursuer - evader * evader);
        // The speed at which the evader drives away along the line of sight, times the distance.
        let away = offset.0.mul_add(ahead.0, offset.1 * ahead.1) * R::splat(evader);
        let square = distance * distance;
        let root = away.mul_add(away, faster * square).sqrt();
        // The two forms of a root of a quadratic: of each, the one that adds what it has.
        let time =
            R::select(away.lt(R::splat(0.0)), square / (root - away), (away + root) / faster);
        let way = time * R::splat(evader);
        (ahead.0.mul_add(way, offset.0), ahead.1.mul_add(way, offset.1))
    }
}

/// What can be seen in a game, or in eight: where the robots are and where they want to go.
#[derive(Debug, Clone, Copy)]
pub struct View<R = f64> {
    /// P_iE, the evader's position as seen from each pursuer's (m).
    pub offsets: [(R, R); 2],
    /// D_i, the distance of each pursuer from the evader (m) (8.15).
    pub distances: [R; 2],
    /// δ of the pursuers and of the evader (rad) (8.7 or 8.24, 8.12).
    pub angles: [R; 3],
}

impl<R: Real> View<R> {
    /// The distance of the nearer pursuer (m).
    #[inline(always)]
    pub fn nearest(&self) -> R {
        self.distances[1].min(self.distances[0])
    }
}

/// A game, or eight, at one time step.
#[derive(Debug, Clone, Copy)]
pub struct State<R> {
    /// The poses of the pursuers and of the evader.
    pub robots: [Pose<R>; 3],
    last_angles: [R; 3],
}

impl State<f64> {
    /// The state at the start, where all rates are 0.
    pub fn new(start: &TwoPursuersStart, game: &TwoPursuers) -> Self {
        let robots = [start.pursuers[0], start.pursuers[1], start.evader];
        let first = Self { robots, last_angles: [0.0; 3] };
        Self { last_angles: first.view(game).angles, ..first }
    }
}

impl<R: Real> State<R> {
    /// The same state in every lane.
    pub fn splat(state: &State<f64>) -> Self {
        Self { robots: state.robots.map(Pose::splat), last_angles: state.last_angles.map(R::splat) }
    }

    /// Replaces one lane.
    pub fn set_lane(&mut self, lane: usize, state: &State<f64>) {
        for (robot, &pose) in self.robots.iter_mut().zip(&state.robots) {
            robot.set_lane(lane, pose);
        }
        for (angle, &value) in self.last_angles.iter_mut().zip(&state.last_angles) {
            angle.set_lane(lane, value);
        }
    }

    /// What can be seen now.
    #[inline(always)]
    pub fn view(&self, game: &TwoPursuers) -> View<R> {
        let [first, second, evader] = &self.robots;
        let offsets = [first, second].map(|p| (evader.x - p.x, evader.y - p.y));
        let distances = offsets.map(|(dx, dy)| dx.mul_add(dx, dy * dy).sqrt());
        let flight = game.flight.direction(offsets, distances);
        let direction = atan2(flight.1, flight.0);
        let targets = match game.aim {
            Aim::LineOfSight => offsets,
            Aim::Intercept | Aim::InterceptFlight => {
                let of_the_heading = game.aim == Aim::Intercept;
                let (sine, cosine) =
                    sin_cos(if of_the_heading { evader.heading } else { direction });
                [0, 1].map(|i| game.target(i, offsets[i], distances[i], (cosine, sine)))
            }
        };
        let [to_first, to_second] = targets.map(|(dx, dy)| atan2(dy, dx));
        let angles = [
            wrap_angle(to_first - first.heading),
            wrap_angle(to_second - second.heading),
            wrap_angle(direction - evader.heading),
        ];
        View { offsets, distances, angles }
    }

    /// What the pursuers and the evader perceive of this view. The evader's distance and heading
    /// difference are those to the nearer pursuer.
    #[inline(always)]
    pub fn observations(&self, view: &View<R>, game: &TwoPursuers) -> [Observation<R>; 3] {
        let [first, second, evader] = &self.robots;
        let [d, e] = view.distances;
        let nearer = R::select(e.lt(d), second.heading, first.heading);
        let others = [
            (d, evader.heading - first.heading),
            (e, evader.heading - second.heading),
            (view.nearest(), nearer - evader.heading),
        ];
        [0, 1, 2].map(|robot| Observation {
            angle: view.angles[robot],
            rate: rate(view.angles[robot], self.last_angles[robot], game.time_step),
            distance: others[robot].0,
            heading_difference: others[robot].1,
        })
    }

    /// The next state, when this view was seen and the robots steer so, within their limits.
    #[inline(always)]
    pub(crate) fn moved(&self, view: &View<R>, steering: [R; 3], motions: &[Motion<R>; 3]) -> Self {
        let robots =
            [0, 1, 2].map(|robot| motions[robot].advance(self.robots[robot], steering[robot]));
        Self { robots, last_angles: view.angles }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::*;

    fn at(x: f64, y: f64, heading: f64) -> Pose {
        Pose { x, y, heading }
    }

    fn view(game: &TwoPursuers, pursuers: [(f64, f64); 2]) -> View {
        State::new(&TwoPursuersStart::pursuers_at(pursuers), game).view(game)
    }

    #[test]
    fn the_nearer_pursuer_counts_the_more_the_higher_the_power() {
        // Pursuers below and to the left: the evader flees up and to the right.
        let game = TwoPursuers::thesis().unwrap();
        let flight = |flight| view(&game.with_flight(flight), [(0.0, -1.0), (-2.0, 0.0)]).angles[2];
        // tan of each: rise D₂ᵏ·1 over run D₁ᵏ·2 with D₁ = 1, D₂ = 2.
        let expected = [
            (Flight::Sum, 0.5_f64.atan()),
            (Flight::SumOfUnits, 1.0_f64.atan()),
            (Flight::Weighted, 2.0_f64.atan()),
            (Flight::WeightedUnits, 4.0_f64.atan()),
            (Flight::Nearest, FRAC_PI_2),
        ];
        for (direction, angle) in expected {
            assert!((flight(direction) - angle).abs() < 1e-15, "{}", direction.name());
        }
    }

    #[test]
    fn between_equally_distant_pursuers_the_evader_flees_from_the_first() {
        let game = TwoPursuers::thesis().unwrap();
        for direction in [Flight::Weighted, Flight::Sum, Flight::SumOfUnits, Flight::Nearest] {
            let game = game.with_flight(direction);
            assert_eq!(view(&game, [(2.0, 0.0), (-2.0, 0.0)]).angles[2], PI);
            assert_eq!(view(&game, [(-2.0, 0.0), (2.0, 0.0)]).angles[2], 0.0);
        }
        // All three in one place: numbers, and a capture at once.
        let together = view(&game, [(0.0, 0.0); 2]);
        assert_eq!((together.angles, together.nearest()), ([0.0; 3], 0.0));
    }

    /// The sine rule of (8.20, 8.21), which is 0/0 on the line of sight.
    fn by_sines(pursuer: f64, evader: f64, offset: (f64, f64), heading: f64) -> (f64, f64) {
        let distance = offset.0.hypot(offset.1);
        let along = -(offset.0 * heading.cos() + offset.1 * heading.sin());
        let beta = (along / distance).acos();
        let alpha = (evader / pursuer * beta.sin()).asin();
        let way = distance * alpha.sin() / (alpha + beta).sin();
        (offset.0 + way * heading.cos(), offset.1 + way * heading.sin())
    }

    #[test]
    fn the_predicted_capture_agrees_with_the_sine_rule_and_is_regular_on_the_line_of_sight() {
        let game = TwoPursuers::thesis().unwrap();
        for i in 0..400 {
            let (angle, heading) = (0.1 + 0.37 * f64::from(i), 0.61 * f64::from(i));
            let (offset, ahead) =
                ((3.0 * angle.cos(), 3.0 * angle.sin()), (heading.cos(), heading.sin()));
            let ours = game.target(0, offset, 3.0, ahead);
            let theirs = by_sines(0.5, 0.3, offset, heading);
            let off = (ours.0 - theirs.0).hypot(ours.1 - theirs.1);
            assert!(off < 1e-9 * ours.0.hypot(ours.1), "{i}: {ours:?} {theirs:?}");
        }
        // Towards the pursuer they meet after d/(V_p + V_e), away from it after d/(V_p − V_e).
        assert!((game.target(0, (2.0, 0.0), 2.0, (-1.0, 0.0)).0 - 1.25).abs() < 1e-15);
        assert!((game.target(0, (2.0, 0.0), 2.0, (1.0, 0.0)).0 - 5.0).abs() < 1e-14);
        assert_eq!(game.target(0, (0.0, 0.0), 0.0, (1.0, 0.0)), (0.0, 0.0));
    }

    #[test]
    fn a_pursuer_that_is_not_faster_follows_the_line_of_sight() {
        let robot = |speed| Vehicle::new(speed, 0.2, 0.5).unwrap();
        let game = TwoPursuers::new([robot(0.5), robot(0.3)], robot(0.3), 0.1, 0.1).unwrap();
        let start = TwoPursuersStart {
            pursuers: [at(0.0, 0.0, 0.0), at(0.0, 0.0, 0.0)],
            evader: at(0.0, 2.0, 0.3),
        };
        let [first, second, _] = State::new(&start, &game.with_aim(Aim::Intercept))
            .view(&game.with_aim(Aim::Intercept))
            .angles;
        assert!(first < FRAC_PI_2 - 0.1, "it cuts the corner");
        assert_eq!(second, FRAC_PI_2);
    }

    #[test]
    fn impossible_games_and_starts_are_refused_in_words() {
        let robot = |speed| Vehicle::new(speed, 0.3, 0.5).unwrap();
        let parked = TwoPursuers::new([robot(1.0), robot(0.0)], robot(0.0), 0.1, 0.1).unwrap_err();
        assert_eq!(
            parked.to_string(),
            "sum of the speeds of the second pursuer and the evader must be positive, got 0"
        );
        assert!(TwoPursuers::new([robot(1.0); 2], robot(1.0), 0.0, 0.1).is_err());
        assert!(TwoPursuers::new([robot(1.0); 2], robot(1.0), 0.1, f64::NAN).is_err());
        let lost = TwoPursuersStart::pursuers_at([(0.0, 1.0), (f64::NAN, 1.0)]);
        assert_eq!(
            lost.checked().unwrap_err().to_string(),
            "starting x of the second pursuer must be finite, got NaN"
        );
        let unknown = Flight::from_name("nearst").unwrap_err().to_string();
        assert!(unknown.contains("nearest"), "{unknown}");
        assert!(Aim::from_name("evader").is_err());
    }
}
