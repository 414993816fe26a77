//! Rules as objects: propositions joined by operators.

use fuzzy_core::Variable;
use fuzzy_core::rule::{Antecedent, Conclusion, Consequent, MAX_NESTING, Rule};
use pyo3::prelude::*;
use pyo3::types::{PyString, PyTuple};

use crate::errors::{Error, Result};
use crate::membership::PyVariable;

/// A proposition such as "service is poor", or several joined by AND, OR and NOT.
///
/// `variable["term"]` makes one; `a & b`, `a | b` and `~a` join them, `a.hedge("very")` puts a
/// hedge before one, and `a >> b` is the rule "if a then b". Python's `&` binds closer than `|`,
/// and both closer than comparisons, as AND and OR do in the rule language; `>>` binds closer
/// than either, so the antecedent of several needs parentheses.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> service = fz.Variable.evenly("service", (0, 10), ["poor", "good"])
/// >>> food = fz.Variable.evenly("food", (0, 10), ["bad", "fine"])
/// >>> tip = fz.Variable.evenly("tip", (0, 30), ["low", "high"])
/// >>> (service["poor"] | ~food["fine"].hedge("very")) >> tip["low"]
/// Rule("if service is poor or not very (food is fine) then tip is low")
#[pyclass(name = "Proposition", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyProposition(pub Antecedent);

#[pymethods]
impl PyProposition {
    fn __and__(&self, other: &Self) -> Result<Self> {
        Ok(Self(self.0.clone().and(other.0.clone())?))
    }

    fn __or__(&self, other: &Self) -> Result<Self> {
        Ok(Self(self.0.clone().or(other.0.clone())?))
    }

    fn __invert__(&self) -> Result<Self> {
        Ok(Self(Antecedent::not(self.0.clone())?))
    }

    /// The proposition with a hedge before it.
    ///
    /// Parameters
    /// ----------
    /// name : str
    ///     A built-in hedge such as "very", or one of the system's own.
    ///
    /// Returns
    /// -------
    /// Proposition
    fn hedge(&self, name: &str) -> Result<Self> {
        Ok(Self(self.0.clone().hedged(name)?))
    }

    /// What was pickled.
    #[staticmethod]
    fn _restore(tuples: &Bound<'_, PyTuple>) -> PyResult<Self> {
        // Chains and what they join are two levels each.
        from_tuples(tuples, 2 * MAX_NESTING + 2).map(Self)
    }

    /// Python's `and`, `or` and `not` would drop one of two propositions silently.
    fn __bool__(&self) -> Result<bool> {
        let message = "a proposition is neither true nor false; join them with &, | and ~";
        Err(Error::WrongType(message.to_owned()))
    }

    fn __rshift__(&self, conclusions: &Bound<'_, PyAny>) -> Result<PyRule> {
        let conclusions: Vec<Bound<'_, PyProposition>> = match conclusions.cast() {
            Ok(one) => vec![one.clone()],
            Err(_) => conclusions.extract().map_err(|_| {
                Error::WrongType("a rule concludes a proposition or a list of them".to_owned())
            })?,
        };
        let conclusions = conclusions
            .iter()
            .map(|proposition| conclusion(&proposition.get().0))
            .collect::<Result<_>>()?;
        Ok(PyRule(Rule::new(self.0.clone(), conclusions)))
    }

    fn __repr__(&self) -> String {
        format!("Proposition({:?})", self.0.to_string())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        (slf.get_type().getattr("_restore")?, (to_tuples(py, &slf.get().0)?,)).into_pyobject(py)
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }
}

impl PyRule {
    /// The antecedent and the conclusions as propositions.
    fn parts(&self, py: Python<'_>) -> PyResult<Vec<Py<PyProposition>>> {
        let conclusions = self.0.conclusions.iter().filter_map(|said| match &said.value {
            Consequent::Term { hedges, term } => Some(Antecedent::Is {
                variable: said.output.clone(),
                hedges: hedges.clone(),
                term: term.clone(),
            }),
            // A system makes terms of the formulas in its rules, so none gets here.
            Consequent::Formula(_) => None,
        });
        let all = std::iter::once(self.0.antecedent.clone()).chain(conclusions);
        all.map(|part| Py::new(py, PyProposition(part))).collect()
    }
}

/// An antecedent as nested tuples, for pickling.
fn to_tuples<'py>(py: Python<'py>, antecedent: &Antecedent) -> PyResult<Bound<'py, PyTuple>> {
    let each = |parts: &[Antecedent]| {
        let tuples = parts.iter().map(|part| to_tuples(py, part)).collect::<PyResult<Vec<_>>>()?;
        PyTuple::new(py, tuples)
    };
    match antecedent {
        Antecedent::Is { variable, hedges, term } => {
            ("is", variable, hedges.clone(), term).into_pyobject(py)
        }
        Antecedent::And(parts) => ("and", each(parts)?).into_pyobject(py),
        Antecedent::Or(parts) => ("or", each(parts)?).into_pyobject(py),
        Antecedent::Not(of) => ("not", to_tuples(py, of)?).into_pyobject(py),
        Antecedent::Hedged { hedge, of } => ("hedge", hedge, to_tuples(py, of)?).into_pyobject(py),
    }
}

/// The antecedent that [`to_tuples`] wrote.
fn from_tuples(tuples: &Bound<'_, PyTuple>, levels: usize) -> PyResult<Antecedent> {
    let Some(levels) = levels.checked_sub(1) else {
        return Err(Error::WrongType("what was pickled is nested too deeply".to_owned()).into());
    };
    let kind: String = tuples.get_item(0)?.extract()?;
    let nested = |index: usize| from_tuples(tuples.get_item(index)?.cast::<PyTuple>()?, levels);
    let parts = || {
        let parts = tuples.get_item(1)?;
        let parts = parts.cast::<PyTuple>()?;
        let parts = parts.iter().map(|part| from_tuples(part.cast::<PyTuple>()?, levels));
        parts.collect::<PyResult<Vec<_>>>()
    };
    Ok(match kind.as_str() {
        "is" => {
            let (_, variable, hedges, term): (String, String, Vec<String>, String) =
                tuples.extract()?;
            Antecedent::Is { variable, hedges, term }
        }
        "and" => Antecedent::And(parts()?),
        "or" => Antecedent::Or(parts()?),
        "not" => Antecedent::not(nested(1)?).map_err(Error::from)?,
        _ => nested(2)?.hedged(&tuples.get_item(1)?.extract::<String>()?).map_err(Error::from)?,
    })
}

/// What a proposition says as a conclusion.
fn conclusion(proposition: &Antecedent) -> Result<Conclusion> {
    let mut outer = Vec::new();
    let mut inner = proposition;
    loop {
        inner = match inner {
            Antecedent::Hedged { hedge, of } => {
                outer.push(hedge.clone());
                of
            }
            Antecedent::Not(of) => {
                outer.push("not".to_owned());
                of
            }
            _ => break,
        };
    }
    match inner {
        Antecedent::Is { variable, hedges, term } => {
            outer.extend(hedges.iter().cloned());
            let value = Consequent::Term { hedges: outer, term: term.clone() };
            Ok(Conclusion { output: variable.clone(), value })
        }
        _ => Err(Error::WrongType(format!(
            "a rule concludes single propositions, got \"{proposition}\"; give several as a list"
        ))),
    }
}

/// A rule: an antecedent, its conclusions and a weight.
///
/// Made by `antecedent >> conclusion`, or read from text by a `System`.
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> x = fz.Variable.evenly("x", (0, 1), ["low", "high"])
/// >>> y = fz.Variable.evenly("y", (0, 1), ["low", "high"])
/// >>> (x["low"] >> y["high"]).weighted(0.5)
/// Rule("if x is low then y is high with 0.5")
#[pyclass(name = "Rule", module = "fuzzyrs", frozen, eq)]
#[derive(Clone, PartialEq)]
pub struct PyRule(pub Rule);

#[pymethods]
impl PyRule {
    /// What the firing strength is multiplied by.
    #[getter]
    fn weight(&self) -> f64 {
        self.0.weight
    }

    /// What was pickled.
    #[staticmethod]
    fn _restore(parts: Vec<Bound<'_, PyProposition>>, weight: f64) -> Result<Self> {
        let (antecedent, conclusions) = parts
            .split_first()
            .ok_or_else(|| Error::WrongType("a rule has an antecedent".to_owned()))?;
        let conclusions = conclusions.iter().map(|part| conclusion(&part.get().0));
        let conclusions = conclusions.collect::<Result<_>>()?;
        let rule = Rule::new(antecedent.get().0.clone(), conclusions).with_weight(weight)?;
        Ok(Self(rule))
    }

    /// The rule's antecedent.
    #[getter]
    fn antecedent(&self) -> PyProposition {
        PyProposition(self.0.antecedent.clone())
    }

    /// What it says, as propositions.
    #[getter]
    fn conclusions(&self, py: Python<'_>) -> PyResult<Vec<Py<PyProposition>>> {
        Ok(self.parts(py)?.split_off(1))
    }

    /// The same rule with another weight.
    ///
    /// Parameters
    /// ----------
    /// weight : float
    ///     From 0 to 1.
    ///
    /// Returns
    /// -------
    /// Rule
    fn weighted(&self, weight: f64) -> Result<Self> {
        Ok(Self(self.0.clone().with_weight(weight)?))
    }

    fn __repr__(&self) -> String {
        format!("Rule({:?})", self.0.to_string())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyTuple>> {
        let py = slf.py();
        (slf.get_type().getattr("_restore")?, (slf.get().parts(py)?, slf.get().0.weight))
            .into_pyobject(py)
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }
}

/// One rule for each combination of the inputs' terms, from a table as control books print them.
///
/// Parameters
/// ----------
/// inputs : sequence of Variable
///     Whose terms the axes of the table stand for.
/// output : Variable or Output or str
///     What the rules are about.
/// table : nested sequence of str or None
///     The concluded terms, shaped like the grid of the inputs' terms; no rule for None.
///
/// Returns
/// -------
/// list of Rule
///
/// Examples
/// --------
/// >>> import fuzzyrs as fz
/// >>> error = fz.Variable.evenly("error", (-1, 1), "NP")
/// >>> rate = fz.Variable.evenly("rate", (-1, 1), "NP")
/// >>> fz.rule_table([error, rate], "u", [["down", None], ["stay", "up"]])[2]
/// Rule("if error is P and rate is P then u is up")
#[pyfunction]
pub fn rule_table(
    inputs: Vec<Bound<'_, PyVariable>>,
    output: &Bound<'_, PyAny>,
    table: &Bound<'_, PyAny>,
) -> Result<Vec<PyRule>> {
    let inputs: Vec<_> = inputs.iter().map(|input| input.get().0.clone()).collect();
    let name: String = match output.extract() {
        Ok(name) => name,
        Err(_) => output.getattr("name")?.extract()?,
    };
    let mut cells = Vec::new();
    flatten(table, inputs.len(), &inputs, &mut cells)?;
    let cells: Vec<Option<&str>> = cells.iter().map(Option::as_deref).collect();
    Ok(fuzzy_core::rule_table(&inputs, &name, &cells)?.into_iter().map(PyRule).collect())
}

/// Appends the cells of a nested table, one level for each of the inputs that are left.
fn flatten(
    table: &Bound<'_, PyAny>,
    levels: usize,
    inputs: &[Variable],
    cells: &mut Vec<Option<String>>,
) -> Result<()> {
    if levels == 0 {
        let cell = table.extract().map_err(|_| {
            Error::WrongType("the cells of a rule table must be terms or None".to_owned())
        });
        cells.push(cell?);
        return Ok(());
    }
    let input = &inputs[inputs.len() - levels];
    let what = || format!("the table along \"{}\"", input.name());
    if table.is_instance_of::<PyString>() {
        return Err(Error::WrongType(format!("{} must be a sequence", what())));
    }
    let rows: Vec<_> = table
        .try_iter()
        .map_err(|_| Error::WrongType(format!("{} must be a sequence", what())))?
        .collect::<PyResult<_>>()?;
    if rows.len() != input.terms().len() {
        let expected = format!("{}, one for each term", input.terms().len());
        return Err(fuzzy_core::Error::wrong_shape(what(), expected, rows.len()).into());
    }
    rows.iter().try_for_each(|row| flatten(row, levels - 1, inputs, cells))
}
