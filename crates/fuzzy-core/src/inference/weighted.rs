//! Outputs whose rules conclude numbers z that are weighted by the firing strengths w: Sugeno's,
//! Tsukamoto's, and the height form of Mamdani's.

use super::Answer;
use super::layout::TermSlot;
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

/// An output that weighs numbers.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Weighted {
    terms: Vec<Term>,
    /// Where the numbers of each term begin.
    first: Vec<usize>,
    depends_on_strength: bool,
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
        let depends_on_strength = terms.iter().any(|term| matches!(term, Term::Inverse(_)));
        Self { terms, first, depends_on_strength, conclusions, aggregation, weighting }
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
        let (values, joined) = scratch.split_at_mut(self.terms.len());
        let value = |term: usize, w: R| {
            let first = self.first[term];
            Self::value(&self.terms[term], prepared.0.as_slice(), first, x, w)
        };
        if !self.depends_on_strength {
            values.iter_mut().enumerate().for_each(|(term, z)| *z = value(term, zero));
        }
        let (mut weighted, mut total) = (zero, zero);
        let mut add = |term: usize, w: R| {
            let z = if self.depends_on_strength { value(term, w) } else { values[term] };
            // A rule that doesn't fire concludes nothing, be it infinite.
            weighted = w.mul_add(R::select(zero.lt(w), z, zero), weighted);
            total = total + w;
        };
        if self.aggregation == Aggregation::Sum {
            self.conclusions.iter().for_each(|&(rule, term)| add(term, strengths[rule]));
        } else {
            joined[..self.terms.len()].fill(zero);
            for &(rule, term) in &self.conclusions {
                joined[term] = self.aggregation.apply(joined[term], strengths[rule]);
            }
            (0..self.terms.len()).for_each(|term| add(term, joined[term]));
        }
        let value = match self.weighting {
            Weighting::Average => weighted / total,
            Weighting::Sum => weighted,
        };
        let fires = zero.lt(total);
        Answer { value: R::select(fires, value, R::splat(fallback)), strength: total }
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
