//! Learning from one sample after the other.

use super::consequents::write_regressors;
use crate::check;
use crate::error::Result;
use crate::inference::{Adaptive, Answer, ConsequentSlot, Interface};
use crate::learn::recursive::RecursiveLeastSquares;

/// A system whose consequents follow a stream of samples by recursive least squares, its premises
/// staying as they are.
///
/// ```
/// use fuzzy_core::learn::anfis::Online;
/// use fuzzy_core::{Order, Shape, Tsk, Variable};
///
/// let x = Variable::evenly("x", (0.0, 1.0), Shape::Gaussian, &["low", "high"])?;
/// let system = Tsk::new("line", vec![x], Order::One, vec![0.0; 4])?;
/// let mut online = Online::new(&system, 1.0, 1e6)?;
/// for step in 0..50 {
///     let x = f64::from(step % 11) / 10.0;
///     online.learn(&[x], &[3.0 * x - 1.0])?;
/// }
/// assert!((online.system()?.evaluate(&[0.25])? + 0.25).abs() < 1e-4);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Online<S: Adaptive> {
    system: S,
    slots: Vec<Vec<ConsequentSlot>>,
    filters: Vec<RecursiveLeastSquares>,
    shares: Vec<f64>,
    rest: Vec<Answer<f64>>,
    scratch: Vec<f64>,
    row: Vec<f64>,
}

impl<S: Adaptive> Online<S> {
    /// Begins from the system's consequents; the forgetting factor and the initial covariance are
    /// those of [`RecursiveLeastSquares`], one for each output.
    pub fn new(system: &S, forgetting: f64, covariance: f64) -> Result<Self> {
        let slots = system.consequent_slots()?;
        let mut filters = Vec::with_capacity(slots.len());
        for slots in &slots {
            let own: Vec<f64> = slots
                .iter()
                .flat_map(|s| &system.parameters()[s.place..][..s.count])
                .copied()
                .collect();
            let filter = RecursiveLeastSquares::new(own.len(), 1, forgetting, covariance)?;
            filters.push(filter.starting_from(&own)?);
        }
        let count = slots.iter().map(Vec::len).sum();
        Ok(Self {
            system: system.clone(),
            rest: vec![Answer { value: 0.0, strength: 0.0 }; slots.len()],
            slots,
            filters,
            shares: vec![0.0; count],
            scratch: vec![0.0; system.scratch_count()],
            row: Vec::new(),
        })
    }

    /// The inputs and outputs of the system.
    pub fn interface(&self) -> &Interface {
        self.system.interface()
    }

    /// The filter of each output; its unknowns are the output's consequents in their order in the
    /// parameter vector.
    pub fn filters(&self) -> &[RecursiveLeastSquares] {
        &self.filters
    }

    /// The same with other covariances, one matrix for each output.
    pub fn with_covariances(mut self, covariances: &[Vec<f64>]) -> Result<Self> {
        check::same_length("covariances", self.filters.len(), covariances.len())?;
        let filters = self.filters.into_iter().zip(covariances);
        self.filters = filters.map(|(f, p)| f.with_covariance(p)).collect::<Result<_>>()?;
        Ok(self)
    }

    /// Takes one sample: a target for each output. Where no rule about an output fires, that
    /// output learns nothing.
    pub fn learn(&mut self, x: &[f64], targets: &[f64]) -> Result<()> {
        check::same_length("targets of the sample", self.filters.len(), targets.len())?;
        check::all_finite("targets of the sample", targets)?;
        let interface = self.system.interface();
        interface.check_point(x)?;
        let mut x = x.to_vec();
        interface.admit(&mut x);
        let (system, prepared) = (&self.system, self.system.prepared());
        system.shares(prepared, &x, &mut self.scratch, &mut self.shares, &mut self.rest);
        let mut shares = self.shares.as_slice();
        for ((filter, slots), (rest, target)) in
            self.filters.iter_mut().zip(&self.slots).zip(self.rest.iter().zip(targets))
        {
            let (own, others) = shares.split_at(slots.len());
            shares = others;
            if rest.strength == 0.0 {
                continue;
            }
            self.row.resize(filter.unknowns(), 0.0);
            let mut row = self.row.as_mut_slice();
            for (slot, &share) in slots.iter().zip(own) {
                let (part, others) = row.split_at_mut(slot.count);
                write_regressors(part, share, |k| x[k]);
                row = others;
            }
            filter.update(&self.row, &[target - rest.value])?;
        }
        Ok(())
    }

    /// The system with the consequents learned so far.
    pub fn system(&self) -> Result<S> {
        let mut parameters = self.system.parameters().to_vec();
        for (slots, filter) in self.slots.iter().zip(&self.filters) {
            let places = slots.iter().flat_map(|slot| slot.place..slot.place + slot.count);
            places.zip(filter.solution()).for_each(|(place, &value)| parameters[place] = value);
        }
        self.system.with_parameters(&parameters)
    }
}
