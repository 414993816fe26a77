//! Where to search for better parameters of a system, if nothing else is known.

use crate::inference::{Inference, Order, System, Tsk};
use crate::learn::data::DataSet;
use crate::membership::ParameterKind;
use crate::output::{Method, Value};
use crate::variable::Variable;

/// A system that proposes where to search for its parameters.
pub trait SearchBounds: Inference {
    /// The range of each parameter for a search that begins at the system and fits these samples,
    /// which have the system's inputs and outputs. The system's own parameters lie within.
    ///
    /// - parameters of terms: as their [kind](ParameterKind::bounds) says, but a vertex goes no
    ///   farther than half-way to the next one of its function, so vertices stay in order;
    /// - constants of consequents: the range of the targets, widened by its size to both sides;
    /// - coefficients of an input: twice the slope that would cross the range of the targets
    ///   within the input's universe; the constants are widened by what such slopes can add;
    /// - weights of rules: none, they stay as they are.
    fn search_bounds(&self, data: &DataSet) -> Vec<(f64, f64)>;
}

impl SearchBounds for Tsk {
    fn search_bounds(&self, data: &DataSet) -> Vec<(f64, f64)> {
        let mut bounds: Vec<(f64, f64)> = self.inputs().iter().flat_map(of_terms).collect();
        let linear = self.order() == Order::One;
        let consequent = of_consequent(self.inputs(), data.target_range(0), linear);
        (0..self.grid().rules()).for_each(|_| bounds.extend(&consequent));
        around(self.parameters(), bounds)
    }
}

impl SearchBounds for System {
    fn search_bounds(&self, data: &DataSet) -> Vec<(f64, f64)> {
        let inputs = self.interface().inputs();
        let mut bounds: Vec<(f64, f64)> = inputs.iter().flat_map(of_terms).collect();
        for (index, output) in self.outputs().iter().enumerate() {
            let targets = data.target_range(index);
            match output.method() {
                Method::Mamdani { variable, .. } | Method::Tsukamoto { variable, .. } => {
                    bounds.extend(of_terms(variable));
                }
                Method::Sugeno { terms, .. } => {
                    bounds.extend(terms.iter().flat_map(|(_, value)| match value {
                        Value::Constant(_) => of_consequent(inputs, targets, false),
                        Value::Linear(_) => of_consequent(inputs, targets, true),
                        Value::Formula(_) => Vec::new(),
                    }));
                }
            }
        }
        bounds.extend(self.rules().iter().map(|rule| (rule.weight, rule.weight)));
        around(self.parameters(), bounds)
    }
}

/// The ranges of the parameters of a variable's terms.
fn of_terms(variable: &Variable) -> Vec<(f64, f64)> {
    let mut bounds = Vec::new();
    for term in variable.terms() {
        let (shape, values) = (term.function.shape(), term.function.parameters());
        let is_vertex = |index: usize| shape.parameter_kind(index) == ParameterKind::Vertex;
        for (index, &value) in values.iter().enumerate() {
            let (mut low, mut high) =
                shape.parameter_kind(index).bounds(variable.universe(), value);
            let others = values.iter().enumerate().filter(|&(other, _)| is_vertex(other));
            for (other, &place) in others.filter(|&(other, _)| is_vertex(index) && other != index) {
                let middle = 0.5 * value + 0.5 * place;
                if place < value || (place == value && other < index) {
                    low = low.max(middle);
                } else {
                    high = high.min(middle);
                }
            }
            bounds.push((low, high));
        }
    }
    bounds
}

/// The ranges of one rule's constant, and of its coefficients before it if it is linear.
fn of_consequent(inputs: &[Variable], (low, high): (f64, f64), linear: bool) -> Vec<(f64, f64)> {
    let size = if high > low { high - low } else { high.abs().max(1.0) };
    let (mut bounds, mut reach) = (Vec::new(), size);
    for universe in inputs.iter().filter(|_| linear).map(Variable::universe) {
        let slope = 2.0 * size / (universe.high() - universe.low());
        bounds.push((-slope, slope));
        reach += slope * universe.low().abs().max(universe.high().abs());
    }
    bounds.push((low - reach, high + reach));
    bounds
}

/// The ranges, widened where a parameter lies outside.
fn around(parameters: &[f64], bounds: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let pairs = bounds.into_iter().zip(parameters);
    pairs.map(|((low, high), &value)| (low.min(value), high.max(value))).collect()
}
