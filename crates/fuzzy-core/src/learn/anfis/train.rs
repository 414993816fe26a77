//! Training: epochs of least squares and premise steps, of which the best is kept.

use super::consequents::{ConsequentFit, LeastSquares};
use super::premise::{BatchPass, PremiseStep, StepLength, Sweep};
use crate::check;
use crate::control::Control;
use crate::error::{Error, Result};
use crate::inference::Adaptive;
use crate::learn::data::DataSet;
use crate::learn::least_squares::{add_multiple, dot};
use crate::membership::Constraints;

/// How [`fit`] trains.
///
/// | Name | Meaning | Range | Default |
/// |---|---|---|---|
/// | epochs | the most epochs | ≥ 1 | 100 |
/// | consequents | how they are fitted; `None` keeps them | ridge ≥ 0 | no ridge, Cholesky |
/// | premise | how the premises move | rates > 0 | normalised, as in MATLAB |
/// | patience | epochs without a new best error after which training ends | ≥ 1 | none |
/// | seed | of the order of samples, where it is shuffled | | 0 |
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AnfisSettings {
    /// The most epochs.
    pub epochs: u32,
    /// How consequents are fitted in each epoch; `None` keeps them as they are.
    pub consequents: Option<LeastSquares>,
    /// How premises move after each epoch but the last.
    pub premise: PremiseStep,
    /// Training ends after so many epochs without a new best error: of the validation samples if
    /// there are some, of the training samples otherwise.
    pub patience: Option<u32>,
    /// The seed of the order of samples, where it is shuffled.
    pub seed: u64,
}

impl Default for AnfisSettings {
    fn default() -> Self {
        Self {
            epochs: 100,
            consequents: Some(LeastSquares::default()),
            premise: PremiseStep::default(),
            patience: None,
            seed: 0,
        }
    }
}

/// How training went; one number for each epoch.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct History {
    /// The root mean squared error of the training samples, after the consequents were fitted.
    pub training: Vec<f64>,
    /// The same of the validation samples; empty if there are none.
    pub validation: Vec<f64>,
    /// The step length or learning rate with which the premises then moved.
    pub step: Vec<f64>,
}

/// Why training ended.
#[derive(Debug, Clone, PartialEq)]
pub enum Stop {
    /// All epochs are done.
    Epochs,
    /// The error had no new best for as long as the patience lasts.
    Patience,
    /// There is nothing to move: the premises are fixed.
    Fixed,
    /// The caller asked for it.
    Cancelled,
    /// A step led to where there is no error to compare, for this reason. Smaller steps may help.
    Diverged(Error),
}

impl Stop {
    /// The name that bindings use.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Epochs => "epochs",
            Self::Patience => "patience",
            Self::Fixed => "fixed",
            Self::Cancelled => "cancelled",
            Self::Diverged(_) => "diverged",
        }
    }
}

/// The result of [`fit`].
#[derive(Debug, Clone)]
pub struct Trained<S> {
    /// The system of the best epoch.
    pub system: S,
    /// The errors and steps of all epochs.
    pub history: History,
    /// The number of the best epoch, from 0.
    pub best_epoch: usize,
    /// Why training ended.
    pub stopped: Stop,
}

/// Fits a system to samples: its consequents by least squares, its premises by their gradient.
///
/// Each epoch fits the consequents, takes the errors of the training and the validation samples,
/// and then moves the premises. The result is the system of the epoch with the least error, of
/// the validation samples if there are some; it is kept also if training is cancelled after its
/// first epoch or a later step diverges, which is no error: [`Trained::stopped`] says so.
///
/// Fewer samples than unknowns have many solutions: with a ridge the one that it picks is taken,
/// without one that of least norm. Inputs outside their universe are treated as the system does.
/// A sample at which no rule fires is an error, unless the system has a value for that, which
/// then counts as the output there.
///
/// ```
/// use fuzzy_core::learn::anfis::{AnfisSettings, fit};
/// use fuzzy_core::learn::data::DataSet;
/// use fuzzy_core::{Control, Order, Shape, Tsk, Variable};
///
/// let x = Variable::evenly("x", (0.0, 3.0), Shape::Bell, &["low", "middle", "high"])?;
/// let system = Tsk::new("curve", vec![x], Order::One, vec![0.0; 6])?;
/// let points: Vec<f64> = (0..31).map(|i| 0.1 * f64::from(i)).collect();
/// let targets: Vec<f64> = points.iter().map(|x| x * (3.0 - x)).collect();
/// let data = DataSet::new(1, &points, &targets)?;
/// let trained = fit(&system, &data, None, &AnfisSettings::default(), &Control::new())?;
/// assert!((trained.system.evaluate(&[1.5])? - 2.25).abs() < 0.01);
/// # Ok::<(), fuzzy_core::Error>(())
/// ```
pub fn fit<S: Adaptive>(
    system: &S,
    data: &DataSet,
    validation: Option<&DataSet>,
    settings: &AnfisSettings,
    control: &Control,
) -> Result<Trained<S>> {
    Training::new(system, data, validation, settings)?.run(control)
}

/// A parameter vector on its way.
pub(super) struct Fitted<S: Adaptive> {
    pub parameters: Vec<f64>,
    pub prepared: S::Prepared<f64>,
    premise_count: usize,
    constraints: Constraints,
}

impl<S: Adaptive> Fitted<S> {
    pub fn new(system: &S) -> Self {
        Self {
            parameters: system.parameters().to_vec(),
            prepared: system.prepare(system.parameters()),
            premise_count: system.premise_count(),
            constraints: Constraints::new(system.interface().inputs()),
        }
    }

    pub fn premise_count(&self) -> usize {
        self.premise_count
    }

    /// Moves the premises; [`settle`](Self::settle) must follow.
    pub fn add_to_premise(&mut self, factor: f64, direction: &[f64]) {
        add_multiple(&mut self.parameters[..self.premise_count], factor, direction);
    }

    /// Brings moved premises back to valid ones.
    pub fn settle(&mut self, system: &S) -> Result<()> {
        let premise = &mut self.parameters[..self.premise_count];
        self.constraints.apply(premise);
        check::all_finite("premise parameters", premise)?;
        system.prepare_premise_again(&self.parameters, &mut self.prepared);
        Ok(())
    }
}

/// The best epoch so far.
struct Best {
    parameters: Vec<f64>,
    error: f64,
    epoch: usize,
}

/// A training at work.
struct Training<'a, S: Adaptive> {
    system: &'a S,
    settings: &'a AnfisSettings,
    data: DataSet,
    validation: Option<DataSet>,
    fitted: Fitted<S>,
    consequents: Option<ConsequentFit>,
    pass: BatchPass<S>,
    sweep: Option<Sweep<S>>,
    step: StepLength,
    gradient: Vec<f64>,
    history: History,
    best: Option<Best>,
}

impl<'a, S: Adaptive> Training<'a, S> {
    fn new(
        system: &'a S,
        data: &DataSet,
        validation: Option<&DataSet>,
        settings: &'a AnfisSettings,
    ) -> Result<Self> {
        check::at_least("epochs", settings.epochs as usize, 1)?;
        if let Some(patience) = settings.patience {
            check::at_least("patience", patience as usize, 1)?;
        }
        settings.premise.check()?;
        if let Some(consequents) = settings.consequents {
            consequents.check()?;
        }
        let data = data.admitted(system)?;
        let validation = validation
            .map(|data| data.admitted(system).map_err(|error| error.at("validation".to_owned())))
            .transpose()?;
        let consequents = settings.consequents.map(|how| ConsequentFit::new(system, how));
        let (step, sweep) = match settings.premise {
            PremiseStep::Fixed => (0.0, None),
            PremiseStep::Batch { rate } => (rate, None),
            PremiseStep::Sequential { rate, .. } => {
                (rate, Some(Sweep::new(system, &data, settings.seed)))
            }
            PremiseStep::Normalised { step, .. } => (step, None),
        };
        Ok(Self {
            system,
            settings,
            fitted: Fitted::new(system),
            consequents: consequents.transpose()?,
            pass: BatchPass::new(system),
            sweep,
            step: StepLength::new(step),
            gradient: vec![0.0; system.premise_count()],
            history: History::default(),
            best: None,
            data,
            validation,
        })
    }

    fn run(mut self, control: &Control) -> Result<Trained<S>> {
        let stopped = loop {
            match self.epoch(control) {
                Ok(None) => {}
                Ok(Some(stop)) => break stop,
                // Nothing is there to keep.
                Err(error) if self.best.is_none() => return Err(error),
                Err(Error::Cancelled) => break Stop::Cancelled,
                Err(error) => break Stop::Diverged(error),
            }
        };
        let (parameters, best_epoch) = match self.best {
            Some(best) => (best.parameters, best.epoch),
            None => (self.fitted.parameters, 0),
        };
        let system = self.system.with_parameters(&parameters)?;
        Ok(Trained { system, history: self.history, best_epoch, stopped })
    }

    /// One epoch; says if it was the last.
    fn epoch(&mut self, control: &Control) -> Result<Option<Stop>> {
        let system = self.system;
        if let Some(consequents) = &mut self.consequents {
            let Fitted { parameters, prepared, .. } = &mut self.fitted;
            consequents.solve(system, prepared, &self.data, parameters, control)?;
            system.prepare_again(parameters, prepared);
        }
        let error = match self.settings.premise.takes_gradient() {
            true => self.pass.error_and_gradient(
                system,
                &self.fitted,
                &self.data,
                &mut self.gradient,
                control,
            )?,
            false => self.pass.error(system, &self.fitted.prepared, &self.data, control)?,
        };
        let judged = match &self.validation {
            Some(data) => self.pass.error(system, &self.fitted.prepared, data, control)?,
            None => error,
        };
        self.keep_if_best(judged)?;
        self.history.training.push(error);
        self.history.validation.extend(self.validation.is_some().then_some(judged));
        self.history.step.push(self.step.get());
        control.advance(1)?;
        let waited =
            self.best.as_ref().map_or(0, |best| self.history.training.len() - 1 - best.epoch);
        if self.settings.premise == PremiseStep::Fixed {
            return Ok(Some(Stop::Fixed));
        }
        if self.history.training.len() >= self.settings.epochs as usize {
            return Ok(Some(Stop::Epochs));
        }
        if self.settings.patience.is_some_and(|patience| waited >= patience as usize) {
            return Ok(Some(Stop::Patience));
        }
        self.move_premise(control)?;
        Ok(None)
    }

    /// Keeps the parameters if their error is the least so far; an error if it is no number.
    fn keep_if_best(&mut self, error: f64) -> Result<()> {
        check::finite("root mean squared error", error)?;
        if !self.system.accepts(&self.fitted.parameters) {
            // Making the system says what is wrong.
            self.system.with_parameters(&self.fitted.parameters)?;
        }
        if self.best.as_ref().is_none_or(|best| error < best.error) {
            let (parameters, epoch) = (self.fitted.parameters.clone(), self.history.training.len());
            self.best = Some(Best { parameters, error, epoch });
        }
        Ok(())
    }

    fn move_premise(&mut self, control: &Control) -> Result<()> {
        let system = self.system;
        match self.settings.premise {
            PremiseStep::Fixed => return Ok(()),
            PremiseStep::Batch { rate } => self.fitted.add_to_premise(-rate, &self.gradient),
            PremiseStep::Normalised { increase, decrease, .. } => {
                let norm = dot(&self.gradient, &self.gradient).sqrt();
                if norm > 0.0 {
                    self.fitted.add_to_premise(-self.step.get() / norm, &self.gradient);
                }
                self.step.follow(&self.history.training, increase, decrease);
            }
            PremiseStep::Sequential { rate, order } => {
                return match &mut self.sweep {
                    Some(sweep) => sweep.run(system, &mut self.fitted, rate, order, control),
                    None => Ok(()),
                };
            }
        }
        self.fitted.settle(system)
    }
}
