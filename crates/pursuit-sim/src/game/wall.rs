//! Walls, and how far a robot is from them.

use fuzzy_core::check;
use fuzzy_core::math::sin_cos;

use crate::error::Result;

/// How a robot measures its distance to a wall.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sensing {
    /// The distance to the nearest point of the wall, on whichever side of it.
    Nearest,
    /// y − w(x), where the wall is y = w(x): a sensor that looks along the y axis. Negative
    /// behind the wall.
    Vertical,
}

impl Sensing {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Nearest, Self::Vertical];

    /// The name that files and messages use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Nearest => "nearest",
            Self::Vertical => "vertical",
        }
    }

    /// The sensing with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        let known = Self::ALL.map(Self::name);
        let found = Self::ALL.into_iter().find(|sensing| sensing.name() == name);
        Ok(found.ok_or_else(|| fuzzy_core::Error::unknown_name("sensing", name, known))?)
    }
}

/// The farthest point of a wall (m); squares of such numbers keep their digits.
const FARTHEST: f64 = 1e9;

/// A wall: straight pieces from point to point.
///
/// ```
/// use pursuit_sim::game::wall::{Sensing, Wall};
///
/// let corner = Wall::new(vec![(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)], Sensing::Nearest)?;
/// assert_eq!(corner.distance(9.0, 3.0), Some(1.0));
/// # Ok::<(), pursuit_sim::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Wall {
    points: Vec<(f64, f64)>,
    sensing: Sensing,
    tree: Tree,
}

impl Wall {
    /// The wall through these points (m), at least two, each different from the one before. For
    /// [`Sensing::Vertical`] their x must rise.
    pub fn new(points: Vec<(f64, f64)>, sensing: Sensing) -> Result<Self> {
        check::at_least("points of a wall", points.len(), 2)?;
        for (index, &(x, y)) in points.iter().enumerate() {
            for (axis, value) in [("x", x), ("y", y)] {
                let what = format!("{axis} of point {index} of the wall");
                check::within(&what, value, "within ±1e9 m", |value| value.abs() <= FARTHEST)?;
            }
        }
        for (index, pair) in points.windows(2).enumerate() {
            let what = format!("point {} of the wall", index + 1);
            if pair[0] == pair[1] {
                let reason = "it equals the point before; leave one of them out".to_owned();
                return Err(fuzzy_core::Error::Unsuitable { what, reason }.into());
            }
            if sensing == Sensing::Vertical && pair[1].0 <= pair[0].0 {
                let above = format!("above {} (vertical sensing needs rising x)", pair[0].0);
                check::within(&format!("x of {what}"), pair[1].0, &above, |_| false)?;
            }
        }
        let tree = Tree::new(&points);
        Ok(Self { points, sensing, tree })
    }

    /// y = 0 from x = −5 to 1000 m.
    pub fn straight() -> Result<Self> {
        Self::new(vec![(-5.0, 0.0), (1000.0, 0.0)], Sensing::Nearest)
    }

    /// Every 20 m the wall moves by between −0.5 and 0.3 m, over 0.3 m; looked at vertically. Its
    /// end is at x = 400 m.
    ///
    /// The thesis doesn't say what its wall was. This one gives errors within the axes of its
    /// Figures 3.8–3.13, −0.5 to 0.3 m.
    pub fn jog() -> Result<Self> {
        Self::of_jogs(0.3)
    }

    /// [`jog`](Self::jog) with ramps of 0.02 m: true jumps of what the robot measures.
    pub fn step() -> Result<Self> {
        Self::of_jogs(0.02)
    }

    fn of_jogs(ramp: f64) -> Result<Self> {
        const JOGS: [f64; 14] =
            [0.3, -0.3, -0.5, 0.3, 0.2, -0.3, 0.3, -0.5, 0.3, 0.3, -0.3, 0.2, -0.5, 0.3];
        let mut points = vec![(-5.0, 0.0)];
        let mut y = 0.0;
        for (index, jog) in JOGS.into_iter().enumerate() {
            let x = 20.0 * (index + 1) as f64;
            points.push((x, y));
            y += jog;
            points.push((x + ramp, y));
        }
        points.push((400.0, y));
        Self::new(points, Sensing::Vertical)
    }

    /// From (−5, 0) pieces of 25 m with corners of 30° to 90° between them; the nearest point
    /// counts.
    pub fn poly() -> Result<Self> {
        const LENGTH: f64 = 25.0;
        const DIRECTIONS: [f64; 15] =
            [0.0, 30.0, -30.0, 45.0, 0.0, 90.0, 45.0, 90.0, 0.0, -45.0, 0.0, 60.0, 0.0, -90.0, 0.0];
        let mut points = vec![(-5.0, 0.0)];
        let (mut x, mut y) = (-5.0, 0.0);
        for direction in DIRECTIONS {
            let (sine, cosine) = sin_cos(f64::to_radians(direction));
            (x, y) = (x + LENGTH * cosine, y + LENGTH * sine);
            points.push((x, y));
        }
        Self::new(points, Sensing::Nearest)
    }

    /// y = 2 sin(2πx/25) in pieces of 1 m along x, from −5 to 400 m; the nearest point counts. A
    /// wall that changes all the time.
    pub fn sine() -> Result<Self> {
        const AMPLITUDE: f64 = 2.0;
        const WAVELENGTH: f64 = 25.0;
        let point = |x: i32| {
            let (sine, _) = sin_cos(std::f64::consts::TAU * f64::from(x) / WAVELENGTH);
            (f64::from(x), AMPLITUDE * sine)
        };
        Self::new((-5..=400).map(point).collect(), Sensing::Nearest)
    }

    /// The points (m).
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// How its distance is measured.
    pub fn sensing(&self) -> Sensing {
        self.sensing
    }

    /// D, the distance from a place to the wall (m); none where a vertical sensor is beyond the
    /// wall's ends.
    #[inline]
    pub fn distance(&self, x: f64, y: f64) -> Option<f64> {
        match self.sensing {
            Sensing::Nearest => Some(self.tree.distance(x, y)),
            Sensing::Vertical => {
                let next = self.points.partition_point(|point| point.0 <= x);
                let ((x0, y0), (x1, y1)) = match next {
                    // The last point still is a part of the wall.
                    n if n == self.points.len() && x == self.points[n - 1].0 => {
                        (self.points[n - 2], self.points[n - 1])
                    }
                    n if n == 0 || n == self.points.len() => return None,
                    n => (self.points[n - 1], self.points[n]),
                };
                Some(y - ((x - x0) / (x1 - x0)).mul_add(y1 - y0, y0))
            }
        }
    }
}

/// A straight piece of a wall.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Segment {
    start: (f64, f64),
    way: (f64, f64),
    /// 1/length² (1/m²).
    per_square: f64,
}

impl Segment {
    fn between(start: (f64, f64), end: (f64, f64)) -> Self {
        let way = (end.0 - start.0, end.1 - start.1);
        Self { start, way, per_square: 1.0 / way.0.mul_add(way.0, way.1 * way.1) }
    }

    #[inline(always)]
    fn square_distance(&self, x: f64, y: f64) -> f64 {
        let (dx, dy) = (x - self.start.0, y - self.start.1);
        let along = dx.mul_add(self.way.0, dy * self.way.1) * self.per_square;
        // Comparisons this way round also take a piece so short that its square is zero.
        let share = if along > 0.0 { along.min(1.0) } else { 0.0 };
        let (dx, dy) = (share.mul_add(-self.way.0, dx), share.mul_add(-self.way.1, dy));
        dx.mul_add(dx, dy * dy)
    }
}

/// The box around some pieces.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Bounds {
    low: (f64, f64),
    high: (f64, f64),
}

impl Bounds {
    const EMPTY: Self =
        Self { low: (f64::INFINITY, f64::INFINITY), high: (-f64::INFINITY, -f64::INFINITY) };

    fn around(a: Self, b: Self) -> Self {
        Self {
            low: (a.low.0.min(b.low.0), a.low.1.min(b.low.1)),
            high: (a.high.0.max(b.high.0), a.high.1.max(b.high.1)),
        }
    }

    #[inline(always)]
    fn square_distance(&self, x: f64, y: f64) -> f64 {
        let dx = (self.low.0 - x).max(x - self.high.0).max(0.0);
        let dy = (self.low.1 - y).max(y - self.high.1).max(0.0);
        dx.mul_add(dx, dy * dy)
    }
}

/// The pieces of a wall under boxes around 2, 4, 8 … neighbours, so that the nearest is found
/// without looking at all of them. Box 1 is around everything, the halves of box i are 2i and
/// 2i + 1, the last boxes have one piece each.
#[derive(Debug, Clone, PartialEq)]
struct Tree {
    boxes: Vec<Bounds>,
    segments: Vec<Segment>,
}

impl Tree {
    fn new(points: &[(f64, f64)]) -> Self {
        let segments: Vec<Segment> =
            points.windows(2).map(|pair| Segment::between(pair[0], pair[1])).collect();
        let leaves = segments.len().next_power_of_two();
        let mut boxes = vec![Bounds::EMPTY; 2 * leaves];
        for (leaf, pair) in boxes[leaves..].iter_mut().zip(points.windows(2)) {
            let point = |(x, y)| Bounds { low: (x, y), high: (x, y) };
            *leaf = Bounds::around(point(pair[0]), point(pair[1]));
        }
        for parent in (1..leaves).rev() {
            boxes[parent] = Bounds::around(boxes[2 * parent], boxes[2 * parent + 1]);
        }
        Self { boxes, segments }
    }

    fn distance(&self, x: f64, y: f64) -> f64 {
        self.search(1, x, y, f64::INFINITY).sqrt()
    }

    /// The smaller of `best` and the square of the distance to the pieces in a box.
    fn search(&self, node: usize, x: f64, y: f64, best: f64) -> f64 {
        if let Some(piece) = node.checked_sub(self.boxes.len() / 2) {
            // Boxes that fill the last row up have no piece.
            return self.segments.get(piece).map_or(best, |s| s.square_distance(x, y).min(best));
        }
        let halves = [2 * node, 2 * node + 1].map(|half| (half, self.boxes[half]));
        let [mut near, mut far] = halves.map(|(half, b)| (b.square_distance(x, y), half));
        if far.0 < near.0 {
            (near, far) = (far, near);
        }
        let best = if near.0 < best { self.search(near.1, x, y, best) } else { best };
        if far.0 < best { self.search(far.1, x, y, best) } else { best }
    }
}

#[cfg(test)]
mod tests {
    use fuzzy_core::Rng;

    use super::*;

    #[test]
    fn the_nearest_piece_is_found_among_all() {
        let mut rng = Rng::new(3, 0);
        for count in [2, 3, 5, 64, 65, 300] {
            let points: Vec<(f64, f64)> = (0..count)
                .map(|_| (rng.uniform_in(-9.0, 9.0), rng.uniform_in(-9.0, 9.0)))
                .collect();
            let wall = Wall::new(points.clone(), Sensing::Nearest).unwrap();
            for _ in 0..200 {
                let (x, y) = (rng.uniform_in(-15.0, 15.0), rng.uniform_in(-15.0, 15.0));
                let each = points.windows(2).map(|p| Segment::between(p[0], p[1]));
                let all = each.map(|s| s.square_distance(x, y)).fold(f64::INFINITY, f64::min);
                // Two pieces that meet may give their corner's distance with different last bits.
                assert!((wall.distance(x, y).unwrap() - all.sqrt()).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn distances_are_those_of_geometry() {
        let corner = vec![(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)];
        let wall = Wall::new(corner, Sensing::Nearest).unwrap();
        for ((x, y), expected) in
            [((5.0, 2.0), 2.0), ((5.0, -2.0), 2.0), ((-3.0, 4.0), 5.0), ((13.0, -4.0), 5.0)]
        {
            assert!((wall.distance(x, y).unwrap() - expected).abs() < 1e-15);
        }
        let slope = Wall::new(vec![(0.0, 0.0), (4.0, 2.0), (6.0, 2.0)], Sensing::Vertical).unwrap();
        assert_eq!(slope.distance(1.0, 2.0), Some(1.5));
        assert_eq!(slope.distance(4.0, 1.0), Some(-1.0));
        assert_eq!(slope.distance(6.0, 3.0), Some(1.0));
        assert_eq!((slope.distance(-0.1, 0.0), slope.distance(6.1, 0.0)), (None, None));
        assert_eq!(slope.distance(f64::NAN, 0.0), None);
    }

    #[test]
    fn the_walls_of_the_chapter_are_where_they_should_be() {
        let jog = Wall::jog().unwrap();
        assert_eq!(jog.distance(19.0, 1.0), Some(1.0));
        assert!((jog.distance(30.0, 1.0).unwrap() - 0.7).abs() < 1e-15);
        assert!((jog.distance(70.0, 1.0).unwrap() - 1.5).abs() < 1e-15);
        let sine = Wall::sine().unwrap();
        assert_eq!(sine.points().len(), 406);
        let poly = Wall::poly().unwrap();
        assert_eq!(poly.points().len(), 16);
        assert!((poly.points()[2].1 - 12.5).abs() < 1e-14);
    }

    #[test]
    fn impossible_walls_are_refused_in_words() {
        let message = |points: &[(f64, f64)], sensing| {
            Wall::new(points.to_vec(), sensing).unwrap_err().to_string()
        };
        let nearest = Sensing::Nearest;
        assert!(message(&[(0.0, 0.0)], nearest).contains("at least 2"));
        assert!(message(&[(0.0, 0.0), (0.0, 0.0)], nearest).contains("equals the point before"));
        assert!(message(&[(0.0, 0.0), (f64::NAN, 0.0)], nearest).contains("must be finite"));
        assert!(message(&[(0.0, 0.0), (0.0, 1e10)], nearest).contains("y of point 1"));
        let back = message(&[(0.0, 0.0), (0.0, 1.0)], Sensing::Vertical);
        assert!(back.contains("x of point 1 of the wall must be above 0"), "{back}");
        assert!(Sensing::from_name("vertica").unwrap_err().to_string().contains("vertical"));
        // So short that the square of its length is zero.
        let short = Wall::new(vec![(0.0, 0.0), (0.0, 1e-300)], nearest).unwrap();
        assert_eq!(short.distance(3.0, 4.0), Some(5.0));
    }
}
