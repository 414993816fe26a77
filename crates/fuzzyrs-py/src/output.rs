//! Outputs of rule systems.

use fuzzy_core::norm::{Aggregation, TNorm};
use fuzzy_core::output::{Defuzzifier, Method, Output, Sampling, Value, Weighting};
use fuzzy_core::{Antecedent, Error as CoreError, NoRuleFires};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyList, PyMapping, PyString, PyTuple};

use crate::arrays::whole;
use crate::errors::{Error, Result};
use crate::membership::PyVariable;
use crate::pickle::rebuild;
use crate::rules::PyProposition;

/// What rules conclude about a quantity, and how that becomes a number.
///
/// Made by `Output.mamdani`, `Output.sugeno` and `Output.tsukamoto`. A `Variable` that is given
/// to a `System` as an output stands for `Output.mamdani(variable)`.
#[pyclass(name = "Output", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyOutput {
    /// The terms of a Sugeno output wait for the names of the inputs.
    pub output: Output,
    pub formulas: Vec<(String, String)>,
}

#[pymethods]
impl PyOutput {
    /// An output that is a fuzzy set.
    ///
    /// Parameters
    /// ----------
    /// variable : Variable
    ///     What rules may conclude.
    /// implication : str, optional
    ///     How a rule's strength shapes its term: "min" clips, "product" scales (Larsen); or
    ///     another t-norm.
    /// aggregation : str, optional
    ///     How the rules' sets are joined: "max", "sum" or another s-norm.
    /// defuzzifier : str, optional
    ///     "centroid", "bisector", "mean_of_maximum", "smallest_of_maximum",
    ///     "largest_of_maximum" or "height" (the centres of the terms, weighted by the firing
    ///     strengths).
    /// sampling : str, optional
    ///     Where the set is looked at: "endpoints" (the ends of the universe included, as in
    ///     MATLAB), "midpoints" (of equal parts, as in fuzzylite) or "exact" (a centroid without
    ///     sampling error, for piecewise-linear terms).
    /// samples : int, optional
    ///     How many points.
    /// no_rule_fires : "error", "nan", "previous" or float, optional
    ///     The output where no rule about it fires.
    ///
    /// Returns
    /// -------
    /// Output
    #[staticmethod]
    #[pyo3(signature = (variable, *, implication = "min", aggregation = "max", defuzzifier = "centroid", sampling = "endpoints", samples = 101, no_rule_fires = None))]
    fn mamdani(
        variable: &PyVariable,
        implication: &str,
        aggregation: &str,
        defuzzifier: &str,
        sampling: &str,
        #[pyo3(from_py_with = whole)] samples: usize,
        no_rule_fires: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        Self::finished(
            Output::mamdani_with(
                variable.0.clone(),
                TNorm::from_name(implication)?,
                Aggregation::from_name(aggregation)?,
                Defuzzifier::from_name(defuzzifier)?,
                Sampling::from_name(sampling, samples)?,
            )?,
            no_rule_fires,
        )
    }

    /// An output whose rules conclude numbers or functions of the inputs (Takagi-Sugeno-Kang).
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     What rules call it.
    /// terms : dict of str to float, sequence of float or str, optional
    ///     What rules may conclude: a constant, the coefficients of the inputs and then a
    ///     constant, or a formula of the inputs such as "2*error + sin(rate)". Rules may also
    ///     conclude formulas directly: "then power = 2*error".
    /// aggregation : str, optional
    ///     How strengths of rules with the same term are joined: "sum", so that each rule
    ///     counts, or an s-norm.
    /// defuzzifier : str, optional
    ///     "weighted_average" or "weighted_sum".
    /// no_rule_fires : "error", "nan", "previous" or float, optional
    ///     The output where no rule about it fires.
    ///
    /// Returns
    /// -------
    /// Output
    #[staticmethod]
    #[pyo3(signature = (name, terms = None, *, aggregation = "sum", defuzzifier = "weighted_average", no_rule_fires = None))]
    fn sugeno(
        name: &str,
        terms: Option<&Bound<'_, PyMapping>>,
        aggregation: &str,
        defuzzifier: &str,
        no_rule_fires: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let (mut values, mut formulas) = (Vec::new(), Vec::new());
        if let Some(terms) = terms {
            for item in terms.items()? {
                let (term, value): (String, Bound<'_, PyAny>) = item.extract()?;
                if let Ok(formula) = value.extract::<String>() {
                    formulas.push((term.clone(), formula));
                    // A place among the others, filled when the inputs are known.
                    values.push((term, Value::Constant(0.0)));
                } else if let Ok(constant) = value.extract::<f64>() {
                    values.push((term, Value::Constant(constant)));
                } else if let Ok(coefficients) = value.extract::<Vec<f64>>() {
                    values.push((term, Value::Linear(coefficients)));
                } else {
                    return Err(Error::WrongType(format!(
                        "the term \"{term}\" must be a number, a sequence of numbers or a formula"
                    )));
                }
            }
        }
        let output = Output::sugeno_with(
            name,
            values,
            Aggregation::from_name(aggregation)?,
            Weighting::from_name(defuzzifier)?,
        )?;
        Ok(Self { formulas, ..Self::finished(output, no_rule_fires)? })
    }

    /// An output whose terms are monotone: a rule of strength w concludes the number whose
    /// degree is w (Tsukamoto).
    ///
    /// Parameters
    /// ----------
    /// variable : Variable
    ///     With terms that are ramps, sigmoids, s_shapes, z_shapes, concaves or arcs. The number
    ///     whose degree is w may lie outside its universe.
    /// defuzzifier : str, optional
    ///     "weighted_average" or "weighted_sum".
    /// no_rule_fires : "error", "nan", "previous" or float, optional
    ///     The output where no rule about it fires.
    ///
    /// Returns
    /// -------
    /// Output
    #[staticmethod]
    #[pyo3(signature = (variable, *, defuzzifier = "weighted_average", no_rule_fires = None))]
    fn tsukamoto(
        variable: &PyVariable,
        defuzzifier: &str,
        no_rule_fires: Option<&Bound<'_, PyAny>>,
    ) -> Result<Self> {
        let weighting = Weighting::from_name(defuzzifier)?;
        Self::finished(Output::tsukamoto(variable.0.clone(), weighting)?, no_rule_fires)
    }

    /// The proposition "output is term", for rules as objects.
    fn __getitem__(&self, term: &str) -> Result<PyProposition> {
        if !self.output.term_names().contains(&term) {
            let known = self.output.term_names();
            return Err(CoreError::unknown_name("term", term, known).into());
        }
        Ok(PyProposition(Antecedent::is(self.output.name(), term)))
    }

    /// What rules call the output.
    #[getter]
    fn name(&self) -> &str {
        self.output.name()
    }

    /// "mamdani", "sugeno" or "tsukamoto".
    #[getter]
    fn method(&self) -> &'static str {
        match self.output.method() {
            Method::Mamdani { .. } => "mamdani",
            Method::Sugeno { .. } => "sugeno",
            Method::Tsukamoto { .. } => "tsukamoto",
        }
    }

    /// The linguistic variable; None for a Sugeno output.
    #[getter]
    fn variable(&self) -> Option<PyVariable> {
        self.output.variable().cloned().map(PyVariable)
    }

    /// What rules may conclude, by name: membership functions, or for a Sugeno output numbers,
    /// lists of coefficients and formulas.
    #[getter]
    fn terms<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let Method::Sugeno { terms, .. } = self.output.method() else {
            return match self.variable() {
                Some(variable) => variable.terms(py),
                None => Ok(PyDict::new(py)),
            };
        };
        let by_name = PyDict::new(py);
        for (name, value) in terms {
            let formula = self.formulas.iter().find(|(term, _)| term == name);
            match (formula, value) {
                (Some((_, formula)), _) => by_name.set_item(name, formula)?,
                (None, Value::Constant(value)) => by_name.set_item(name, value)?,
                (None, Value::Linear(numbers)) => {
                    by_name.set_item(name, PyList::new(py, numbers)?)?;
                }
                (None, Value::Formula(formula)) => by_name.set_item(name, formula.source())?,
            }
        }
        Ok(by_name)
    }

    /// How a set or weighted numbers become a number.
    #[getter]
    fn defuzzifier(&self) -> &'static str {
        match self.output.method() {
            Method::Mamdani { defuzzifier, .. } => defuzzifier.name(),
            Method::Sugeno { weighting, .. } | Method::Tsukamoto { weighting, .. } => {
                weighting.name()
            }
        }
    }

    /// What a rule's strength shapes its term with; None but for Mamdani outputs.
    #[getter]
    fn implication(&self) -> Option<&'static str> {
        match self.output.method() {
            Method::Mamdani { implication, .. } => Some(implication.name()),
            _ => None,
        }
    }

    /// How what rules conclude is joined; None for Tsukamoto outputs.
    #[getter]
    fn aggregation(&self) -> Option<&'static str> {
        match self.output.method() {
            Method::Mamdani { aggregation, .. } | Method::Sugeno { aggregation, .. } => {
                Some(aggregation.name())
            }
            Method::Tsukamoto { .. } => None,
        }
    }

    /// Where the set of a Mamdani output is looked at; None for others.
    #[getter]
    fn sampling(&self) -> Option<&'static str> {
        match self.output.method() {
            Method::Mamdani { sampling, .. } => Some(sampling.name()),
            _ => None,
        }
    }

    /// In how many points; None where the set is not sampled.
    #[getter]
    fn samples(&self) -> Option<usize> {
        match self.output.method() {
            Method::Mamdani { sampling, .. } => sampling.count(),
            _ => None,
        }
    }

    /// The output where no rule about it fires: "error", "nan", "previous" or a number.
    #[getter]
    fn no_rule_fires<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        no_rule_fires(py, self.output.no_rule_fires())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let (py, this) = (slf.py(), slf.get());
        let keywords = PyDict::new(py);
        keywords.set_item("defuzzifier", this.defuzzifier())?;
        keywords.set_item("no_rule_fires", this.no_rule_fires(py))?;
        let arguments = match this.output.method() {
            Method::Mamdani { implication, aggregation, sampling, .. } => {
                keywords.set_item("implication", implication.name())?;
                keywords.set_item("aggregation", aggregation.name())?;
                keywords.set_item("sampling", sampling.name())?;
                if let Some(samples) = sampling.count() {
                    keywords.set_item("samples", samples)?;
                }
                (this.variable(),).into_pyobject(py)?.into_any()
            }
            Method::Sugeno { aggregation, .. } => {
                keywords.set_item("aggregation", aggregation.name())?;
                (this.name(), this.terms(py)?).into_pyobject(py)?.into_any()
            }
            Method::Tsukamoto { .. } => (this.variable(),).into_pyobject(py)?.into_any(),
        };
        let make = slf.get_type().getattr(this.method())?;
        rebuild(&make, arguments.cast_into()?, &keywords)
    }

    fn __repr__(&self) -> String {
        let terms = self.output.term_names().join(" ");
        format!("<Output {:?}: {}, {} [{terms}]>", self.name(), self.method(), self.defuzzifier())
    }
}

impl PyOutput {
    /// An output of a system: its formulas are texts again, as they were given.
    pub fn of_system(output: &Output) -> Result<Self> {
        let mut plain = Self { output: output.clone(), formulas: Vec::new() };
        if let Method::Sugeno { terms, .. } = output.method() {
            for (term, value) in terms {
                if let Value::Formula(formula) = value {
                    plain.formulas.push((term.clone(), formula.source().to_owned()));
                    plain.output = plain.output.with_value(term, Value::Constant(0.0))?;
                }
            }
        }
        Ok(plain)
    }

    fn finished(output: Output, no_rule_fires: Option<&Bound<'_, PyAny>>) -> Result<Self> {
        let output = output.when_no_rule_fires(answer(no_rule_fires)?)?;
        Ok(Self { output, formulas: Vec::new() })
    }

    /// The output in a system with these inputs.
    pub fn with_inputs(&self, inputs: &[&str]) -> Result<Output> {
        let mut output = self.output.clone();
        for (term, formula) in &self.formulas {
            output = output.with_value(term, Value::parse(formula, inputs)?)?;
        }
        Ok(output)
    }
}

/// What the caller wants where no rule fires.
pub fn answer(choice: Option<&Bound<'_, PyAny>>) -> Result<NoRuleFires> {
    let Some(choice) = choice else { return Ok(NoRuleFires::Error) };
    if choice.is_instance_of::<PyString>() {
        let name: String = choice.extract()?;
        return match name.as_str() {
            "error" => Ok(NoRuleFires::Error),
            "nan" => Ok(NoRuleFires::Nan),
            "previous" => Ok(NoRuleFires::Previous),
            _ => {
                let known = ["error", "nan", "previous"];
                Err(CoreError::unknown_name("answer where no rule fires", &name, known).into())
            }
        };
    }
    choice.extract().map(NoRuleFires::Value).map_err(|_| {
        let message = "no_rule_fires must be \"error\", \"nan\", \"previous\" or a number";
        Error::WrongType(message.to_owned())
    })
}

/// The choice as the caller gave it.
pub fn no_rule_fires(py: Python<'_>, choice: NoRuleFires) -> Bound<'_, PyAny> {
    match choice {
        NoRuleFires::Error => PyString::new(py, "error").into_any(),
        NoRuleFires::Nan => PyString::new(py, "nan").into_any(),
        NoRuleFires::Previous => PyString::new(py, "previous").into_any(),
        NoRuleFires::Value(value) => PyFloat::new(py, value).into_any(),
    }
}
