//! What learners that fit consequents and premises apart need of a system.

use super::jacobian::{Slopes, Tangent};
use super::{Answer, ConsequentSlot, Inference, Kernel, System, Tsk};
use crate::error::{Error, Result};
use crate::math::{Numbers, Real};

/// A system whose outputs are linear in what its rules conclude, so that the consequents can be
/// found by least squares and the premises (the parameters of the inputs' terms, which stand
/// first in the flat vector) by their gradient.
///
/// Every output is f(x) = f₀(x) + Σᵢ sᵢ(x)·zᵢ(x) over its conclusions, with the *share* sᵢ (the
/// firing strengths of the rules that conclude it, over the sum of all of them if the output is an
/// average) and zᵢ a constant or a linear function of the inputs plus a constant. f₀ is what
/// rules conclude that has no parameters.
pub trait Adaptive: Inference {
    /// Working space for derivatives, with the numbers that they are made from.
    type Premise<R: Real>;

    /// Where the conclusions of each output stand in the flat vector; an error if an output has
    /// none that it is linear in.
    fn consequent_slots(&self) -> Result<Vec<Vec<ConsequentSlot>>>;

    /// Prepares other parameters of the same number in place.
    fn prepare_again(&self, parameters: &[f64], prepared: &mut Self::Prepared<f64>) {
        *prepared = self.prepare(parameters);
    }

    /// The same where only premise parameters have changed.
    fn prepare_premise_again(&self, parameters: &[f64], prepared: &mut Self::Prepared<f64>) {
        self.prepare_again(parameters, prepared);
    }

    /// Writes the shares of the conclusions at an admitted point, output by output, and into
    /// `rest` what each output is without them: f₀ and the strength of its rules. `scratch` is as
    /// long as for [`infer`](Inference::infer).
    fn shares<R: Real>(
        &self,
        prepared: &Self::Prepared<f64>,
        x: &[R],
        scratch: &mut [R],
        shares: &mut [R],
        rest: &mut [Answer<R>],
    );

    /// Working space for derivatives under the parameters that the system was made with.
    fn premise<R: Real>(&self) -> Self::Premise<R>
    where
        [Slopes]: Numbers<Slopes<R>>,
        Slopes<R>: Kernel<Slopes>;

    /// Takes another parameter vector for derivatives.
    fn set_premise<R: Real>(&self, premise: &mut Self::Premise<R>, parameters: &[f64])
    where
        [Slopes]: Numbers<Slopes<R>>,
        Slopes<R>: Kernel<Slopes>;

    /// Writes the derivatives of every output to the premise parameters at an admitted point,
    /// output by output, zero where no rule fires; and the outputs. `parameters` are those that
    /// were prepared and [set](Self::set_premise).
    fn differentiate<R: Kernel<f64>>(
        &self,
        parameters: &[f64],
        prepared: &Self::Prepared<f64>,
        premise: &mut Self::Premise<R>,
        x: &[R],
        answers: &mut [Answer<R>],
        derivatives: &mut [R],
    ) where
        [Slopes]: Numbers<Slopes<R>>,
        Slopes<R>: Kernel<Slopes>;

    /// The number of premise parameters.
    fn premise_count(&self) -> usize {
        self.interface().inputs().iter().map(|input| input.parameter_count()).sum()
    }
}

impl Adaptive for Tsk {
    type Premise<R: Real> = Vec<R>;

    fn consequent_slots(&self) -> Result<Vec<Vec<ConsequentSlot>>> {
        let (first, count) = (self.grid().first_consequent(), self.grid().consequent_size());
        let slot = |rule| ConsequentSlot { place: first + rule * count, count };
        Ok(vec![(0..self.grid().rules()).map(slot).collect()])
    }

    fn prepare_again(&self, parameters: &[f64], prepared: &mut Vec<f64>) {
        self.grid().prepare(parameters, prepared);
    }

    fn prepare_premise_again(&self, parameters: &[f64], prepared: &mut Vec<f64>) {
        self.grid().prepare_terms(parameters, prepared);
    }

    fn shares<R: Real>(
        &self,
        prepared: &Vec<f64>,
        x: &[R],
        scratch: &mut [R],
        shares: &mut [R],
        rest: &mut [Answer<R>],
    ) {
        let strength = self.grid().shares(prepared.as_slice(), x, scratch, shares);
        rest[0] = Answer { value: R::splat(0.0), strength };
    }

    fn premise<R: Real>(&self) -> Vec<R>
    where
        [Slopes]: Numbers<Slopes<R>>,
        Slopes<R>: Kernel<Slopes>,
    {
        vec![R::splat(0.0); self.grid().gradient_scratch_count()]
    }

    fn set_premise<R: Real>(&self, _premise: &mut Vec<R>, _parameters: &[f64])
    where
        [Slopes]: Numbers<Slopes<R>>,
        Slopes<R>: Kernel<Slopes>,
    {
        // The gradient reads the parameters themselves.
    }

    fn differentiate<R: Kernel<f64>>(
        &self,
        parameters: &[f64],
        prepared: &Vec<f64>,
        scratch: &mut Vec<R>,
        x: &[R],
        answers: &mut [Answer<R>],
        derivatives: &mut [R],
    ) where
        [Slopes]: Numbers<Slopes<R>>,
        Slopes<R>: Kernel<Slopes>,
    {
        let prepared = prepared.as_slice();
        let fired = self.grid().premise_gradient(parameters, prepared, x, scratch, derivatives);
        answers[0] = self.answer(fired);
    }
}

impl Adaptive for System {
    type Premise<R: Real> = (Tangent<Self, R>, Vec<R>);

    fn consequent_slots(&self) -> Result<Vec<Vec<ConsequentSlot>>> {
        let outputs = self.outputs().iter().zip(self.plan().consequent_slots());
        let slots = outputs.map(|(output, slots)| {
            slots.ok_or_else(|| Error::Unsuitable {
                what: format!("output \"{}\"", output.name()),
                reason: "consequents are fitted by least squares where rules conclude constants \
                         or linear functions (a Sugeno output)"
                    .to_owned(),
            })
        });
        slots.collect()
    }

    fn shares<R: Real>(
        &self,
        prepared: &Self::Prepared<f64>,
        x: &[R],
        scratch: &mut [R],
        shares: &mut [R],
        rest: &mut [Answer<R>],
    ) {
        self.plan().shares(prepared, x, scratch, shares, rest);
    }

    fn premise<R: Real>(&self) -> Self::Premise<R>
    where
        [Slopes]: Numbers<Slopes<R>>,
        Slopes<R>: Kernel<Slopes>,
    {
        let scratch = vec![R::splat(0.0); self.scratch_count()];
        (Tangent::new(self, self.premise_count()), scratch)
    }

    fn set_premise<R: Real>(&self, (tangent, _): &mut Self::Premise<R>, parameters: &[f64])
    where
        [Slopes]: Numbers<Slopes<R>>,
        Slopes<R>: Kernel<Slopes>,
    {
        tangent.set(self, parameters);
    }

    fn differentiate<R: Kernel<f64>>(
        &self,
        _parameters: &[f64],
        prepared: &Self::Prepared<f64>,
        (tangent, scratch): &mut Self::Premise<R>,
        x: &[R],
        answers: &mut [Answer<R>],
        derivatives: &mut [R],
    ) where
        [Slopes]: Numbers<Slopes<R>>,
        Slopes<R>: Kernel<Slopes>,
    {
        tangent.differentiate(self, x, derivatives);
        self.infer::<f64, R>(prepared, x, scratch, answers);
    }
}
