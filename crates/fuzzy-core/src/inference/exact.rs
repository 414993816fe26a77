//! The centroid of a Mamdani output without sampling.
//!
//! Between two neighbouring vertices of the output's terms every term is a line L, so the
//! aggregated set max T(w, L) with T = min or product is piecewise linear, and it can only bend
//! where two lines, or a line and a strength, meet. Between those meetings the integrals of A(y)
//! and y·A(y) are closed expressions.

use super::Answer;
use super::sampled::{Conclusion, answer, join};
use crate::math::{Numbers, Real, Scalar};
use crate::norm::TNorm;

mod parts;

/// A Mamdani output whose centroid is exact.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Exact {
    pub conclusions: Vec<Conclusion>,
    pub implication: TNorm,
    pub universe: (f64, f64),
}

/// A part of the universe without a vertex inside, and the lines of the conclusions there.
#[derive(Debug, Clone)]
struct Segment<N> {
    low: N,
    high: N,
    lines: Vec<Line<N>>,
}

/// A conclusion's term over a segment.
#[derive(Debug, Clone, Copy)]
struct Line<N> {
    conclusion: usize,
    at_low: N,
    at_high: N,
}

#[derive(Debug, Clone)]
pub(super) struct PreparedSegments<N>(Vec<Segment<N>>);

impl Exact {
    /// The numbers of working space that [`infer`](Self::infer) needs: strengths, then for one
    /// segment the lines' ends and the places where the set may bend.
    pub fn scratch_count(&self) -> usize {
        let lines = self.conclusions.len();
        lines + 2 * lines + most_bends(lines)
    }

    pub fn prepare<N: Scalar>(&self, parameters: &[N]) -> PreparedSegments<N> {
        let (low, high) = (N::splat(self.universe.0), N::splat(self.universe.1));
        let polygons: Vec<Vec<(N, N)>> = self
            .conclusions
            .iter()
            .map(|c| c.term.shape.vertices(c.term.own(parameters)).unwrap_or_default())
            .collect();
        let inside = |y: &N| y.value() > self.universe.0 && y.value() < self.universe.1;
        let mut ends: Vec<N> = polygons.iter().flatten().map(|&(y, _)| y).filter(inside).collect();
        ends.extend([low, high]);
        ends.sort_by(|a, b| a.value().total_cmp(&b.value()));
        ends.dedup_by(|a, b| a.value() == b.value());
        let segment = |pair: &[N]| Segment {
            low: pair[0],
            high: pair[1],
            lines: polygons
                .iter()
                .enumerate()
                .map(|(conclusion, polygon)| {
                    let (at_low, at_high) = line(polygon, pair[0], pair[1]);
                    Line { conclusion, at_low, at_high }
                })
                .filter(|line| line.at_low.value() != 0.0 || line.at_high.value() != 0.0)
                .collect(),
        };
        let segments = ends.windows(2).map(segment).filter(|segment| !segment.lines.is_empty());
        PreparedSegments(segments.collect())
    }

    /// The centroid for these firing strengths of the rules.
    #[inline(always)]
    pub fn infer<N: Scalar, R: Real>(
        &self,
        prepared: &PreparedSegments<N>,
        strengths: &[R],
        scratch: &mut [R],
        fallback: f64,
    ) -> Answer<R>
    where
        [N]: Numbers<R>,
    {
        let (joined, scratch) = scratch.split_at_mut(self.conclusions.len());
        let strengths = join(&self.conclusions, strengths, joined);
        let (low, high) = (R::splat(self.universe.0), R::splat(self.universe.1));
        let size = high - low;
        let (mut area, mut moment) = (R::splat(0.0), R::splat(0.0));
        for segment in &prepared.0 {
            let (own_area, own_moment) = match self.implication {
                TNorm::Product => scaled(segment, strengths, scratch),
                _ => clipped(segment, strengths, scratch),
            };
            // From the segment's own 0 to 1 to that of the universe, whatever its size is.
            let from_low = |y: N| (lift::<N, R>(y) - low) / size;
            let start = from_low(segment.low);
            let width = from_low(segment.high) - start;
            area = own_area.mul_add(width, area);
            moment = (width * own_moment + start * own_area).mul_add(width, moment);
        }
        answer((moment / area).mul_add(size, low), area, fallback)
    }
}

fn lift<N: Scalar, R: Real>(number: N) -> R
where
    [N]: Numbers<R>,
{
    std::slice::from_ref(&number).number(0)
}

/// The places where a set of so many lines may bend: own clip, meetings of two, and a line with
/// another's strength.
fn most_bends(lines: usize) -> usize {
    2 + lines + lines * lines.saturating_sub(1) / 2 * 3
}

/// The line of a polygon from `low` to `high`, between which it has no vertex: limits from inside.
fn line<N: Scalar>(polygon: &[(N, N)], low: N, high: N) -> (N, N) {
    let zero = N::splat(0.0);
    let before = polygon.iter().rposition(|(y, _)| y.value() <= low.value());
    let after = polygon.iter().position(|(y, _)| y.value() >= high.value());
    match (before, after) {
        (Some(before), Some(after)) => {
            let ((y0, d0), (y1, d1)) = (polygon[before], polygon[after]);
            let slope = (d1 - d0) / (y1 - y0);
            ((low - y0).mul_add(slope, d0), (high - y0).mul_add(slope, d0))
        }
        (Some(last), None) => (polygon[last].1, polygon[last].1),
        (None, Some(first)) => (polygon[first].1, polygon[first].1),
        (None, None) => (zero, zero),
    }
}

/// ∫A and ∫t·A over a segment, t from 0 to 1, where strengths clip the lines.
#[inline(always)]
fn clipped<N: Scalar, R: Real>(segment: &Segment<N>, strengths: &[R], scratch: &mut [R]) -> (R, R)
where
    [N]: Numbers<R>,
{
    clipped_bends(segment, strengths, scratch).integrate(|t| {
        segment.lines.iter().fold(R::splat(0.0), |most, line| {
            let (start, rise) = ends::<N, R>(line);
            most.max(t.mul_add(rise, start).min(strengths[line.conclusion]))
        })
    })
}

/// Where a set of clipped lines may bend.
#[inline(always)]
fn clipped_bends<'a, N: Scalar, R: Real>(
    segment: &Segment<N>,
    strengths: &[R],
    scratch: &'a mut [R],
) -> Bends<'a, R>
where
    [N]: Numbers<R>,
{
    let count = segment.lines.len();
    let mut bends = Bends::new(&mut scratch[2 * count..]);
    for (index, own) in segment.lines.iter().enumerate() {
        let (start, rise) = ends(own);
        let clip = strengths[own.conclusion];
        bends.add((clip - start) / rise);
        for other in &segment.lines[..index] {
            let (other_start, other_rise) = ends::<N, R>(other);
            let other_clip = strengths[other.conclusion];
            bends.add((other_start - start) / (rise - other_rise));
            bends.add((other_clip - start) / rise);
            bends.add((clip - other_start) / other_rise);
        }
    }
    bends
}

/// The same where strengths scale the lines.
#[inline(always)]
fn scaled<N: Scalar, R: Real>(segment: &Segment<N>, strengths: &[R], scratch: &mut [R]) -> (R, R)
where
    [N]: Numbers<R>,
{
    let (lines, bends) = scaled_lines(segment, strengths, scratch);
    meetings(lines, bends).integrate(|t| {
        let heights = lines.chunks_exact(2).map(|line| t.mul_add(line[1], line[0]));
        heights.fold(R::splat(0.0), R::max)
    })
}

/// The start and the rise of each line times its strength, and the rest of the working space.
#[inline(always)]
fn scaled_lines<'a, N: Scalar, R: Real>(
    segment: &Segment<N>,
    strengths: &[R],
    scratch: &'a mut [R],
) -> (&'a [R], &'a mut [R])
where
    [N]: Numbers<R>,
{
    let (lines, rest) = scratch.split_at_mut(2 * segment.lines.len());
    for (line, scaled) in segment.lines.iter().zip(lines.chunks_exact_mut(2)) {
        let (start, rise) = ends::<N, R>(line);
        let strength = strengths[line.conclusion];
        scaled[0] = strength * start;
        scaled[1] = strength * rise;
    }
    (lines, rest)
}

/// Where a set of scaled lines, each a start and a rise, may bend.
#[inline(always)]
fn meetings<'a, R: Real>(lines: &[R], scratch: &'a mut [R]) -> Bends<'a, R> {
    let mut bends = Bends::new(scratch);
    for (index, own) in lines.chunks_exact(2).enumerate() {
        for other in lines.chunks_exact(2).take(index) {
            bends.add((other[0] - own[0]) / (own[1] - other[1]));
        }
    }
    bends
}

/// Where a line begins and how far it rises over its segment.
#[inline(always)]
fn ends<N: Scalar, R: Real>(line: &Line<N>) -> (R, R)
where
    [N]: Numbers<R>,
{
    let start: R = lift(line.at_low);
    (start, lift::<N, R>(line.at_high) - start)
}

/// The places from 0 to 1 where a piecewise-linear function may bend, in order.
struct Bends<'a, R> {
    places: &'a mut [R],
    count: usize,
}

impl<'a, R: Real> Bends<'a, R> {
    #[inline(always)]
    fn new(places: &'a mut [R]) -> Self {
        Self { places, count: 0 }
    }

    /// Adds a place, by insertion so that lanes need no decision. Lines that never meet give
    /// NaN or infinity, which end up at an end of the interval, where they do no harm.
    #[inline(always)]
    fn add(&mut self, place: R) {
        let mut place = place.max(R::splat(0.0)).min(R::splat(1.0));
        for earlier in &mut self.places[..self.count] {
            let (smaller, larger) = (earlier.min(place), earlier.max(place));
            *earlier = smaller;
            place = larger;
        }
        self.places[self.count] = place;
        self.count += 1;
    }

    /// ∫f and ∫t·f from 0 to 1 of a function that is linear between the places.
    #[inline(always)]
    fn integrate(self, function: impl Fn(R) -> R) -> (R, R) {
        let (two, sixth) = (R::splat(2.0), R::splat(1.0 / 6.0));
        let (mut area, mut moment) = (R::splat(0.0), R::splat(0.0));
        let (mut from, mut at_from) = (R::splat(0.0), function(R::splat(0.0)));
        for index in 0..=self.count {
            let to = if index < self.count { self.places[index] } else { R::splat(1.0) };
            let (at_to, size) = (function(to), to - from);
            area = ((at_from + at_to) * R::splat(0.5)).mul_add(size, area);
            let weighted = from * two.mul_add(at_from, at_to) + to * two.mul_add(at_to, at_from);
            moment = (weighted * sixth).mul_add(size, moment);
            (from, at_from) = (to, at_to);
        }
        (area, moment)
    }
}
