//! What each rule has in an aggregated set without samples.
//!
//! Between two bends the set is a line that belongs to the same rules everywhere, so its area
//! and its moment are divided piece by piece without an error.

use super::super::parts::{Collected, Parts, Whole, divide};
use super::{Exact, Line, PreparedSegments, Segment, clipped_bends, ends, join};
use super::{meetings, scaled_lines};
use crate::norm::{Aggregation, SNorm, TNorm};

/// What joins the sets: exact sampling knows no other.
const MAX: Aggregation = Aggregation::Norm(SNorm::Max);

/// A piece of a segment over which the set is one line, as places from 0 to 1.
type Piece = (f64, f64);

/// The strengths of the rules and of the conclusions that they share.
struct Strengths<'a> {
    rules: &'a [f64],
    conclusions: &'a [f64],
}

impl Exact {
    /// What each rule has in the aggregated set.
    pub fn parts(&self, prepared: &PreparedSegments<f64>, strengths: &[f64]) -> Parts {
        let mut scratch = vec![0.0; self.scratch_count()];
        let (joined, scratch) = scratch.split_at_mut(self.conclusions.len());
        let conclusions = join(&self.conclusions, strengths, joined);
        let strengths = Strengths { rules: strengths, conclusions };
        let mut parts = Collected::new(strengths.rules.len());
        let mut reached = self.universe.0;
        for segment in &prepared.0 {
            parts.flat(reached, segment.low);
            reached = segment.high;
            let bends = match self.implication {
                TNorm::Product => {
                    let (lines, rest) = scaled_lines(segment, conclusions, scratch);
                    meetings(lines, rest)
                }
                _ => clipped_bends(segment, conclusions, scratch),
            };
            let mut places = bends.places[..bends.count].to_vec();
            if self.implication != TNorm::Product {
                places.extend(self.own_clips(segment, strengths.rules));
            }
            for piece in pieces(places) {
                self.divide_piece(segment, piece, &strengths, &mut parts);
            }
        }
        parts.flat(reached, self.universe.1);
        parts.finish(Whole::Average)
    }

    /// Where each rule by itself would clip its line: up to there it reaches what a stronger rule
    /// with the same term does.
    fn own_clips(&self, segment: &Segment<f64>, strengths: &[f64]) -> impl Iterator<Item = f64> {
        segment.lines.iter().flat_map(move |line| {
            let (start, rise) = ends::<f64, f64>(line);
            let rules = self.conclusions[line.conclusion].rules.iter();
            rules.map(move |&rule| ((strengths[rule] - start) / rise).clamp(0.0, 1.0))
        })
    }

    fn divide_piece(
        &self,
        segment: &Segment<f64>,
        (from, to): Piece,
        strengths: &Strengths,
        parts: &mut Collected,
    ) {
        let implied = |line: &Line<f64>, strength: f64, t: f64| {
            let (start, rise) = ends::<f64, f64>(line);
            self.implication.apply(strength, t.mul_add(rise, start))
        };
        let height = |t: f64| {
            let own = |line: &Line<f64>| implied(line, strengths.conclusions[line.conclusion], t);
            segment.lines.iter().map(own).fold(0.0, f64::max)
        };
        let place = |t: f64| t.mul_add(segment.high - segment.low, segment.low);
        let (y0, y1, at_y0, at_y1) = (place(from), place(to), height(from), height(to));
        parts.point(y0, at_y0);
        parts.point(y1, at_y1);
        // The middle of a piece is not on another line that only touches it at an end.
        let middle = 0.5 * (from + to);
        let each = segment.lines.iter().flat_map(|line| {
            let rules = self.conclusions[line.conclusion].rules.iter();
            rules.map(move |&rule| (rule, implied(line, strengths.rules[rule], middle)))
        });
        let centroid = centroid(y0, y1, at_y0, at_y1);
        divide(MAX, height(middle), each, |rule, height| {
            let area = height * (y1 - y0);
            parts.give(rule, area, area * centroid);
        });
    }
}

/// The centroid of the area under a line from one place to another.
fn centroid(from: f64, to: f64, at_from: f64, at_to: f64) -> f64 {
    let both = at_from + at_to;
    if both > 0.0 { from + (to - from) * (at_from + 2.0 * at_to) / (3.0 * both) } else { from }
}

/// The pieces between places from 0 to 1 that are no single points; NaN is no place.
fn pieces(mut places: Vec<f64>) -> Vec<Piece> {
    places.extend([0.0, 1.0]);
    places.sort_by(f64::total_cmp);
    let pieces = places.windows(2).map(|ends| (ends[0], ends[1]));
    pieces.filter(|(from, to)| from < to).collect()
}

impl Collected {
    /// Says that the set is 0 from one place to another, if there is anything between them.
    fn flat(&mut self, from: f64, to: f64) {
        if from < to {
            self.point(from, 0.0);
            self.point(to, 0.0);
        }
    }
}
