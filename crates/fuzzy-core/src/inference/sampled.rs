//! Aggregated fuzzy sets of a Mamdani output at samples of its universe, and what is picked from
//! them.

use super::Answer;
use super::layout::TermSlot;
use crate::hedge::Hedge;
use crate::math::{Numbers, Real, Scalar};
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

/// For each sample the conclusions whose degree there isn't zero: the others add nothing, since
/// T(w, 0) = 0 and S(a, 0) = a.
#[derive(Debug, Clone)]
pub(super) struct PreparedSamples<N> {
    ends: Vec<usize>,
    degrees: Vec<(usize, N)>,
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
        let (mut ends, mut degrees) = (Vec::with_capacity(self.samples.len()), Vec::new());
        for sample in 0..self.samples.len() {
            let column = table.iter().map(|row| row[sample]).enumerate();
            degrees.extend(column.filter(|(_, degree)| degree.value() != 0.0));
            ends.push(degrees.len());
        }
        PreparedSamples { ends, degrees }
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
        let sums = Sums { owner: self, prepared, strengths };
        // The usual norms are named here, so that their loops hold no decision.
        let value = match (self.implication, self.aggregation) {
            (TNorm::Min, Aggregation::Norm(SNorm::Max)) => sums.defuzzify(R::min, R::max),
            (TNorm::Product, Aggregation::Norm(SNorm::Max)) => {
                sums.defuzzify(|w, degree| w * degree, R::max)
            }
            (implication, aggregation) => sums.defuzzify(
                |w, degree| implication.apply(w, degree),
                |a, b| aggregation.apply(a, b),
            ),
        };
        answer(value, strengths, fallback)
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

/// The value, or what stands for it where nothing fires.
#[inline(always)]
pub(super) fn answer<R: Real>(value: R, strengths: &[R], fallback: f64) -> Answer<R> {
    let strength = strengths.iter().fold(R::splat(0.0), |sum, &w| sum + w);
    let fires = R::splat(0.0).lt(strength);
    Answer { value: R::select(fires, value, R::splat(fallback)), strength }
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
        let mut first = 0;
        for (&y, &end) in self.owner.samples.iter().zip(&self.prepared.ends) {
            let here = &self.prepared.degrees[first..end];
            first = end;
            let degree = here.iter().fold(R::splat(0.0), |degree, (conclusion, own)| {
                let own = std::slice::from_ref(own).number(0);
                aggregation(degree, implication(self.strengths[*conclusion], own))
            });
            visit(y, degree);
        }
    }

    #[inline(always)]
    fn defuzzify(&self, implication: impl Fn(R, R) -> R, aggregation: impl Fn(R, R) -> R) -> R {
        let zero = R::splat(0.0);
        match self.owner.defuzzifier {
            Defuzzifier::Bisector => {
                let (mut whole, mut part, mut found) = (zero, zero, R::splat(f64::NAN));
                self.walk(&implication, &aggregation, |_, degree| whole = whole + degree);
                let half = whole * R::splat(0.5);
                self.walk(&implication, &aggregation, |y, degree| {
                    let before = part.lt(half);
                    part = part + degree;
                    let reached = R::select(half.le(part), R::splat(y), found);
                    found = R::select(before, reached, found);
                });
                found
            }
            Defuzzifier::MeanOfMaximum => {
                let (mut most, mut sum, mut count) = (zero, zero, zero);
                self.walk(&implication, &aggregation, |y, degree| {
                    let more = most.lt(degree);
                    let as_much = most.le(degree);
                    let (y, one) = (R::splat(y), R::splat(1.0));
                    sum = R::select(as_much, y + R::select(more, zero, sum), sum);
                    count = R::select(as_much, one + R::select(more, zero, count), count);
                    most = most.max(degree);
                });
                R::select(zero.lt(most), sum / count, R::splat(f64::NAN))
            }
            Defuzzifier::SmallestOfMaximum => {
                let (mut most, mut found) = (zero, R::splat(f64::NAN));
                self.walk(&implication, &aggregation, |y, degree| {
                    found = R::select(most.lt(degree), R::splat(y), found);
                    most = most.max(degree);
                });
                found
            }
            Defuzzifier::LargestOfMaximum => {
                let (mut most, mut found) = (zero, R::splat(f64::NAN));
                self.walk(&implication, &aggregation, |y, degree| {
                    found = R::select(most.le(degree), R::splat(y), found);
                    most = most.max(degree);
                });
                R::select(zero.lt(most), found, R::splat(f64::NAN))
            }
            // The height form never gets here: it has no samples.
            Defuzzifier::Centroid | Defuzzifier::Height => {
                let (mut moment, mut area) = (zero, zero);
                self.walk(implication, aggregation, |y, degree| {
                    moment = degree.mul_add(R::splat(y), moment);
                    area = area + degree;
                });
                moment / area
            }
        }
    }
}
