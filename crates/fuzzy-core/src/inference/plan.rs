//! A rule system compiled: what follows from its definition once, whatever its parameters are.

use super::exact::{Exact, PreparedSegments};
use super::firing::{Firing, find_hedge};
use super::layout::{ConsequentSlot, TermSlot};
use super::parts::Parts;
use super::sampled::{Conclusion, PreparedSamples, Sampled};
use super::system::{Logic, all_hedges};
use super::weighted::{PreparedTerms, Term, Weighted};
use super::{Answer, Interface};
use crate::check;
use crate::error::{Error, Result};
use crate::hedge::Hedge;
use crate::math::{Numbers, Real, Scalar};
use crate::norm::{Aggregation, SNorm};
use crate::output::{Defuzzifier, Method, Output, Sampling, Value, Weighting};
use crate::rule::{Consequent, Rule};
use crate::variable::Variable;

/// What follows from the definition once, whatever the parameters are.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The terms of each input and of each output, where they are fuzzy sets.
    inputs: Vec<Vec<TermSlot>>,
    output_terms: Vec<Vec<TermSlot>>,
    /// Where the rules' weights begin in the parameter vector.
    pub first_weight: usize,
    /// Whether a formula of the user's may give a degree that is NaN.
    own_hedges: bool,
    firing: Firing,
    outputs: Vec<OutputPlan>,
}

#[derive(Debug, Clone)]
pub(super) enum OutputPlan {
    Sampled(Sampled),
    Exact(Exact),
    Weighted(Weighted),
}

/// The numbers of a [`System`] in the form that inference reads.
#[derive(Debug, Clone)]
pub struct Prepared<N> {
    terms: Vec<N>,
    weights: Vec<N>,
    outputs: Vec<PreparedOutput<N>>,
}

#[derive(Debug, Clone)]
enum PreparedOutput<N> {
    Sampled(PreparedSamples<N>),
    Exact(PreparedSegments<N>),
    Weighted(PreparedTerms<N>),
}

impl Plan {
    pub fn new(
        interface: &Interface,
        outputs: &[Output],
        rules: &[Rule],
        logic: &Logic,
    ) -> Result<Self> {
        let mut offset = 0;
        let mut slots = |variable: &Variable| TermSlot::of_variable(variable, &mut offset);
        let inputs: Vec<Vec<TermSlot>> = interface.inputs().iter().map(&mut slots).collect();
        let hedges = all_hedges(&logic.hedges);
        let own_hedges = !logic.hedges.is_empty();
        let norms = (logic.conjunction, logic.disjunction);
        let firing = Firing::new(rules, interface.inputs(), hedges.clone(), norms, &inputs)?;
        let (mut plans, mut output_terms) = (Vec::new(), Vec::new());
        for output in outputs {
            let first = offset;
            output_terms.push(match output.variable() {
                Some(variable) => TermSlot::of_variable(variable, &mut offset),
                None => {
                    offset += output.parameters().len();
                    Vec::new()
                }
            });
            let asked = Asked::of(output, rules, &hedges)?;
            let slots = output_terms.last().map_or(&[][..], Vec::as_slice);
            plans.push(asked.plan(output, slots, first, inputs.len())?);
        }
        check_size(interface.name(), &plans)?;
        Ok(Self { inputs, output_terms, first_weight: offset, own_hedges, firing, outputs: plans })
    }

    pub fn prepare<N: Scalar>(&self, parameters: &[N]) -> Prepared<N>
    where
        [N]: Numbers<N>,
    {
        let prepare = |plan: &OutputPlan| match plan {
            OutputPlan::Sampled(plan) => PreparedOutput::Sampled(plan.prepare(parameters)),
            OutputPlan::Exact(plan) => PreparedOutput::Exact(plan.prepare(parameters)),
            OutputPlan::Weighted(plan) => PreparedOutput::Weighted(plan.prepare(parameters)),
        };
        Prepared {
            terms: self.firing.prepare(parameters),
            weights: parameters[self.first_weight..].to_vec(),
            outputs: self.outputs.iter().map(prepare).collect(),
        }
    }

    /// Whether a vector of the right length is one of valid parameters.
    pub fn accepts(&self, parameters: &[f64]) -> bool {
        let mut slots = self.inputs.iter().chain(&self.output_terms).flatten();
        parameters.iter().all(|value| value.is_finite())
            && slots.all(|slot| slot.accepts(parameters))
            && parameters[self.first_weight..].iter().all(|w| (0.0..=1.0).contains(w))
    }

    pub fn scratch_count(&self) -> usize {
        let own = self.outputs.iter().map(|plan| match plan {
            OutputPlan::Sampled(plan) => plan.conclusions.len(),
            OutputPlan::Exact(plan) => plan.scratch_count(),
            OutputPlan::Weighted(plan) => plan.scratch_count(),
        });
        self.firing.scratch_count() + own.max().unwrap_or(0)
    }

    /// The answers at a point; `fallbacks` has what stands for each output where no rule fires.
    #[inline(always)]
    pub fn infer<N: Scalar, R: Real>(
        &self,
        prepared: &Prepared<N>,
        x: &[R],
        scratch: &mut [R],
        fallbacks: impl Iterator<Item = f64>,
        answers: &mut [Answer<R>],
    ) where
        [N]: Numbers<R>,
    {
        let (degrees, scratch) = scratch.split_at_mut(self.firing.scratch_count());
        self.firing.fire(&prepared.terms, &prepared.weights, x, degrees);
        let strengths = &degrees[self.firing.first_rule()..];
        let outputs = self.outputs.iter().zip(&prepared.outputs).zip(fallbacks);
        for (((plan, prepared), fallback), answer) in outputs.zip(answers.iter_mut()) {
            *answer = plan.infer(prepared, x, strengths, scratch, fallback);
        }
        if self.own_hedges {
            spread_nan(strengths, answers);
        }
    }

    /// Writes the rules' firing strengths at a point.
    #[inline(always)]
    pub fn fire<N: Scalar, R: Real>(
        &self,
        prepared: &Prepared<N>,
        x: &[R],
        scratch: &mut [R],
        strengths: &mut [R],
    ) where
        [N]: Numbers<R>,
    {
        let degrees = &mut scratch[..self.firing.scratch_count()];
        self.firing.fire(&prepared.terms, &prepared.weights, x, degrees);
        strengths.copy_from_slice(&degrees[self.firing.first_rule()..]);
    }

    /// Where the conclusions of each output stand; `None` for an output that is not linear in them.
    pub fn consequent_slots(&self) -> Vec<Option<Vec<ConsequentSlot>>> {
        let slots = |plan: &OutputPlan| match plan {
            OutputPlan::Weighted(plan) => Some(plan.slots()).filter(|slots| !slots.is_empty()),
            OutputPlan::Sampled(_) | OutputPlan::Exact(_) => None,
        };
        self.outputs.iter().map(slots).collect()
    }

    /// Writes the factor of each conclusion in its output, output by output, and what each
    /// output is without them; see [`consequent_slots`](Self::consequent_slots).
    pub fn shares<R: Real>(
        &self,
        prepared: &Prepared<f64>,
        x: &[R],
        scratch: &mut [R],
        mut shares: &mut [R],
        rest: &mut [Answer<R>],
    ) {
        let (degrees, scratch) = scratch.split_at_mut(self.firing.scratch_count());
        self.firing.fire(&prepared.terms, &prepared.weights, x, degrees);
        let strengths = &degrees[self.firing.first_rule()..];
        for (plan, answer) in self.outputs.iter().zip(rest) {
            if let OutputPlan::Weighted(plan) = plan {
                let (own, others) = shares.split_at_mut(plan.slot_count());
                *answer = plan.shares(x, strengths, scratch, own);
                shares = others;
            }
        }
    }

    /// What each rule has in each output at a point where rules fire this strongly.
    pub fn parts(&self, prepared: &Prepared<f64>, x: &[f64], strengths: &[f64]) -> Vec<Parts> {
        let outputs = self.outputs.iter().zip(&prepared.outputs);
        outputs.filter_map(|(plan, prepared)| plan.parts(prepared, x, strengths)).collect()
    }
}

/// Makes the answers NaN where a strength is: a minimum would take it for the other number.
fn spread_nan<R: Real>(strengths: &[R], answers: &mut [Answer<R>]) {
    let sum = strengths.iter().fold(R::splat(0.0), |sum, &w| sum + w);
    for answer in answers {
        let number = sum.le(sum);
        answer.value = R::select(number, answer.value, R::splat(f64::NAN));
        answer.strength = R::select(number, answer.strength, R::splat(1.0));
    }
}

impl OutputPlan {
    /// None if the numbers are another kind's: each plan prepares its own, see `Plan::prepare`.
    fn parts(&self, prepared: &PreparedOutput<f64>, x: &[f64], strengths: &[f64]) -> Option<Parts> {
        match (self, prepared) {
            (Self::Sampled(plan), PreparedOutput::Sampled(prepared)) => {
                Some(plan.parts(prepared, strengths))
            }
            (Self::Exact(plan), PreparedOutput::Exact(prepared)) => {
                Some(plan.parts(prepared, strengths))
            }
            (Self::Weighted(plan), PreparedOutput::Weighted(prepared)) => {
                Some(plan.parts(prepared, x, strengths))
            }
            _ => None,
        }
    }

    #[inline(always)]
    fn infer<N: Scalar, R: Real>(
        &self,
        prepared: &PreparedOutput<N>,
        x: &[R],
        strengths: &[R],
        scratch: &mut [R],
        fallback: f64,
    ) -> Answer<R>
    where
        [N]: Numbers<R>,
    {
        match (self, prepared) {
            (Self::Sampled(plan), PreparedOutput::Sampled(prepared)) => {
                plan.infer(prepared, strengths, scratch, fallback)
            }
            (Self::Exact(plan), PreparedOutput::Exact(prepared)) => {
                plan.infer(prepared, strengths, scratch, fallback)
            }
            (Self::Weighted(plan), PreparedOutput::Weighted(prepared)) => {
                plan.infer(prepared, x, strengths, scratch, fallback)
            }
            // Each plan prepares its own kind: `Plan::prepare`.
            _ => Answer { value: R::splat(f64::NAN), strength: R::splat(1.0) },
        }
    }
}

/// The most numbers in the tables of sampled outputs, one for each conclusion and sample.
const MOST_DEGREES: usize = 2_000_000;

/// Nothing, if the tables of sampled outputs are not too large together.
fn check_size(system: &str, plans: &[OutputPlan]) -> Result<()> {
    let degrees = plans.iter().map(|plan| match plan {
        OutputPlan::Sampled(plan) => plan.conclusions.len().saturating_mul(plan.samples.len()),
        OutputPlan::Exact(_) | OutputPlan::Weighted(_) => 0,
    });
    let size = degrees.fold(0, usize::saturating_add);
    if size <= MOST_DEGREES {
        return Ok(());
    }
    let what = format!("the sampling of \"{system}\"");
    let reason = format!(
        "its conclusions have {size} samples, more than {MOST_DEGREES}; use fewer samples, or max \
         as aggregation, which joins equal conclusions"
    );
    Err(Error::Unsuitable { what, reason })
}

/// What rules conclude about an output: the rule, the term and the term's hedges.
struct Asked(Vec<(usize, usize, Vec<Hedge>)>);

impl Asked {
    fn of(output: &Output, rules: &[Rule], known: &[Hedge]) -> Result<Self> {
        let mut asked = Vec::new();
        for (rule, conclusion) in
            rules.iter().enumerate().flat_map(|(i, r)| r.conclusions.iter().map(move |c| (i, c)))
        {
            let Consequent::Term { hedges, term } = &conclusion.value else { continue };
            if conclusion.output != output.name() {
                continue;
            }
            let term = output.position(term)?;
            let hedges = hedges
                .iter()
                .map(|name| Ok(known[find_hedge(known, name)?].clone()))
                .collect::<Result<Vec<Hedge>>>()?;
            let sampled = matches!(output.method(), Method::Mamdani { defuzzifier, sampling, .. }
                if *defuzzifier != Defuzzifier::Height && *sampling != Sampling::Exact);
            if !hedges.is_empty() && !sampled {
                let reason = "hedges in a conclusion need a Mamdani output with samples; put them \
                              before the antecedent, or use another term";
                let what = format!("rule {}'s conclusion about \"{}\"", rule + 1, output.name());
                return Err(Error::Unsuitable { what, reason: reason.to_owned() });
            }
            asked.push((rule, term, hedges));
        }
        check::at_least(&format!("rules about \"{}\"", output.name()), asked.len(), 1)?;
        Ok(Self(asked))
    }

    fn plan(
        &self,
        output: &Output,
        slots: &[TermSlot],
        mut first: usize,
        inputs: usize,
    ) -> Result<OutputPlan> {
        let universe = output
            .variable()
            .map_or((0.0, 0.0), |variable| (variable.universe().low(), variable.universe().high()));
        let weighted = |terms: Vec<Term>, aggregation, weighting| {
            let conclusions = self.0.iter().map(|&(rule, term, _)| (rule, term)).collect();
            OutputPlan::Weighted(Weighted::new(terms, conclusions, (aggregation, weighting)))
        };
        Ok(match output.method() {
            Method::Mamdani { defuzzifier: Defuzzifier::Height, .. } => {
                let centre = |&slot: &TermSlot| Term::Centre(slot, universe);
                let terms = slots.iter().map(centre).collect();
                weighted(terms, Aggregation::Sum, Weighting::Average)
            }
            Method::Mamdani { implication, sampling: Sampling::Exact, aggregation, .. } => {
                let conclusions = self.conclusions(slots, *aggregation);
                OutputPlan::Exact(Exact { conclusions, implication: *implication, universe })
            }
            Method::Mamdani { variable, implication, aggregation, defuzzifier, sampling } => {
                let conclusions = self.conclusions(slots, *aggregation);
                OutputPlan::Sampled(Sampled {
                    conclusions,
                    implication: *implication,
                    aggregation: *aggregation,
                    defuzzifier: *defuzzifier,
                    samples: sampling.points(variable),
                })
            }
            Method::Sugeno { terms, aggregation, weighting } => {
                for (term, value) in terms {
                    if let Value::Linear(coefficients) = value {
                        let what = format!("coefficients of \"{term}\" of \"{}\"", output.name());
                        check::same_length(&what, inputs + 1, coefficients.len())?;
                    }
                }
                let mut place = |value: &Value| {
                    let own = first;
                    first += value.parameters().len();
                    match value {
                        Value::Constant(_) => Term::Constant(own),
                        Value::Linear(_) => Term::Linear(own, inputs),
                        Value::Formula(formula) => Term::Formula(formula.clone()),
                    }
                };
                let terms = terms.iter().map(|(_, value)| place(value)).collect();
                weighted(terms, *aggregation, *weighting)
            }
            Method::Tsukamoto { weighting, .. } => {
                let terms = slots.iter().map(|&slot| Term::Inverse(slot)).collect();
                weighted(terms, Aggregation::Sum, *weighting)
            }
        })
    }

    /// The concluded sets. Under max, rules that conclude one set count as their strongest,
    /// since every implication grows with the strength; otherwise each rule has a set of its own.
    fn conclusions(&self, slots: &[TermSlot], aggregation: Aggregation) -> Vec<Conclusion> {
        let mut conclusions: Vec<Conclusion> = Vec::new();
        for (rule, term, hedges) in &self.0 {
            let same = |c: &&mut Conclusion| {
                aggregation == Aggregation::Norm(SNorm::Max)
                    && c.term == slots[*term]
                    && c.hedges == *hedges
            };
            match conclusions.iter_mut().find(same) {
                Some(conclusion) => conclusion.rules.push(*rule),
                None => conclusions.push(Conclusion {
                    term: slots[*term],
                    hedges: hedges.clone(),
                    rules: vec![*rule],
                }),
            }
        }
        conclusions
    }
}
