//! Parameters that follow their eligibility traces.

use serde::{Deserialize, Serialize};

use crate::check;
use crate::error::Result;

/// Beyond this size numbers have left all use that a controller or a value could have.
pub(super) const LARGEST: f64 = 1e12;

/// Where a [`Traced`] stands.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TracedState {
    values: Vec<f64>,
    traces: Vec<f64>,
}

/// A parameter vector φ and its eligibility traces e, which step together (2.49, 7.12):
/// e ← d·e + g·∂, φ ← φ + s·e with the traces' decay d, the derivatives ∂ and their gain g, and
/// the step s.
///
/// A step is proposed first, so that nothing has changed if it turns out to be impossible.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Traced {
    values: Vec<f64>,
    traces: Vec<f64>,
    next_values: Vec<f64>,
    next_traces: Vec<f64>,
}

impl TracedState {
    /// The number of parameters.
    pub fn count(&self) -> usize {
        self.values.len()
    }
}

impl Traced {
    /// Parameters without traces.
    pub fn new(values: Vec<f64>) -> Self {
        let traces = vec![0.0; values.len()];
        Self { next_values: values.clone(), next_traces: traces.clone(), values, traces }
    }

    /// Parameters and traces as they were saved, as many as these.
    pub fn restored(&self, saved: TracedState) -> Result<Self> {
        let TracedState { values, traces } = saved;
        for (what, numbers) in [("learned parameters", &values), ("traces", &traces)] {
            check::same_length(what, self.values.len(), numbers.len())?;
            check::all_finite(what, numbers)?;
        }
        Ok(Self { traces, ..Self::new(values) })
    }

    /// Parameters and traces to be saved.
    pub fn state(&self) -> TracedState {
        TracedState { values: self.values.clone(), traces: self.traces.clone() }
    }

    /// The parameters.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Works out the next step. What cannot be is the error: the largest number of it.
    #[inline]
    pub fn propose(
        &mut self,
        decay: f64,
        gain: f64,
        derivatives: &[f64],
        step: f64,
    ) -> Result<(), f64> {
        let now = self.values.iter().zip(&self.traces).zip(derivatives);
        let next = self.next_values.iter_mut().zip(&mut self.next_traces);
        let mut sane = true;
        for ((next_value, next_trace), ((&value, &trace), &derivative)) in next.zip(now) {
            *next_trace = decay.mul_add(trace, gain * derivative);
            *next_value = step.mul_add(*next_trace, value);
            sane &= next_trace.abs() <= LARGEST && next_value.abs() <= LARGEST;
        }
        if sane { Ok(()) } else { Err(self.largest()) }
    }

    /// The largest of the proposed numbers; NaN if there is one.
    #[cold]
    fn largest(&self) -> f64 {
        let numbers = self.next_values.iter().chain(&self.next_traces);
        let larger = |a: f64, &b: &f64| if b.abs() <= a.abs() || a.is_nan() { a } else { b };
        numbers.fold(0.0, larger)
    }

    /// The proposed parameters, for corrections.
    pub fn proposed(&mut self) -> &mut [f64] {
        &mut self.next_values
    }

    /// Takes the proposed step.
    #[inline]
    pub fn accept(&mut self) {
        std::mem::swap(&mut self.values, &mut self.next_values);
        std::mem::swap(&mut self.traces, &mut self.next_traces);
    }

    /// Ends all traces.
    pub fn clear_traces(&mut self) {
        self.traces.fill(0.0);
    }
}
