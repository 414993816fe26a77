//! Outputs whose rules conclude numbers z that are weighted by the firing strengths w: Sugeno's,
//! Tsukamoto's, and the height form of Mamdani's.

use super::Answer;
use super::layout::{ConsequentSlot, TermSlot};
use super::parts::{Collected, Parts, Whole, divide};
use crate::expression::Expression;
use crate::math::{Numbers, Real, Scalar};
use crate::norm::Aggregation;
use crate::output::Weighting;

/// What a term contributes.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Term {
    /// The parameter at this place.
    Constant(usize),
    /// The coefficients of so many inputs that begin at this place, and a constant behind them.
    Linear(usize, usize),
    /// A formula of the inputs.
    Formula(Expression),
    /// The number whose degree is the strength.
    Inverse(TermSlot),
    /// The middle of the term's core within the universe.
    Centre(TermSlot, (f64, f64)),
}

/// What the conclusions depend on.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Kind {
    /// Nothing: each term is one number.
    Constant,
    OfInputs,
    OfStrength,
}

/// An output that weighs numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Weighted {
    terms: Vec<Term>,
    /// Where the numbers of each term begin.
    first: Vec<usize>,
    /// The concluded terms whose numbers are parameters of their own.
    linear: Vec<usize>,
    kind: Kind,
    /// The rule and the term of each conclusion.
    conclusions: Vec<(usize, usize)>,
    /// How strengths of rules with the same term are joined.
    aggregation: Aggregation,
    weighting: Weighting,
}

/// The numbers of the terms, one after the other.
#[derive(Debug, Clone)]
pub(super) struct PreparedTerms<N>(Vec<N>);

impl Weighted {
    pub fn new(
        terms: Vec<Term>,
        conclusions: Vec<(usize, usize)>,
        (aggregation, weighting): (Aggregation, Weighting),
    ) -> Self {
        let mut first = Vec::with_capacity(terms.len());
        let mut next = 0;
        for term in &terms {
            first.push(next);
            next += match term {
                Term::Constant(_) | Term::Centre(..) => 1,
                Term::Linear(_, inputs) => inputs + 1,
                Term::Formula(_) => 0,
                Term::Inverse(slot) => slot.count,
            };
        }
        let constant = |term: &Term| matches!(term, Term::Constant(_) | Term::Centre(..));
        let kind = if terms.iter().all(constant) {
            Kind::Constant
        } else if terms.iter().any(|term| matches!(term, Term::Inverse(_))) {
            Kind::OfStrength
        } else {
            Kind::OfInputs
        };
        let concluded = |term: &usize| conclusions.iter().any(|(_, other)| other == term);
        let own = |term: &usize| matches!(terms[*term], Term::Constant(_) | Term::Linear(..));
        let linear = (0..terms.len()).filter(own).filter(concluded).collect();
        Self { terms, first, linear, kind, conclusions, aggregation, weighting }
    }

    /// Where the numbers of the concluded terms stand that the output is linear in.
    pub fn slots(&self) -> Vec<ConsequentSlot> {
        let slot = |&term: &usize| match self.terms[term] {
            Term::Constant(place) => Some(ConsequentSlot { place, count: 1 }),
            Term::Linear(place, inputs) => Some(ConsequentSlot { place, count: inputs + 1 }),
            _ => None,
        };
        self.linear.iter().filter_map(slot).collect()
    }

    /// The number of [`slots`](Self::slots).
    pub fn slot_count(&self) -> usize {
        self.linear.len()
    }

    /// Writes the factor of each of the [`slots`](Self::slots) in the output. Returns what the
    /// formulas say, and the sum of the strengths.
    #[inline(always)]
    pub fn shares<R: Real>(
        &self,
        x: &[R],
        strengths: &[R],
        scratch: &mut [R],
        shares: &mut [R],
    ) -> Answer<R> {
        let zero = R::splat(0.0);
        let joined = &mut scratch[..self.terms.len()];
        joined.fill(zero);
        for &(rule, term) in &self.conclusions {
            joined[term] = self.aggregation.apply(joined[term], strengths[rule]);
        }
        let total = joined.iter().fold(zero, |sum, &w| sum + w);
        let scale = match self.weighting {
            Weighting::Average => R::select(zero.lt(total), R::splat(1.0) / total, zero),
            Weighting::Sum => R::splat(1.0),
        };
        for (share, &term) in shares.iter_mut().zip(&self.linear) {
            *share = joined[term] * scale;
        }
        let mut value = zero;
        for (term, &w) in self.terms.iter().zip(&*joined) {
            if let Term::Formula(formula) = term {
                let said = R::select(zero.lt(w), formula.evaluate(x), zero);
                value = (w * scale).mul_add(said, value);
            }
        }
        Answer { value, strength: total }
    }

    /// The numbers of working space that [`infer`](Self::infer) needs.
    pub fn scratch_count(&self) -> usize {
        2 * self.terms.len()
    }

    pub fn prepare<N: Scalar>(&self, parameters: &[N]) -> PreparedTerms<N> {
        let mut numbers = Vec::new();
        for term in &self.terms {
            match term {
                Term::Constant(place) => numbers.push(parameters[*place]),
                Term::Linear(place, inputs) => {
                    numbers.extend_from_slice(&parameters[*place..][..=*inputs]);
                }
                Term::Formula(_) => {}
                Term::Inverse(slot) => numbers.extend_from_slice(slot.own(parameters)),
                Term::Centre(slot, (low, high)) => {
                    numbers.push(slot.shape.centre(slot.own(parameters), *low, *high));
                }
            }
        }
        PreparedTerms(numbers)
    }

    /// The output for these firing strengths of the rules.
    #[inline(always)]
    pub fn infer<N: Scalar, R: Real>(
        &self,
        prepared: &PreparedTerms<N>,
        x: &[R],
        strengths: &[R],
        scratch: &mut [R],
        fallback: f64,
    ) -> Answer<R>
    where
        [N]: Numbers<R>,
    {
        let zero = R::splat(0.0);
        let numbers = prepared.0.as_slice();
        let (values, joined) = scratch.split_at_mut(self.terms.len());
        let value =
            |term: usize, w: R| Self::value(&self.terms[term], numbers, self.first[term], x, w);
        let (weighted, total) = match self.kind {
            Kind::Constant => self.weigh(strengths, joined, |term, _| numbers.number(term)),
            Kind::OfInputs => {
                values.iter_mut().enumerate().for_each(|(term, z)| *z = value(term, zero));
                // A rule that doesn't fire concludes nothing, be it infinite.
                let values = &*values;
                self.weigh(strengths, joined, |term, w| R::select(zero.lt(w), values[term], zero))
            }
            Kind::OfStrength => self.weigh(strengths, joined, value),
        };
        let value = match self.weighting {
            Weighting::Average => weighted / total,
            Weighting::Sum => weighted,
        };
        let fires = zero.lt(total);
        Answer { value: R::select(fires, value, R::splat(fallback)), strength: total }
    }

    /// What each rule has in the sums.
    pub fn parts(&self, prepared: &PreparedTerms<f64>, x: &[f64], strengths: &[f64]) -> Parts {
        let value = |term: usize, w: f64| {
            Self::value(&self.terms[term], prepared.0.as_slice(), self.first[term], x, w)
        };
        let mut parts = Collected::new(strengths.len());
        let mut by_term = vec![Vec::new(); self.terms.len()];
        for &(rule, term) in &self.conclusions {
            by_term[term].push((rule, strengths[rule]));
            parts.conclude(rule, value(term, strengths[rule]));
        }
        for (term, each) in by_term.iter().enumerate() {
            let join = |joined, &(_, w): &(usize, f64)| self.aggregation.apply(joined, w);
            let joined = each.iter().fold(0.0, join);
            divide(self.aggregation, joined, each.iter().copied(), |rule, w| {
                // A rule that doesn't fire concludes nothing, be it infinite.
                let moment = if w > 0.0 { w * value(term, strengths[rule]) } else { 0.0 };
                parts.give(rule, w, moment);
            });
        }
        parts.finish(match self.weighting {
            Weighting::Average => Whole::Average,
            Weighting::Sum => Whole::Sum,
        })
    }

    /// Σ w·z and Σ w, for z of a term and a strength.
    #[inline(always)]
    fn weigh<R: Real>(
        &self,
        strengths: &[R],
        joined: &mut [R],
        value: impl Fn(usize, R) -> R,
    ) -> (R, R) {
        let (mut weighted, mut total) = (R::splat(0.0), R::splat(0.0));
        let mut add = |term: usize, w: R| {
            weighted = w.mul_add(value(term, w), weighted);
            total = total + w;
        };
        if self.aggregation == Aggregation::Sum {
            self.conclusions.iter().for_each(|&(rule, term)| add(term, strengths[rule]));
        } else {
            let joined = &mut joined[..self.terms.len()];
            joined.fill(R::splat(0.0));
            for &(rule, term) in &self.conclusions {
                joined[term] = self.aggregation.apply(joined[term], strengths[rule]);
            }
            joined.iter().enumerate().for_each(|(term, &w)| add(term, w));
        }
        (weighted, total)
    }

    /// What a term concludes, whose numbers begin at `first`, at strength `w`.
    #[inline(always)]
    fn value<R: Real>(
        term: &Term,
        numbers: &(impl Numbers<R> + ?Sized),
        first: usize,
        x: &[R],
        w: R,
    ) -> R {
        match term {
            Term::Constant(_) | Term::Centre(..) => numbers.number(first),
            Term::Linear(..) => {
                let mut sum = numbers.number(first + x.len());
                for (k, &input) in x.iter().enumerate() {
                    sum = input.mul_add(numbers.number(first + k), sum);
                }
                sum
            }
            Term::Formula(formula) => formula.evaluate(x),
            Term::Inverse(slot) => {
                let own: [R; 2] = std::array::from_fn(|k| numbers.number(first + k));
                slot.shape.inverse(&own[..slot.count], w)
            }
        }
    }
}
