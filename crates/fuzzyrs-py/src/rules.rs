//! Rules as objects: propositions joined by operators.

use fuzzy_core::Variable;
use fuzzy_core::rule::{Antecedent, Conclusion, Consequent, Rule};
use pyo3::prelude::*;
use pyo3::types::PyString;

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
/// Rule("if service is poor or not very food is fine then tip is low")
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

    fn __str__(&self) -> String {
        self.0.to_string()
    }
}

/// What a proposition says as a conclusion.
fn conclusion(proposition: &Antecedent) -> Result<Conclusion> {
    let mut outer = Vec::new();
    let mut inner = proposition;
    while let Antecedent::Hedged { hedge, of } = inner {
        outer.push(hedge.clone());
        inner = of;
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

    /// The rule's antecedent.
    #[getter]
    fn antecedent(&self) -> PyProposition {
        PyProposition(self.0.antecedent.clone())
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
