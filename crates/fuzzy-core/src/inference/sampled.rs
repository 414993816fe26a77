//! Aggregated fuzzy sets of a Mamdani output at samples of its universe, and what is picked from
//! them.
//!
//! The centroid's sums are taken in eight parts, each over neighbouring samples, and then joined.
//! Many points go through the parts one after the other, eight points at a time; one point goes
//! through all eight parts at a time. Both make the same additions in the same order.

use std::ops::Range;

use super::Answer;
use super::layout::TermSlot;
use super::parts::{Collected, Parts, Whole, divide};
use crate::hedge::Hedge;
use crate::math::{LANES, Lanes, Numbers, Real, Scalar};
use crate::norm::{Aggregation, SNorm, TNorm};
use crate::output::Defuzzifier;

/// A concluded set: a term with its hedges, and the rules that conclude it together.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Conclusion {
    pub term: TermSlot,
    pub hedges: Vec<Hedge>,
    pub rules: Vec<usize>,
}

/// A Mamdani output that is looked at in samples.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sampled {
    pub conclusions: Vec<Conclusion>,
    pub implication: TNorm,
    pub aggregation: Aggregation,
    pub defuzzifier: Defuzzifier,
    pub samples: Vec<f64>,
}

/// The samples in stretches over which the same conclusions have a degree above zero: the others
/// add nothing there, since T(w, 0) = 0 and S(a, 0) = a.
#[derive(Debug, Clone)]
pub(super) struct PreparedSamples<N> {
    stretches: Vec<Stretch>,
    /// The degrees of each stretch, sample by sample.
    degrees: Vec<N>,
    side_by_side: SideBySide,
}

/// The samples of the eight parts side by side: first one sample of each with the degrees of all
/// conclusions there, then the next. Parts that have fewer samples are filled up with degrees of
/// zero. Empty, unless the numbers are plain and few enough that no stretch is worth skipping.
#[derive(Debug, Clone, Default)]
struct SideBySide {
    rows: Vec<Lanes>,
    conclusions: usize,
}

/// The most conclusions that [`SideBySide`] takes.
const FEW_CONCLUSIONS: usize = 8;

#[derive(Debug, Clone)]
struct Stretch {
    conclusions: Vec<usize>,
    samples: Range<usize>,
    degrees: Range<usize>,
    /// Whether a part of the centroid's sums ends with it.
    ends_part: bool,
}

impl Sampled {
    pub fn prepare<N: Scalar>(&self, parameters: &[N]) -> PreparedSamples<N>
    where
        [N]: Numbers<N>,
    {
        let table: Vec<Vec<N>> = self
            .conclusions
            .iter()
            .map(|conclusion| {
                let mut degrees = conclusion.term.degrees(parameters, &self.samples);
                for hedge in conclusion.hedges.iter().rev() {
                    degrees.iter_mut().for_each(|degree| *degree = hedge.apply(*degree));
                }
                degrees
            })
            .collect();
        let part = self.samples.len().div_ceil(LANES);
        let side_by_side = SideBySide::new(&table, &self.samples, part);
        let (stretches, degrees) = (Vec::<Stretch>::new(), Vec::new());
        let mut prepared = PreparedSamples { stretches, degrees, side_by_side };
        for sample in 0..self.samples.len() {
            let here = |&conclusion: &usize| table[conclusion][sample].value() != 0.0;
            let conclusions: Vec<usize> = (0..table.len()).filter(here).collect();
            let first = prepared.degrees.len();
            prepared.degrees.extend(conclusions.iter().map(|&row| table[row][sample]));
            let end = prepared.degrees.len();
            match prepared.stretches.last_mut() {
                Some(stretch) if stretch.conclusions == conclusions && sample % part != 0 => {
                    stretch.samples.end += 1;
                    stretch.degrees.end = end;
                }
                _ => prepared.stretches.push(Stretch {
                    conclusions,
                    samples: sample..sample + 1,
                    degrees: first..end,
                    ends_part: false,
                }),
            }
            if let Some(stretch) = prepared.stretches.last_mut() {
                stretch.ends_part = (sample + 1) % part == 0 || sample + 1 == self.samples.len();
            }
        }
        prepared
    }

    /// The output for these firing strengths of the rules; `scratch` has a place for each
    /// conclusion.
    #[inline(always)]
    pub fn infer<N: Scalar, R: Real>(
        &self,
        prepared: &PreparedSamples<N>,
        strengths: &[R],
        scratch: &mut [R],
        fallback: f64,
    ) -> Answer<R>
    where
        [N]: Numbers<R>,
    {
        let strengths = join(&self.conclusions, strengths, scratch);
        if let Some(plain) = R::plain(strengths)
            && let Some((moment, area)) = self.sums_side_by_side(&prepared.side_by_side, plain)
        {
            return answer(R::splat(moment / area), R::splat(area), fallback);
        }
        let sums = Sums { owner: self, prepared, strengths };
        // The usual norms are named here, so that their loops hold no decision.
        let (value, size) = match (self.implication, self.aggregation) {
            (TNorm::Min, Aggregation::Norm(SNorm::Max)) => sums.defuzzify(R::min, R::max),
            (TNorm::Product, Aggregation::Norm(SNorm::Max)) => {
                sums.defuzzify(|w, degree| w * degree, R::max)
            }
            (implication, aggregation) => sums.defuzzify(
                |w, degree| implication.apply(w, degree),
                |a, b| aggregation.apply(a, b),
            ),
        };
        answer(value, size, fallback)
    }

    /// The moment and the area of the aggregated set, if they are what is asked for and the usual
    /// norms make them.
    #[inline(always)]
    fn sums_side_by_side(&self, samples: &SideBySide, strengths: &[f64]) -> Option<(f64, f64)> {
        if samples.rows.is_empty() || self.defuzzifier != Defuzzifier::Centroid {
            return None;
        }
        let (moment, area) = match (self.implication, self.aggregation) {
            (TNorm::Min, Aggregation::Norm(SNorm::Max)) => {
                samples.sums(strengths, Lanes::min, Lanes::max)
            }
            (TNorm::Product, Aggregation::Norm(SNorm::Max)) => {
                samples.sums(strengths, |w, degree| w * degree, Lanes::max)
            }
            _ => return None,
        };
        Some((total(moment.to_array()), total(area.to_array())))
    }

    /// What each rule has in the aggregated set, sample by sample.
    pub fn parts(&self, prepared: &PreparedSamples<f64>, strengths: &[f64]) -> Parts {
        let mut joined = vec![0.0; self.conclusions.len()];
        let joined = join(&self.conclusions, strengths, &mut joined);
        let mut parts = Collected::new(strengths.len());
        for stretch in &prepared.stretches {
            let (samples, conclusions) = (stretch.samples.clone(), &stretch.conclusions);
            for (place, &y) in self.samples[samples].iter().enumerate() {
                let first = stretch.degrees.start + place * conclusions.len();
                let own = &prepared.degrees[first..][..conclusions.len()];
                let here = conclusions.iter().zip(own);
                self.divide_sample(y, here, (strengths, joined), &mut parts);
            }
        }
        parts.finish(match self.defuzzifier {
            Defuzzifier::Centroid | Defuzzifier::Height => Whole::Average,
            _ => Whole::Picked,
        })
    }

    /// Divides the set at a sample among the rules. `here` is the conclusions with their degrees,
    /// `joined` the conclusions' strengths.
    fn divide_sample<'a>(
        &'a self,
        y: f64,
        here: impl Iterator<Item = (&'a usize, &'a f64)> + Clone,
        (strengths, joined): (&'a [f64], &[f64]),
        parts: &mut Collected,
    ) {
        let degree = here.clone().fold(0.0, |degree, (&conclusion, &own)| {
            self.aggregation.apply(degree, self.implication.apply(joined[conclusion], own))
        });
        parts.point(y, degree);
        let each = here.flat_map(|(&conclusion, &own)| {
            let rules = self.conclusions[conclusion].rules.iter();
            rules.map(move |&rule| (rule, self.implication.apply(strengths[rule], own)))
        });
        divide(self.aggregation, degree, each, |rule, area| parts.give(rule, area, area * y));
    }
}

/// The strength of each conclusion, that of its strongest rule.
#[inline(always)]
pub(super) fn join<'a, R: Real>(
    conclusions: &[Conclusion],
    strengths: &[R],
    scratch: &'a mut [R],
) -> &'a [R] {
    for (conclusion, joined) in conclusions.iter().zip(scratch.iter_mut()) {
        let rules = conclusion.rules.iter().map(|&rule| strengths[rule]);
        *joined = rules.fold(R::splat(0.0), R::max);
    }
    &scratch[..conclusions.len()]
}

/// The value, or what stands for it where the aggregated set is empty: no rule fires, or none
/// leaves anything of its term. `size` is zero for an empty set.
#[inline(always)]
pub(super) fn answer<R: Real>(value: R, size: R, fallback: f64) -> Answer<R> {
    let value = R::select(R::splat(0.0).lt(size), value, R::splat(fallback));
    Answer { value, strength: size }
}

impl SideBySide {
    /// `table` has the degrees of each conclusion at every sample, `part` is the number of
    /// samples of a part.
    fn new<N: Scalar>(table: &[Vec<N>], samples: &[f64], part: usize) -> Self {
        let plain: Option<Vec<&[f64]>> = table.iter().map(|degrees| N::plain(degrees)).collect();
        let Some(table) = plain.filter(|table| table.len() <= FEW_CONCLUSIONS) else {
            return Self::default();
        };
        let spread = |numbers: &[f64], place: usize| {
            let number = |lane: usize| numbers.get(lane * part + place).copied().unwrap_or(0.0);
            Lanes::new(std::array::from_fn(number))
        };
        let row = |place| {
            let degrees = table.iter().map(move |degrees| spread(degrees, place));
            std::iter::once(spread(samples, place)).chain(degrees)
        };
        Self { rows: (0..part).flat_map(row).collect(), conclusions: table.len() }
    }

    /// The moments and the areas of the eight parts for these strengths of the conclusions.
    #[inline(always)]
    fn sums(
        &self,
        strengths: &[f64],
        implication: impl Fn(Lanes, Lanes) -> Lanes,
        aggregation: impl Fn(Lanes, Lanes) -> Lanes,
    ) -> (Lanes, Lanes) {
        let zero = Lanes::splat(0.0);
        let (mut moment, mut area) = (zero, zero);
        for row in self.rows.chunks_exact(1 + self.conclusions) {
            let degrees = row[1..].iter().zip(strengths);
            let join = |joined, (&degree, &w): (&Lanes, &f64)| {
                aggregation(joined, implication(Lanes::splat(w), degree))
            };
            let degree = degrees.fold(zero, join);
            moment = degree.mul_add(row[0], moment);
            area = area + degree;
        }
        (moment, area)
    }
}

/// The sum of the eight parts of a sum.
#[inline(always)]
fn total<R: Real>(parts: [R; LANES]) -> R {
    let [a, b, c, d, e, f, g, h] = parts;
    ((a + b) + (c + d)) + ((e + f) + (g + h))
}

struct Sums<'a, N, R> {
    owner: &'a Sampled,
    prepared: &'a PreparedSamples<N>,
    strengths: &'a [R],
}

impl<N: Scalar, R: Real> Sums<'_, N, R>
where
    [N]: Numbers<R>,
{
    /// Visits every sample with the degree of the aggregated set there.
    #[inline(always)]
    fn walk(
        &self,
        implication: impl Fn(R, R) -> R,
        aggregation: impl Fn(R, R) -> R,
        mut visit: impl FnMut(f64, R),
    ) {
        for stretch in &self.prepared.stretches {
            self.walk_stretch(stretch, &implication, &aggregation, &mut visit);
        }
    }

    /// Visits the samples of a stretch.
    #[inline(always)]
    fn walk_stretch(
        &self,
        stretch: &Stretch,
        implication: impl Fn(R, R) -> R,
        aggregation: impl Fn(R, R) -> R,
        mut visit: impl FnMut(f64, R),
    ) {
        let zero = R::splat(0.0);
        let samples = &self.owner.samples[stretch.samples.clone()];
        let degrees = &self.prepared.degrees[stretch.degrees.clone()];
        let implied = |conclusion: usize, degree: &N| {
            implication(self.strengths[conclusion], std::slice::from_ref(degree).number(0))
        };
        match *stretch.conclusions.as_slice() {
            [] => samples.iter().for_each(|&y| visit(y, zero)),
            // Partitions have one or two terms at a time, whose strengths stay at hand.
            [only] => {
                for (&y, degree) in samples.iter().zip(degrees) {
                    visit(y, implied(only, degree));
                }
            }
            [first, second] => {
                for (&y, pair) in samples.iter().zip(degrees.chunks_exact(2)) {
                    let (one, other) = (implied(first, &pair[0]), implied(second, &pair[1]));
                    visit(y, aggregation(one, other));
                }
            }
            ref several => {
                for (&y, degrees) in samples.iter().zip(degrees.chunks_exact(several.len())) {
                    let each = several.iter().zip(degrees);
                    let join = |joined, (&conclusion, degree)| {
                        aggregation(joined, implied(conclusion, degree))
                    };
                    visit(y, each.fold(zero, join));
                }
            }
        }
    }

    /// What the defuzzifier picks, and the area or the height of the set.
    #[inline(always)]
    fn defuzzify(
        &self,
        implication: impl Fn(R, R) -> R,
        aggregation: impl Fn(R, R) -> R,
    ) -> (R, R) {
        let (zero, one) = (R::splat(0.0), R::splat(1.0));
        match self.owner.defuzzifier {
            Defuzzifier::Bisector => {
                let (mut area, mut part, mut found) = (zero, zero, zero);
                self.walk(&implication, &aggregation, |_, degree| area = area + degree);
                let half = area * R::splat(0.5);
                self.walk(&implication, &aggregation, |y, degree| {
                    let before = part.lt(half);
                    part = part + degree;
                    let reached = R::select(half.le(part), R::splat(y), found);
                    found = R::select(before, reached, found);
                });
                (found, area)
            }
            Defuzzifier::MeanOfMaximum => {
                let (mut most, mut sum, mut count) = (zero, zero, zero);
                self.walk(&implication, &aggregation, |y, degree| {
                    let (more, as_much) = (most.lt(degree), most.le(degree));
                    let kept = |number: R| R::select(more, zero, number);
                    sum = R::select(as_much, kept(sum) + R::splat(y), sum);
                    count = R::select(as_much, kept(count) + one, count);
                    most = most.max(degree);
                });
                (sum / count, most)
            }
            Defuzzifier::SmallestOfMaximum => {
                let (mut most, mut found) = (zero, zero);
                self.walk(&implication, &aggregation, |y, degree| {
                    found = R::select(most.lt(degree), R::splat(y), found);
                    most = most.max(degree);
                });
                (found, most)
            }
            Defuzzifier::LargestOfMaximum => {
                let (mut most, mut found) = (zero, zero);
                self.walk(&implication, &aggregation, |y, degree| {
                    found = R::select(most.le(degree), R::splat(y), found);
                    most = most.max(degree);
                });
                (found, most)
            }
            // The height form never gets here: it has no samples.
            Defuzzifier::Centroid | Defuzzifier::Height => {
                let (mut moment, mut area) = (zero, zero);
                let (mut moments, mut areas, mut part) = ([zero; LANES], [zero; LANES], 0);
                for stretch in &self.prepared.stretches {
                    self.walk_stretch(stretch, &implication, &aggregation, |y, degree| {
                        moment = degree.mul_add(R::splat(y), moment);
                        area = area + degree;
                    });
                    if stretch.ends_part {
                        (moments[part], areas[part]) = (moment, area);
                        (moment, area) = (zero, zero);
                        part += 1;
                    }
                }
                let area = total(areas);
                (total(moments) / area, area)
            }
        }
    }
}
