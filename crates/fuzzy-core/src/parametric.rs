//! The flat parameter vector: what each number is called and where it may move.

use crate::inference::{CONSTANT, Inference, Order, System, Tsk};
use crate::output::{Method, Value};
use crate::variable::Variable;

/// The name of one parameter and the range that learners search by default.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// A path such as `angle.N.mean` or `rule.N.Z.constant`.
    pub name: String,
    /// The lower bound; −∞ if there is none.
    pub low: f64,
    /// The upper bound; ∞ if there is none.
    pub high: f64,
}

impl Tsk {
    /// Names and bounds of the parameters, in the order of the vector.
    ///
    /// Those of membership functions depend on the [kind](crate::membership::ParameterKind::bounds)
    /// of each parameter; consequents are free. Bounds don't keep vertices ordered.
    pub fn parameter_info(&self) -> Vec<Parameter> {
        let mut parameters: Vec<Parameter> = self.inputs().iter().flat_map(of_terms).collect();
        let coefficients: Vec<&str> = match self.order() {
            Order::Zero => vec![CONSTANT],
            Order::One => self.inputs().iter().map(|v| v.name()).chain([CONSTANT]).collect(),
        };
        for rule in 0..self.grid().rules() {
            let path = format!("rule.{}", self.rule_terms(rule).join("."));
            parameters.extend(coefficients.iter().map(|name| free(&path, name)));
        }
        parameters
    }

    /// The terms that a rule's antecedent joins, one for each input.
    pub fn rule_terms(&self, rule: usize) -> Vec<&str> {
        let mut rest = rule;
        let mut names: Vec<&str> = Vec::with_capacity(self.inputs().len());
        for input in self.inputs().iter().rev() {
            let terms = input.terms();
            names.push(&terms[rest % terms.len()].name);
            rest /= terms.len();
        }
        names.reverse();
        names
    }
}

impl System {
    /// Names and bounds of the parameters, in the order of the vector: as
    /// [`Tsk::parameter_info`] has them, and the rules' weights from 0 to 1.
    pub fn parameter_info(&self) -> Vec<Parameter> {
        let inputs = self.interface().inputs();
        let coefficients: Vec<&str> =
            inputs.iter().map(|input| input.name()).chain([CONSTANT]).collect();
        let mut parameters: Vec<Parameter> = inputs.iter().flat_map(of_terms).collect();
        for output in self.outputs() {
            match output.method() {
                Method::Mamdani { variable, .. } | Method::Tsukamoto { variable, .. } => {
                    parameters.extend(of_terms(variable));
                }
                Method::Sugeno { terms, .. } => {
                    for (term, value) in terms {
                        let names = match value {
                            Value::Constant(_) => &[CONSTANT][..],
                            Value::Linear(_) => &coefficients,
                            Value::Formula(_) => &[],
                        };
                        let path = format!("{}.{term}", output.name());
                        parameters.extend(names.iter().map(|name| free(&path, name)));
                    }
                }
            }
        }
        parameters.extend((1..=self.rules().len()).map(|rule| Parameter {
            name: format!("rule.{rule}.weight"),
            low: 0.0,
            high: 1.0,
        }));
        parameters
    }
}

/// The parameters of a variable's terms.
fn of_terms(variable: &Variable) -> Vec<Parameter> {
    let mut parameters = Vec::new();
    for term in variable.terms() {
        let (shape, values) = (term.function.shape(), term.function.parameters());
        let names = shape.parameter_names(values.len());
        for (index, (name, &value)) in names.iter().zip(values).enumerate() {
            let (low, high) = shape.parameter_kind(index).bounds(variable.universe(), value);
            let name = format!("{}.{}.{name}", variable.name(), term.name);
            parameters.push(Parameter { name, low, high });
        }
    }
    parameters
}

/// A parameter without bounds.
fn free(path: &str, name: &str) -> Parameter {
    Parameter { name: format!("{path}.{name}"), low: f64::NEG_INFINITY, high: f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use crate::{Inference, MembershipFunction, Order, Shape, Tsk, Variable};

    #[test]
    fn names_follow_the_vector() {
        let x = Variable::evenly("x", (0.0, 2.0), Shape::Gaussian, &["low", "high"]).unwrap();
        let y = Variable::evenly("y", (0.0, 1.0), Shape::Triangular, &["a", "b"]).unwrap();
        let system = Tsk::new("s", vec![x, y], Order::One, vec![0.0; 12]).unwrap();
        let info = system.parameter_info();
        assert_eq!(info.len(), system.parameters().len());
        let names: Vec<&str> = info.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names[..2], ["x.low.mean", "x.low.sigma"]);
        assert_eq!(names[4..7], ["y.a.a", "y.a.b", "y.a.c"]);
        assert_eq!(names[10..13], ["rule.low.a.x", "rule.low.a.y", "rule.low.a.constant"]);
        assert_eq!(names[13], "rule.low.b.x");
        assert_eq!((info[0].low, info[0].high), (0.0, 2.0));
        assert_eq!((info[1].low, info[1].high), (0.02, 2.0));
        assert_eq!(info[12].high, f64::INFINITY);
    }

    #[test]
    fn bounds_follow_the_kind_and_hold_what_is_valid() {
        let bounds = |shape, parameters: &[f64]| -> Vec<(f64, f64)> {
            let function = MembershipFunction::new(shape, parameters).unwrap();
            let x = Variable::new("x", -1.0, 3.0).unwrap().with_term("t", function).unwrap();
            let system = Tsk::zero_order("s", vec![x], vec![0.0]).unwrap();
            let info = system.parameter_info();
            info[..parameters.len()].iter().map(|p| (p.low, p.high)).collect()
        };
        assert_eq!(bounds(Shape::Bell, &[0.0, 1.0, 2.0]), [(-1.0, 3.0), (0.04, 4.0), (0.5, 10.0)]);
        assert_eq!(bounds(Shape::Sigmoid, &[0.0, 2.0]), [(-1.0, 3.0), (1.0, 100.0)]);
        assert_eq!(bounds(Shape::Sigmoid, &[0.0, -2.0]), [(-1.0, 3.0), (-100.0, -1.0)]);
        assert_eq!(bounds(Shape::Ramp, &[0.0, 1.0]), [(-5.0, 7.0); 2]);
        assert_eq!(bounds(Shape::Step, &[0.0, 1.0]), [(-1.0, 3.0), (-1.0, 1.0)]);
        let points = bounds(Shape::Points, &[0.0, 0.0, 1.0, 1.0]);
        assert_eq!(points, [(-5.0, 7.0), (0.0, 1.0), (-5.0, 7.0), (0.0, 1.0)]);
    }
}
