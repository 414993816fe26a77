//! A fuzzy system under tuning: the actor's, and the fuzzy critic's.

use serde::{Deserialize, Serialize};

use super::settings::Tune;
use super::steps::{Traced, TracedState};
use crate::error::{Error, Result};
use crate::inference::{Inference, NoRuleFires, Outside, Tsk};
use crate::membership::Constraints;

/// A [`Tsk`] whose parameters follow their traces.
///
/// Where no rule fires its output is the number that the system gives there, or 0, and all
/// derivatives are 0.
#[derive(Debug, Clone)]
pub(super) struct Tuned {
    system: Tsk,
    tune: Tune,
    constraints: Constraints,
    traced: Traced,
    prepared: Vec<f64>,
    /// What is output where no rule fires.
    fallback: f64,
    /// For a point within the universes, where the system asks for that.
    admitted: Vec<f64>,
    scratch: Vec<f64>,
    derivatives: Vec<f64>,
    proposed_held: usize,
    held: u64,
}

/// Where a [`Tuned`] stands.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TunedState {
    learned: TracedState,
    held: u64,
}

impl Tuned {
    /// Tuning that begins from the system's parameters; `narrowest` is the least width of a
    /// membership function as a share of its universe.
    pub fn new(system: &Tsk, tune: Tune, narrowest: f64) -> Result<Self> {
        if system.interface().outside() == Outside::Error {
            return Err(Error::Unsuitable {
                what: format!("\"{}\"", system.name()),
                reason: "it refuses inputs outside their universes, which exploration may lead \
                         to; let it keep or clamp them"
                    .to_owned(),
            });
        }
        let fallback = match system.no_rule_fires() {
            NoRuleFires::Value(value) => value,
            NoRuleFires::Error | NoRuleFires::Nan | NoRuleFires::Previous => 0.0,
        };
        let (grid, parameters) = (system.grid(), system.parameters().to_vec());
        Ok(Self {
            tune,
            constraints: Constraints::within_bounds(system.inputs(), narrowest),
            prepared: system.prepared().clone(),
            fallback,
            admitted: vec![0.0; grid.inputs()],
            scratch: vec![0.0; grid.gradient_scratch_count()],
            derivatives: vec![0.0; parameters.len()],
            traced: Traced::new(parameters),
            proposed_held: 0,
            held: 0,
            system: system.clone(),
        })
    }

    /// The system as it was before anything was learned.
    pub fn initial(&self) -> &Tsk {
        &self.system
    }

    /// What has been learned since.
    pub fn state(&self) -> TunedState {
        TunedState { learned: self.traced.state(), held: self.held }
    }

    /// The same with what was learned before.
    pub fn restored(mut self, saved: TunedState) -> Result<Self> {
        self.traced = self.traced.restored(saved.learned)?;
        // What a system would refuse as its parameters is no state of learning.
        self.prepared.clone_from(self.system()?.prepared());
        self.held = saved.held;
        Ok(self)
    }

    /// The system with the parameters learned so far.
    pub fn system(&self) -> Result<Tsk> {
        self.system.with_parameters(self.traced.values())
    }

    /// The number of inputs.
    pub fn inputs(&self) -> usize {
        self.admitted.len()
    }

    /// How often a parameter was kept from leaving its bounds, or parameters from their order.
    pub fn held(&self) -> u64 {
        self.held
    }

    /// The output at a point.
    #[inline]
    pub fn value(&mut self, observation: &[f64]) -> f64 {
        let x = admit(&self.system, observation, &mut self.admitted);
        let prepared = self.prepared.as_slice();
        self.system.grid().infer(prepared, x, &mut self.scratch).average(self.fallback)
    }

    /// The same, keeping the derivatives to the tuned parameters for the next step.
    #[inline]
    pub fn differentiate(&mut self, observation: &[f64]) -> f64 {
        let x = admit(&self.system, observation, &mut self.admitted);
        let (grid, prepared) = (self.system.grid(), self.prepared.as_slice());
        let (scratch, derivatives) = (&mut self.scratch, &mut self.derivatives);
        let fired = match self.tune {
            Tune::All => grid.gradient(self.traced.values(), prepared, x, scratch, derivatives),
            Tune::Consequents => grid.consequent_gradient(prepared, x, scratch, derivatives),
        };
        fired.average(self.fallback)
    }

    /// [`Traced::propose`] along the derivatives last kept; parameters of membership functions
    /// are then brought back to valid ones.
    #[inline]
    pub fn propose(&mut self, decay: f64, gain: f64, step: f64) -> Result<(), f64> {
        self.traced.propose(decay, gain, &self.derivatives, step)?;
        if self.tune == Tune::All {
            let terms = &mut self.traced.proposed()[..self.system.grid().first_consequent()];
            self.proposed_held = self.constraints.apply(terms);
        }
        Ok(())
    }

    /// Takes the proposed step.
    #[inline]
    pub fn accept(&mut self) {
        self.traced.accept();
        self.held += self.proposed_held as u64;
        let (grid, values) = (self.system.grid(), self.traced.values());
        match self.tune {
            Tune::All => grid.prepare(values, &mut self.prepared),
            Tune::Consequents => grid.prepare_consequents(values, &mut self.prepared),
        }
    }

    /// Ends all traces.
    pub fn clear_traces(&mut self) {
        self.traced.clear_traces();
    }
}

/// The point that a system takes: the observation, or the nearest one within the universes.
#[inline(always)]
fn admit<'a>(system: &Tsk, observation: &'a [f64], admitted: &'a mut [f64]) -> &'a [f64] {
    if system.interface().outside() == Outside::Keep {
        return observation;
    }
    admitted.copy_from_slice(observation);
    system.interface().admit(admitted);
    admitted
}
