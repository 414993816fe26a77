//! Whether a formula is a weighted sum of its variables and a constant.

use super::function::Function;
use super::{Expression, Step};

/// The coefficients of the variables, then the constant; none for what is not affine.
type Form = Option<Vec<f64>>;

impl Expression {
    /// The coefficients of the variables and then the constant, if the formula is built from
    /// sums and differences, and products, quotients and functions of constants.
    ///
    /// None too if one of them is infinite or NaN.
    ///
    /// ```
    /// use fuzzy_core::Expression;
    ///
    /// let formula = Expression::parse("2*(x - 3) + y/4", &["x", "y"])?;
    /// assert_eq!(formula.affine(), Some(vec![2.0, 0.25, -6.0]));
    /// assert_eq!(Expression::parse("x*y", &["x", "y"])?.affine(), None);
    /// # Ok::<(), fuzzy_core::Error>(())
    /// ```
    pub fn affine(&self) -> Option<Vec<f64>> {
        let mut stack: Vec<Form> = Vec::with_capacity(self.stack);
        for step in &self.code {
            let form = match *step {
                Step::Constant(value) => Some(self.constant(value)),
                Step::Variable(index) => {
                    let mut form = self.constant(0.0);
                    form[index] = 1.0;
                    Some(form)
                }
                Step::Apply(function) => {
                    let first = stack.len() - function.arity();
                    let arguments: Vec<Form> = stack.drain(first..).collect();
                    self.apply(function, arguments)
                }
            };
            stack.push(form);
        }
        stack.pop().flatten().filter(|form| form.iter().all(|value| value.is_finite()))
    }

    fn constant(&self, value: f64) -> Vec<f64> {
        let mut form = vec![0.0; self.variables + 1];
        form[self.variables] = value;
        form
    }

    fn apply(&self, function: Function, arguments: Vec<Form>) -> Form {
        let values: Vec<Option<f64>> = arguments.iter().map(value).collect();
        if let Some(values) = values.iter().copied().collect::<Option<Vec<f64>>>() {
            return Some(self.constant(function.apply(&values)));
        }
        let mut forms = arguments.into_iter();
        let mut next = || forms.next().flatten();
        match (function, values.as_slice()) {
            (Function::Negate, _) => Some(scaled(next()?, |x| -x)),
            (Function::Add, _) => Some(combined(next()?, &next()?, |x, y| x + y)),
            (Function::Subtract, _) => Some(combined(next()?, &next()?, |x, y| x - y)),
            (Function::Multiply, &[_, Some(factor)]) => Some(scaled(next()?, |x| x * factor)),
            (Function::Multiply, &[Some(factor), _]) => {
                next();
                Some(scaled(next()?, |x| factor * x))
            }
            (Function::Divide, &[_, Some(divisor)]) => Some(scaled(next()?, |x| x / divisor)),
            (Function::Power, &[_, Some(1.0)]) => next(),
            (Function::Power, &[_, Some(0.0)]) => Some(self.constant(1.0)),
            (Function::If, &[Some(condition), ..]) => {
                next();
                let (chosen, otherwise) = (next(), next());
                if condition == 0.0 { otherwise } else { chosen.filter(|_| !condition.is_nan()) }
            }
            _ => None,
        }
    }
}

/// The value of a form in which no variable has a part.
fn value(form: &Form) -> Option<f64> {
    let (constant, coefficients) = form.as_ref()?.split_last()?;
    coefficients.iter().all(|&value| value == 0.0).then_some(*constant)
}

fn scaled(form: Vec<f64>, scale: impl Fn(f64) -> f64) -> Vec<f64> {
    form.into_iter().map(scale).collect()
}

fn combined(form: Vec<f64>, other: &[f64], combine: impl Fn(f64, f64) -> f64) -> Vec<f64> {
    form.into_iter().zip(other).map(|(x, &y)| combine(x, y)).collect()
}
