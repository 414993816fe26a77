//! Whether a pursuer can be sure of catching an evader.

use fuzzy_core::math::sin_cos;

use crate::vehicle::{SpeedLaw, Vehicle};

/// What can be said about a pair of robots before they play, whatever they start from and however
/// they steer.
///
/// A robot at a constant speed V whose tightest circle has the radius R can be pushed sideways by
/// V²/R = V² tan(u_max)/L at most. Cockayne (1967) proved of two such robots in continuous time and
/// in the open plane: a pursuer can force the capture of the *point* that the evader is, from every
/// start and against every evasion, if and only if it is faster, V_p > V_e, and can be pushed at
/// least as hard, V_p²/R_p ≥ V_e²/R_e.
///
/// Capture within a radius ℓ > 0 is easier. So the condition is sufficient for it, up to what the
/// sampling of time adds, and not necessary: [`NotGuaranteed`](Self::NotGuaranteed) does not mean
/// that the evader gets away. Nor does [`Certain`](Self::Certain) mean that every strategy catches:
/// it says that some strategy does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Prospect {
    /// Cockayne's conditions hold: some strategy of the pursuer catches every evader.
    Certain,
    /// The pursuer is faster, but the evader turns too tightly for the capture of a point; or a
    /// robot slows down in turns, of which the theorem says nothing.
    NotGuaranteed,
    /// The pursuer is not faster: an evader that looks away and is farther than ℓ gets no nearer.
    /// Only one that comes towards the pursuer first, or that errs, is caught.
    Hopeless,
}

impl Prospect {
    /// That of a pursuer after an evader.
    ///
    /// ```
    /// use pursuit_sim::{Prospect, Vehicle};
    ///
    /// // Pursuer 3 of Table 8.10 after the three evaders.
    /// let pursuer = Vehicle::new(1.2, 0.3, 0.6)?;
    /// let evaders = [(0.6, 1.0), (1.4, 0.6), (1.0, 0.8)];
    /// let prospects = evaders.map(|(speed, most)| {
    ///     Ok::<_, pursuit_sim::Error>(Prospect::of(&pursuer, &Vehicle::new(speed, 0.3, most)?))
    /// });
    /// assert_eq!(prospects[0], Ok(Prospect::Certain));
    /// assert_eq!(prospects[1], Ok(Prospect::Hopeless));
    /// assert_eq!(prospects[2], Ok(Prospect::NotGuaranteed));
    /// # Ok::<(), pursuit_sim::Error>(())
    /// ```
    pub fn of(pursuer: &Vehicle, evader: &Vehicle) -> Self {
        let constant = |robot: &Vehicle| robot.speed_law() == SpeedLaw::Constant;
        if pursuer.speed() <= evader.speed() {
            Self::Hopeless
        } else if constant(pursuer)
            && constant(evader)
            && sideways(pursuer, evader) >= sideways(evader, pursuer)
        {
            Self::Certain
        } else {
            Self::NotGuaranteed
        }
    }

    /// The name that programs use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Certain => "certain",
            Self::NotGuaranteed => "not guaranteed",
            Self::Hopeless => "hopeless",
        }
    }
}

/// V² tan(u)/L of a robot times what both sides of the comparison have below the line, so that two
/// equal robots are exactly equal.
fn sideways(robot: &Vehicle, other: &Vehicle) -> f64 {
    let (sine, _) = sin_cos(robot.max_steering());
    let (_, cosine) = sin_cos(other.max_steering());
    robot.speed() * robot.speed() * sine * (cosine * other.wheelbase())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn prospect(pursuer: (f64, f64, f64), evader: (f64, f64, f64)) -> Prospect {
        let robot = |(speed, wheelbase, most)| Vehicle::new(speed, wheelbase, most).unwrap();
        Prospect::of(&robot(pursuer), &robot(evader))
    }

    #[test]
    fn the_conditions_are_those_of_cockayne() {
        assert_eq!(prospect((2.0, 0.3, 0.5), (1.0, 0.3, 1.0)), Prospect::Certain);
        assert_eq!(prospect((1.0, 0.3, 0.5), (1.0, 0.3, 0.1)), Prospect::Hopeless);
        assert_eq!(prospect((0.9, 0.3, 0.5), (1.0, 0.3, 0.1)), Prospect::Hopeless);
        // V²/L is what counts: 4/1 against 1/0.25, at the same steering, is the border.
        assert_eq!(prospect((2.0, 1.0, 0.5), (1.0, 0.25, 0.5)), Prospect::Certain);
        assert_eq!(prospect((2.0, 1.001, 0.5), (1.0, 0.25, 0.5)), Prospect::NotGuaranteed);
        let slows = Vehicle::new(2.0, 0.3, 0.5).unwrap().with_speed_law(SpeedLaw::Cosine);
        let evader = Vehicle::new(1.0, 0.3, 0.5).unwrap();
        assert_eq!(Prospect::of(&slows, &evader), Prospect::NotGuaranteed);
    }
}
