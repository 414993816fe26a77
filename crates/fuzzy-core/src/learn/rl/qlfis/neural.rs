//! A neural network as critic, after Dai et al. as section 7.3.1 uses it.

use serde::{Deserialize, Serialize};

use super::critic::Critic;
use super::steps::{Traced, TracedState};
use crate::check;
use crate::error::{Error, Result};
use crate::math::{LANES, Lanes, Real, exp};
use crate::rng::Rng;

/// A network with one hidden layer of tanh and a linear output: Q = b + Σₕ vₕ tanh(cₕ + Σᵢ wᵢₕxᵢ).
///
/// Its inputs x are the observation and the action, both as they were one step before (in the
/// first step of an episode: as they are), and the constant 1. Two observations and one action
/// make 7 inputs; with 21 hidden units the weights are 190.
#[derive(Debug, Clone)]
pub struct NeuralCritic {
    observations: usize,
    hidden: usize,
    /// w input by input, then c, v and b.
    weights: Traced,
    /// The inputs of the network.
    x: Vec<f64>,
    /// Whether the second half of the inputs is there.
    has_before: bool,
    next_x: Vec<f64>,
    activations: Vec<f64>,
    derivatives: Vec<f64>,
}

/// Where a [`NeuralCritic`] stands.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NetworkState {
    learned: TracedState,
    before: Option<Vec<f64>>,
}

impl NeuralCritic {
    /// A network for so many observations and actions, whose weights are drawn evenly from −0.1
    /// to 0.1.
    pub fn new(observations: usize, actions: usize, hidden: usize, rng: &mut Rng) -> Result<Self> {
        check::at_least("observations of the critic", observations, 1)?;
        check::at_least("actions of the critic", actions, 1)?;
        check::at_least("hidden units of the critic", hidden, 1)?;
        let too_many = || Error::wrong_shape("units of the critic", "a countable number", "more");
        let inputs = observations.checked_add(actions).and_then(|now| now.checked_mul(2));
        let inputs = inputs.and_then(|inputs| inputs.checked_add(1)).ok_or_else(too_many)?;
        let rows = inputs.checked_add(2).ok_or_else(too_many)?;
        let mut weights = check::zeros("the critic", rows, hidden)?;
        weights.push(0.0);
        weights.iter_mut().for_each(|weight| *weight = rng.uniform_in(-0.1, 0.1));
        let mut x = vec![0.0; inputs];
        x[inputs - 1] = 1.0;
        Ok(Self {
            observations,
            hidden,
            derivatives: vec![0.0; weights.len()],
            activations: vec![0.0; hidden],
            weights: Traced::new(weights),
            next_x: x.clone(),
            x,
            has_before: false,
        })
    }

    /// The numbers of observations, actions and hidden units.
    pub fn size(&self) -> (usize, usize, usize) {
        (self.observations, self.half() - self.observations, self.hidden)
    }

    /// The weights: input by input those to the hidden units, then these units' constants, their
    /// weights in the output, and its constant.
    pub fn weights(&self) -> &[f64] {
        self.weights.values()
    }

    /// Its weights, and the observation and action of the step before.
    pub(super) fn state(&self) -> NetworkState {
        let before = self.has_before.then(|| self.x[self.half()..2 * self.half()].to_vec());
        NetworkState { learned: self.weights.state(), before }
    }

    /// A network of this size that was saved.
    pub(super) fn restored(
        observations: usize,
        actions: usize,
        hidden: usize,
        saved: NetworkState,
    ) -> Result<Self> {
        // What is claimed takes no more memory than the document has.
        let fits = observations.checked_add(actions).and_then(|half| half.checked_mul(2));
        let fits = fits.and_then(|x| x.checked_add(3)?.checked_mul(hidden)?.checked_add(1));
        if fits != Some(saved.learned.count()) {
            let size = format!("{observations} observations, {actions} actions, {hidden} units");
            return Err(Error::wrong_shape("weights of the critic", size, saved.learned.count()));
        }
        let mut critic = Self::new(observations, actions, hidden, &mut Rng::new(0, 0))?;
        critic.weights = critic.weights.restored(saved.learned)?;
        if let Some(before) = saved.before {
            let half = critic.half();
            check::same_length("step before", half, before.len())?;
            check::all_finite("step before", &before)?;
            critic.x[half..2 * half].copy_from_slice(&before);
            critic.has_before = true;
        }
        Ok(critic)
    }

    /// The numbers of inputs that observation and action are.
    fn half(&self) -> usize {
        (self.x.len() - 1) / 2
    }

    /// The output; the activations of the hidden units are kept.
    #[inline]
    fn forward(weights: &[f64], x: &[f64], activations: &mut [f64]) -> f64 {
        let hidden = activations.len();
        let (rows, rest) = weights.split_at(x.len() * hidden);
        let (constants, rest) = rest.split_at(hidden);
        let (output, constant) = rest.split_at(hidden);
        activations.copy_from_slice(constants);
        for (&x, row) in x.iter().zip(rows.chunks_exact(hidden)) {
            for (activation, &weight) in activations.iter_mut().zip(row) {
                *activation = weight.mul_add(x, *activation);
            }
        }
        let (eights, rest) = activations.as_chunks_mut::<LANES>();
        let (weights, last) = output.as_chunks::<LANES>();
        let mut sums = Lanes::splat(0.0);
        for (activations, &weights) in eights.iter_mut().zip(weights) {
            let lanes = tanh(Lanes::new(*activations));
            *activations = lanes.to_array();
            sums = lanes.mul_add(Lanes::new(weights), sums);
        }
        let mut value = sums.to_array().into_iter().fold(constant[0], |sum, lane| sum + lane);
        for (activation, &weight) in rest.iter_mut().zip(last) {
            *activation = tanh(*activation);
            value = weight.mul_add(*activation, value);
        }
        value
    }
}

/// tanh x = 1 − 2/(e²ˣ + 1), right to 2⁻⁵² of its range.
#[inline(always)]
fn tanh<R: Real>(x: R) -> R {
    R::splat(1.0) - R::splat(2.0) / (exp(x + x) + R::splat(1.0))
}

impl Critic for NeuralCritic {
    const USES_ACTION: bool = true;

    fn inputs(&self) -> usize {
        self.observations
    }

    fn begin_episode(&mut self) {
        self.has_before = false;
    }

    fn differentiate(&mut self, observation: &[f64], action: &[f64]) -> f64 {
        let half = self.half();
        self.x[..self.observations].copy_from_slice(observation);
        self.x[self.observations..half].copy_from_slice(action);
        if !self.has_before {
            self.x.copy_within(..half, half);
        }
        let (weights, hidden) = (self.weights.values(), self.hidden);
        let value = Self::forward(weights, &self.x, &mut self.activations);
        // ∂Q/∂vₕ = tanhₕ and ∂Q/∂cₕ = vₕ(1 − tanhₕ²), which ∂Q/∂wᵢₕ has xᵢ times.
        let output = &weights[weights.len() - 1 - hidden..];
        let (rows, rest) = self.derivatives.split_at_mut(self.x.len() * hidden);
        let (constants, rest) = rest.split_at_mut(hidden);
        for ((slope, &t), &weight) in constants.iter_mut().zip(&self.activations).zip(output) {
            *slope = weight * (-t).mul_add(t, 1.0);
        }
        for (row, &x) in rows.chunks_exact_mut(hidden).zip(&self.x) {
            row.iter_mut().zip(&*constants).for_each(|(own, &slope)| *own = slope * x);
        }
        rest[..hidden].copy_from_slice(&self.activations);
        rest[hidden] = 1.0;
        value
    }

    fn ahead(&mut self, observation: &[f64], action: &[f64]) -> f64 {
        let half = self.half();
        self.next_x[..self.observations].copy_from_slice(observation);
        self.next_x[self.observations..half].copy_from_slice(action);
        self.next_x[half..2 * half].copy_from_slice(&self.x[..half]);
        Self::forward(self.weights.values(), &self.next_x, &mut self.activations)
    }

    #[inline]
    fn propose(&mut self, decay: f64, step: f64) -> Result<(), f64> {
        self.weights.propose(decay, 1.0, &self.derivatives, step)
    }

    fn accept(&mut self) {
        self.weights.accept();
        let half = self.half();
        self.x.copy_within(..half, half);
        self.has_before = true;
    }

    fn clear_traces(&mut self) {
        self.weights.clear_traces();
    }

    fn held(&self) -> u64 {
        0
    }
}
