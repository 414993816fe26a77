//! The arithmetic of a Takagi-Sugeno-Kang rule grid, over one point or eight.
//!
//! With the product as AND and every combination of terms a rule, the sums over rules factorise:
//! the total firing strength is ∏ᵢ Σⱼ μᵢⱼ, and the weighted sum of the consequents is a
//! contraction of their tensor with one vector of degrees after the other, μ₁ᵀ·C·μ₂ for two
//! inputs. Memberships are computed once for each input, never once for each rule.

use super::Order;
use super::layout::{Run, TermSlot};
use crate::math::{Numbers, Real};
use crate::membership::Shape;

/// The terms of one input, and how many rules apart two of its neighbours lie.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Axis {
    first: usize,
    count: usize,
    stride: usize,
}

/// The shape of a rule grid: which number stands where in the flat parameter vector.
///
/// The vector holds the parameters of every term, input by input, then the consequents, rule by
/// rule with the last input's term changing fastest; a rule has one constant (order 0) or the
/// coefficients of the inputs followed by a constant (order 1). Evaluation reads a *prepared*
/// vector, made once from the parameters by [`prepare`](Self::prepare).
///
/// This type checks nothing: [`Tsk`](super::Tsk) does, and learners that generate vectors keep
/// them within bounds themselves. Wrong lengths panic; crossed vertices give arbitrary numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct TskGrid {
    slots: Vec<TermSlot>,
    runs: Vec<Run>,
    axes: Vec<Axis>,
    order: Order,
    rules: usize,
    first_consequent: usize,
    first_prepared_consequent: usize,
}

/// What the rules say together.
#[derive(Debug, Clone, Copy)]
pub struct Fired<R> {
    /// The consequents weighted by the firing strengths, summed.
    pub weighted: R,
    /// The sum of the firing strengths.
    pub strength: R,
}

impl<R: Real> Fired<R> {
    /// The weighted average, or `fallback` where no rule fires.
    #[inline(always)]
    pub fn average(self, fallback: f64) -> R {
        let fires = R::splat(0.0).lt(self.strength);
        R::select(fires, self.weighted / self.strength, R::splat(fallback))
    }
}

impl TskGrid {
    /// The grid over inputs whose terms have these shapes with so many parameters; `None` if it
    /// has too many rules to count.
    pub fn new(inputs: &[Vec<(Shape, usize)>], order: Order) -> Option<Self> {
        let mut rules: usize = 1;
        for terms in inputs {
            rules = rules.checked_mul(terms.len())?;
        }
        let (mut slots, mut axes, mut owners) = (Vec::new(), Vec::new(), Vec::new());
        let (mut offset, mut prepared, mut stride) = (0, 0, rules);
        for (input, terms) in inputs.iter().enumerate() {
            stride /= terms.len().max(1);
            axes.push(Axis { first: slots.len(), count: terms.len(), stride });
            for &(shape, count) in terms {
                let slot = TermSlot { shape, offset, count };
                slots.push(slot);
                owners.push(input);
                offset += count;
                prepared += slot.prepared_count();
            }
        }
        let runs = Run::of_terms(owners.into_iter().zip(slots.iter().copied()));
        let grid = Self {
            slots,
            runs,
            axes,
            order,
            rules,
            first_consequent: offset,
            first_prepared_consequent: prepared,
        };
        rules.checked_mul(grid.consequent_size())?.checked_add(offset.max(prepared))?;
        Some(grid)
    }

    /// The number of rules.
    pub fn rules(&self) -> usize {
        self.rules
    }

    /// The number of inputs.
    pub fn inputs(&self) -> usize {
        self.axes.len()
    }

    /// The number of parameters of one rule's consequent.
    pub fn consequent_size(&self) -> usize {
        match self.order {
            Order::Zero => 1,
            Order::One => self.axes.len() + 1,
        }
    }

    /// Where the consequents begin in the parameter vector.
    pub fn first_consequent(&self) -> usize {
        self.first_consequent
    }

    /// The length of the parameter vector.
    pub fn parameter_count(&self) -> usize {
        self.first_consequent + self.rules * self.consequent_size()
    }

    /// The length of a prepared vector.
    pub fn prepared_count(&self) -> usize {
        self.first_prepared_consequent + self.rules * self.consequent_size()
    }

    /// The numbers of working space that [`infer`](Self::infer) needs.
    pub fn scratch_count(&self) -> usize {
        self.slots.len()
    }

    /// The numbers of working space that [`gradient`](Self::gradient) needs.
    pub fn gradient_scratch_count(&self) -> usize {
        let most = self.slots.iter().map(|slot| slot.count).max().unwrap_or(0);
        2 * self.slots.len() + most
    }

    /// Whether a vector of the right length has valid parameters for every term.
    pub fn is_valid(&self, parameters: &[f64]) -> bool {
        self.slots.iter().all(|slot| slot.accepts(parameters))
            && parameters[self.first_consequent..].iter().all(|value| value.is_finite())
    }

    /// Turns parameters into the form that evaluation reads.
    pub fn prepare<N: Real>(&self, parameters: &[N], prepared: &mut [N]) {
        self.prepare_terms(parameters, prepared);
        self.prepare_consequents(parameters, prepared);
    }

    /// [`prepare`](Self::prepare) of the consequents alone.
    pub fn prepare_consequents<N: Real>(&self, parameters: &[N], prepared: &mut [N]) {
        prepared[self.first_prepared_consequent..]
            .copy_from_slice(&parameters[self.first_consequent..]);
    }

    /// [`prepare`](Self::prepare) of the terms' parameters alone.
    pub(super) fn prepare_terms<N: Real>(&self, parameters: &[N], prepared: &mut [N]) {
        let mut rest = prepared;
        for slot in &self.slots {
            let (own, others) = rest.split_at_mut(slot.prepared_count());
            slot.prepare(parameters, own);
            rest = others;
        }
    }

    /// Fires every rule at the point `x`. `scratch` receives the degrees of the terms.
    #[inline]
    pub fn infer<R, P>(&self, prepared: &P, x: &[R], scratch: &mut [R]) -> Fired<R>
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let strength = self.fire(prepared, x, scratch);
        Fired { weighted: self.contract(prepared, x, scratch, 0, 0), strength }
    }

    /// Writes the degrees of the terms, and gives the sum of the firing strengths.
    #[inline(always)]
    fn fire<R, P>(&self, prepared: &P, x: &[R], degrees: &mut [R]) -> R
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        self.runs.iter().for_each(|run| run.write(prepared, x, degrees));
        let mut strength = R::splat(1.0);
        for axis in &self.axes {
            let degrees = &degrees[axis.first..][..axis.count];
            strength = strength * degrees.iter().fold(R::splat(0.0), |sum, &degree| sum + degree);
        }
        strength
    }

    /// The firing strength of each rule, the product of the degrees that
    /// [`infer`](Self::infer) left in `degrees`.
    pub(super) fn strengths<R: Real>(&self, degrees: &[R], strengths: &mut [R]) {
        // Axis by axis every product so far becomes those with each term, the last one first so
        // that none is overwritten before it is read.
        strengths[0] = R::splat(1.0);
        let mut count = 1;
        for axis in &self.axes {
            for index in (0..count).rev() {
                let product = strengths[index];
                for term in (0..axis.count).rev() {
                    strengths[index * axis.count + term] = product * degrees[axis.first + term];
                }
            }
            count *= axis.count;
        }
    }

    /// Writes the firing strengths over their sum, which is returned; zeros where no rule fires.
    pub(super) fn shares<R, P>(
        &self,
        prepared: &P,
        x: &[R],
        scratch: &mut [R],
        shares: &mut [R],
    ) -> R
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let strength = self.fire(prepared, x, scratch);
        self.strengths(scratch, shares);
        let scale = reciprocal(strength);
        shares.iter_mut().for_each(|share| *share = *share * scale);
        strength
    }

    /// Σ over the rules of the axes from `depth` on, beginning at `rule`: degree times consequent.
    fn contract<R, P>(&self, prepared: &P, x: &[R], degrees: &[R], depth: usize, rule: usize) -> R
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let (axis, below) = (self.axes[depth], depth + 1);
        let mut sum = R::splat(0.0);
        for (term, &degree) in degrees[axis.first..][..axis.count].iter().enumerate() {
            let rule = rule + term * axis.stride;
            // The last axis is contracted in place, so that two inputs need a single call.
            let inner = match self.axes.len() - below {
                0 => self.consequent(prepared, x, rule),
                1 => self.contract_last(prepared, x, degrees, rule),
                _ => self.contract(prepared, x, degrees, below, rule),
            };
            sum = degree.mul_add(inner, sum);
        }
        sum
    }

    /// [`contract`](Self::contract) for the last axis.
    #[inline(always)]
    fn contract_last<R, P>(&self, prepared: &P, x: &[R], degrees: &[R], rule: usize) -> R
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let last = self.axes[self.axes.len() - 1];
        let mut sum = R::splat(0.0);
        for (term, &degree) in degrees[last.first..][..last.count].iter().enumerate() {
            sum = degree.mul_add(self.consequent(prepared, x, rule + term), sum);
        }
        sum
    }

    /// What one rule concludes at the point `x`.
    #[inline(always)]
    pub(super) fn consequent<R, P>(&self, prepared: &P, x: &[R], rule: usize) -> R
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let first = self.first_prepared_consequent + rule * self.consequent_size();
        match self.order {
            Order::Zero => prepared.number(first),
            Order::One => {
                let mut value = prepared.number(first + x.len());
                for (k, &input) in x.iter().enumerate() {
                    value = input.mul_add(prepared.number(first + k), value);
                }
                value
            }
        }
    }

    /// Fires the rules, and writes the derivatives of the weighted average f to every parameter.
    ///
    /// With wᵣ the firing strength of rule r, W their sum and fᵣ its consequent,
    /// ∂f/∂Kᵣ = wᵣ/W (times the input for a coefficient), and for a parameter φ of a term with
    /// degree μ, ∂f/∂φ = Σᵣ (fᵣ − f)/W · (wᵣ/μ) · ∂μ/∂φ over the rules that use the term
    /// (2.25, 2.26; 7.7, 7.10, 7.11). wᵣ/μ is taken as the product of the other degrees, so it is
    /// right where μ is zero. All derivatives are zero where no rule fires.
    pub fn gradient<R, P>(
        &self,
        parameters: &P,
        prepared: &P,
        x: &[R],
        scratch: &mut [R],
        derivatives: &mut [R],
    ) -> Fired<R>
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let (premise, consequents) = derivatives.split_at_mut(self.first_consequent);
        let fired = self.premise_gradient(parameters, prepared, x, scratch, premise);
        self.consequent_shares(x, scratch, fired.strength, consequents);
        fired
    }

    /// [`gradient`](Self::gradient) to the consequents alone; `derivatives` and `scratch` may be
    /// as for all parameters, or `scratch` as for [`infer`](Self::infer).
    pub fn consequent_gradient<R, P>(
        &self,
        prepared: &P,
        x: &[R],
        scratch: &mut [R],
        derivatives: &mut [R],
    ) -> Fired<R>
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let fired = self.infer(prepared, x, scratch);
        let consequents = &mut derivatives[self.first_consequent..];
        self.consequent_shares(x, scratch, fired.strength, consequents);
        fired
    }

    /// The derivatives to the consequents: each rule's share of the firing strength, times the
    /// input for a coefficient.
    fn consequent_shares<R: Real>(
        &self,
        x: &[R],
        degrees: &[R],
        strength: R,
        consequents: &mut [R],
    ) {
        self.strengths(&degrees[..self.slots.len()], consequents);
        let (scale, size) = (reciprocal(strength), self.consequent_size());
        for rule in (0..self.rules).rev() {
            let share = consequents[rule] * scale;
            let own = &mut consequents[rule * size..][..size];
            own[size - 1] = share;
            own.iter_mut().zip(x).take(size - 1).for_each(|(own, &input)| *own = share * input);
        }
    }

    /// [`gradient`](Self::gradient) to the parameters of the terms alone.
    pub(super) fn premise_gradient<R, P>(
        &self,
        parameters: &P,
        prepared: &P,
        x: &[R],
        scratch: &mut [R],
        derivatives: &mut [R],
    ) -> Fired<R>
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let (degrees, rest) = scratch.split_at_mut(self.slots.len());
        let (pulls, own) = rest.split_at_mut(self.slots.len());
        let fired = self.infer(prepared, x, degrees);
        let point = Point { prepared, x, degrees, output: fired.average(0.0) };
        pulls.iter_mut().for_each(|pull| *pull = R::splat(0.0));
        self.pull(&point, 0, 0, R::splat(1.0), pulls);
        let scale = reciprocal(fired.strength);
        for (axis, &input) in self.axes.iter().zip(x) {
            for index in axis.first..axis.first + axis.count {
                let TermSlot { shape, count, offset } = self.slots[index];
                for (k, parameter) in own.iter_mut().take(count).enumerate() {
                    *parameter = parameters.number(offset + k);
                }
                let by_parameter = &mut derivatives[offset..][..count];
                shape.gradient(&own[..count], input, degrees[index], by_parameter);
                for derivative in by_parameter {
                    *derivative = pulls[index] * scale * *derivative;
                }
            }
        }
        fired
    }

    /// Adds to the pull Σᵣ (fᵣ − f)·wᵣ/μ of each term what the rules of the axes from `depth` on,
    /// beginning at `rule`, have in it; `prefix` is the product of their degrees on the axes
    /// before. Returns Σ over these rules of their degrees on the axes from `depth` on times
    /// fᵣ − f.
    fn pull<R, P>(
        &self,
        point: &Point<'_, R, P>,
        depth: usize,
        rule: usize,
        prefix: R,
        pulls: &mut [R],
    ) -> R
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let (axis, below) = (self.axes[depth], depth + 1);
        let mut sum = R::splat(0.0);
        for term in 0..axis.count {
            let (index, rule) = (axis.first + term, rule + term * axis.stride);
            let degree = point.degrees[index];
            let inner = match self.axes.len() - below {
                0 => self.consequent(point.prepared, point.x, rule) - point.output,
                1 => self.pull_last(point, rule, prefix * degree, pulls),
                _ => self.pull(point, below, rule, prefix * degree, pulls),
            };
            pulls[index] = prefix.mul_add(inner, pulls[index]);
            sum = degree.mul_add(inner, sum);
        }
        sum
    }

    /// [`pull`](Self::pull) for the last axis.
    #[inline(always)]
    fn pull_last<R, P>(&self, point: &Point<'_, R, P>, rule: usize, prefix: R, pulls: &mut [R]) -> R
    where
        R: Real,
        P: Numbers<R> + ?Sized,
    {
        let axis = self.axes[self.axes.len() - 1];
        let degrees = &point.degrees[axis.first..][..axis.count];
        let mut sum = R::splat(0.0);
        let own = pulls[axis.first..].iter_mut().zip(degrees);
        for (term, (pull, &degree)) in own.enumerate() {
            let inner = self.consequent(point.prepared, point.x, rule + term) - point.output;
            *pull = prefix.mul_add(inner, *pull);
            sum = degree.mul_add(inner, sum);
        }
        sum
    }
}

/// A point at which the rules have fired.
struct Point<'a, R, P: ?Sized> {
    prepared: &'a P,
    x: &'a [R],
    degrees: &'a [R],
    output: R,
}

/// 1/strength; zero where no rule fires.
#[inline(always)]
fn reciprocal<R: Real>(strength: R) -> R {
    let zero = R::splat(0.0);
    R::select(zero.lt(strength), R::splat(1.0) / strength, zero)
}
