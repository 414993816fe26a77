//! What each rule has in an output.

use crate::norm::{Aggregation, SNorm};

/// What each rule has in an output at a point; one number for each rule of the system.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    /// The rule's share of the firing strengths (weighted outputs) or of the area of the
    /// aggregated set (fuzzy sets). They add up to 1, or are all 0 where no rule fires.
    ///
    /// Where strengths or sets are joined by max, what is joined belongs to the rules that reach
    /// it, evenly if there are several; where they are joined otherwise, it is divided in
    /// proportion to what each rule brings. A set is divided at each sample of its own; one
    /// without samples everywhere.
    pub shares: Vec<f64>,
    /// What the rule adds to the output:
    ///
    /// - weighted average: its share times what it concludes;
    /// - weighted sum: its firing strength, or its part of a joined one, times what it concludes;
    /// - centroid: the moment ∫y of its part of the aggregated set over the whole area, that is
    ///   its share times the centroid of its part.
    ///
    /// They add up to the output but for rounding, where rules fire. The bisector and the maximum
    /// defuzzifiers pick a point, which is no sum: there they are NaN.
    pub contributions: Vec<f64>,
    /// The number that the rule concludes about a weighted output at this point: of several their
    /// mean. NaN if it concludes a fuzzy set, or nothing about this output.
    pub concluded: Vec<f64>,
    /// The aggregated set of a Mamdani output (y, A(y)), y never decreasing: at its samples, or
    /// for exact sampling its corners. Empty for outputs that have none.
    pub set: Vec<(f64, f64)>,
}

/// What the parts of the rules make together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Whole {
    Average,
    Sum,
    /// A point that is no sum.
    Picked,
}

/// The parts of the rules while they are collected.
#[derive(Debug, Clone)]
pub(super) struct Collected {
    masses: Vec<f64>,
    moments: Vec<f64>,
    /// The sum of the numbers that a rule concludes, and how many they are.
    concluded: Vec<(f64, usize)>,
    set: Vec<(f64, f64)>,
}

impl Collected {
    /// Nothing yet, for so many rules.
    pub fn new(rules: usize) -> Self {
        Self {
            masses: vec![0.0; rules],
            moments: vec![0.0; rules],
            concluded: vec![(0.0, 0); rules],
            set: Vec::new(),
        }
    }

    /// Gives a rule a weight or area, and its moment.
    pub fn give(&mut self, rule: usize, mass: f64, moment: f64) {
        self.masses[rule] += mass;
        self.moments[rule] += moment;
    }

    /// Notes a number that a rule concludes.
    pub fn conclude(&mut self, rule: usize, value: f64) {
        let (sum, count) = self.concluded[rule];
        self.concluded[rule] = (sum + value, count + 1);
    }

    /// Adds a point of the aggregated set, unless it stands there already.
    pub fn point(&mut self, y: f64, degree: f64) {
        if self.set.last() != Some(&(y, degree)) {
            self.set.push((y, degree));
        }
    }

    /// The parts of a whole of this kind.
    pub fn finish(self, whole: Whole) -> Parts {
        let total: f64 = self.masses.iter().sum();
        let of_total = |part: f64| if total > 0.0 { part / total } else { 0.0 };
        let contribution = |&moment: &f64| match whole {
            Whole::Average => of_total(moment),
            Whole::Sum => moment,
            Whole::Picked => f64::NAN,
        };
        let mean = |&(sum, count): &(f64, usize)| sum / count as f64;
        Parts {
            shares: self.masses.iter().copied().map(of_total).collect(),
            contributions: self.moments.iter().map(contribution).collect(),
            concluded: self.concluded.iter().map(mean).collect(),
            set: self.set,
        }
    }
}

/// Divides what several rules bring together: under max it belongs to those that reach it,
/// evenly; otherwise each gets in proportion to what it brings. `each` is the rules with that.
pub(super) fn divide(
    aggregation: Aggregation,
    joined: f64,
    each: impl Iterator<Item = (usize, f64)> + Clone,
    mut give: impl FnMut(usize, f64),
) {
    let claim = |own: f64| match aggregation {
        Aggregation::Norm(SNorm::Max) if own >= joined => 1.0,
        Aggregation::Norm(SNorm::Max) => 0.0,
        _ => own,
    };
    let total: f64 = each.clone().map(|(_, own)| claim(own)).sum();
    if joined > 0.0 && total > 0.0 {
        each.for_each(|(rule, own)| give(rule, joined * (claim(own) / total)));
    }
}
