//! Outputs of rule systems: what rules may conclude, and how it becomes a number.

use crate::check;
use crate::error::{Error, Result};
use crate::expression::Expression;
use crate::inference::NoRuleFires;
use crate::membership::MembershipFunction;
use crate::norm::{Aggregation, SNorm, TNorm};
use crate::variable::Variable;

/// How an aggregated fuzzy set becomes a number.
///
/// With the samples y of the universe and the degrees A(y) of the aggregated set:
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Defuzzifier {
    /// Σ y·A(y) / Σ A(y), the centre of area (2.7).
    Centroid,
    /// The first sample at which the running sum of A reaches half of the whole.
    Bisector,
    /// The mean of the samples where A is largest.
    MeanOfMaximum,
    /// The smallest sample where A is largest.
    SmallestOfMaximum,
    /// The largest sample where A is largest.
    LargestOfMaximum,
    /// Σ w·c / Σ w over the rules, with the firing strength w and the centre c of the concluded
    /// term: the discrete form, which needs no samples, implication or aggregation.
    Height,
}

impl Defuzzifier {
    /// Every defuzzifier of fuzzy sets.
    pub const ALL: [Self; 6] = [
        Self::Centroid,
        Self::Bisector,
        Self::MeanOfMaximum,
        Self::SmallestOfMaximum,
        Self::LargestOfMaximum,
        Self::Height,
    ];

    /// The name that files and messages use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Centroid => "centroid",
            Self::Bisector => "bisector",
            Self::MeanOfMaximum => "mean_of_maximum",
            Self::SmallestOfMaximum => "smallest_of_maximum",
            Self::LargestOfMaximum => "largest_of_maximum",
            Self::Height => "height",
        }
    }

    /// The defuzzifier with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("defuzzifier", name, Self::ALL, Self::name)
    }
}

/// Where an aggregated set is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sampling {
    /// At so many points from one end of the universe to the other, ends included, as in MATLAB.
    Endpoints(usize),
    /// In the middles of so many equal parts of the universe, as in fuzzylite.
    Midpoints(usize),
    /// Everywhere: the centroid's integrals are taken piece by piece without an error. For
    /// piecewise-linear terms, min or product as implication and max as aggregation.
    Exact,
}

/// The most samples of an aggregated set.
const MOST_SAMPLES: usize = 100_001;
/// The most terms of an output whose centroid is exact: the work in a segment grows with their
/// fourth power where all of them overlap.
const MOST_EXACT_TERMS: usize = 16;
/// The most parameters of their terms: the segments grow with them, and each asks all terms.
const MOST_EXACT_PARAMETERS: usize = 1024;

impl Sampling {
    /// The name that files and messages use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Endpoints(_) => "endpoints",
            Self::Midpoints(_) => "midpoints",
            Self::Exact => "exact",
        }
    }

    /// The sampling with this name and number of samples.
    pub fn from_name(name: &str, samples: usize) -> Result<Self> {
        match name {
            "endpoints" => Ok(Self::Endpoints(samples)),
            "midpoints" => Ok(Self::Midpoints(samples)),
            "exact" => Ok(Self::Exact),
            _ => Err(Error::unknown_name("sampling", name, ["endpoints", "midpoints", "exact"])),
        }
    }

    /// The number of samples; none if they are everywhere.
    pub fn count(self) -> Option<usize> {
        match self {
            Self::Endpoints(count) | Self::Midpoints(count) => Some(count),
            Self::Exact => None,
        }
    }

    /// The samples of the universe of a variable; none if they are everywhere.
    pub fn points(self, variable: &Variable) -> Vec<f64> {
        let (low, high) = (variable.universe().low(), variable.universe().high());
        // Rounding must not leave the universe, nor miss its upper end.
        let along = |share: f64| match share < 1.0 {
            true => share.mul_add(high - low, low).min(high),
            false => high,
        };
        match self {
            Self::Endpoints(count) => {
                (0..count).map(|k| along(k as f64 / (count - 1) as f64)).collect()
            }
            Self::Midpoints(count) => {
                (0..count).map(|k| along((k as f64 + 0.5) / count as f64)).collect()
            }
            Self::Exact => Vec::new(),
        }
    }
}

/// How weighted conclusions become a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Weighting {
    /// Σ w·z / Σ w (2.8).
    Average,
    /// Σ w·z.
    Sum,
}

impl Weighting {
    /// The name that files and messages use.
    pub fn name(self) -> &'static str {
        match self {
            Self::Average => "weighted_average",
            Self::Sum => "weighted_sum",
        }
    }

    /// The weighting with this name.
    pub fn from_name(name: &str) -> Result<Self> {
        check::named("defuzzifier", name, [Self::Average, Self::Sum], Self::name)
    }
}

/// What a rule of a Sugeno output concludes.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A constant (order 0).
    Constant(f64),
    /// The coefficients of the inputs and then a constant (order 1).
    Linear(Vec<f64>),
    /// A formula of the inputs, which has no parameters.
    Formula(Expression),
}

impl Value {
    /// A formula of these inputs: a constant or linear, with parameters, if that is what it is.
    pub fn parse(text: &str, inputs: &[&str]) -> Result<Self> {
        Ok(Self::from_formula(Expression::parse(text, inputs)?))
    }

    /// The same from a formula that has been read.
    pub fn from_formula(formula: Expression) -> Self {
        match formula.affine() {
            Some(coefficients) => match coefficients.split_last() {
                Some((&constant, rest)) if rest.iter().all(|&c| c == 0.0) => {
                    Self::Constant(constant)
                }
                _ => Self::Linear(coefficients),
            },
            None => Self::Formula(formula),
        }
    }

    /// The numbers that learners may change.
    pub fn parameters(&self) -> &[f64] {
        match self {
            Self::Constant(value) => std::slice::from_ref(value),
            Self::Linear(coefficients) => coefficients,
            Self::Formula(_) => &[],
        }
    }

    fn with_parameters(&self, parameters: &[f64]) -> Self {
        match self {
            Self::Constant(_) => Self::Constant(parameters[0]),
            Self::Linear(_) => Self::Linear(parameters.to_vec()),
            Self::Formula(formula) => Self::Formula(formula.clone()),
        }
    }
}

/// What the rules about an output conclude, and how that becomes a number.
#[derive(Debug, Clone, PartialEq)]
pub enum Method {
    /// Fuzzy sets: the implication shapes a term by the rule's strength (min clips, product
    /// scales as Larsen does), the aggregation joins what the rules say, the defuzzifier picks
    /// a number (2.3–2.7).
    Mamdani {
        /// What rules may conclude.
        variable: Variable,
        /// What rules implicate a term with.
        implication: TNorm,
        /// What joins the rules' sets.
        aggregation: Aggregation,
        /// What picks a number.
        defuzzifier: Defuzzifier,
        /// Where the set is looked at.
        sampling: Sampling,
    },
    /// Numbers or functions of the inputs (Takagi, Sugeno and Kang).
    Sugeno {
        /// The named conclusions.
        terms: Vec<(String, Value)>,
        /// How the strengths of rules with the same term are joined before weighting.
        aggregation: Aggregation,
        /// Average or sum.
        weighting: Weighting,
    },
    /// Monotone fuzzy sets: a rule of strength w concludes the number whose degree is w.
    Tsukamoto {
        /// What rules may conclude.
        variable: Variable,
        /// Average or sum.
        weighting: Weighting,
    },
}

/// An output of a rule [`System`](crate::System).
#[derive(Debug, Clone, PartialEq)]
pub struct Output {
    name: String,
    method: Method,
    no_rule_fires: NoRuleFires,
}

impl Output {
    /// A Mamdani output with min, max and the centroid of 101 samples, ends included: MATLAB's
    /// defaults.
    pub fn mamdani(variable: Variable) -> Result<Self> {
        Self::mamdani_with(
            variable,
            TNorm::Min,
            Aggregation::Norm(SNorm::Max),
            Defuzzifier::Centroid,
            Sampling::Endpoints(101),
        )
    }

    /// A Mamdani output; product as implication makes it Larsen's.
    pub fn mamdani_with(
        variable: Variable,
        implication: TNorm,
        aggregation: Aggregation,
        defuzzifier: Defuzzifier,
        sampling: Sampling,
    ) -> Result<Self> {
        let what = format!("samples of \"{}\"", variable.name());
        if let Sampling::Endpoints(count) | Sampling::Midpoints(count) = sampling {
            check::at_least(&what, count, 2)?;
            let expected = format!("at most {MOST_SAMPLES}");
            check::within(&what, count as f64, &expected, |n| n <= MOST_SAMPLES as f64)?;
        } else if defuzzifier != Defuzzifier::Height {
            check_exact(&variable, implication, aggregation, defuzzifier)?;
        }
        let name = named(&variable)?;
        let method = Method::Mamdani { variable, implication, aggregation, defuzzifier, sampling };
        Ok(Self { name, method, no_rule_fires: NoRuleFires::Error })
    }

    /// A Sugeno output whose rules conclude these terms, or formulas of their own.
    pub fn sugeno(name: &str, terms: Vec<(String, Value)>) -> Result<Self> {
        Self::sugeno_with(name, terms, Aggregation::Sum, Weighting::Average)
    }

    /// A Sugeno output with another way to join and weigh the conclusions.
    pub fn sugeno_with(
        name: &str,
        terms: Vec<(String, Value)>,
        aggregation: Aggregation,
        weighting: Weighting,
    ) -> Result<Self> {
        check::name("output", name)?;
        for (index, (term, value)) in terms.iter().enumerate() {
            check_term(name, term, &terms[..index])?;
            check::all_finite(&format!("{name}.{term}"), value.parameters())?;
        }
        Ok(Self {
            name: name.to_owned(),
            method: Method::Sugeno { terms, aggregation, weighting },
            no_rule_fires: NoRuleFires::Error,
        })
    }

    /// A Tsukamoto output; its terms must be monotone.
    pub fn tsukamoto(variable: Variable, weighting: Weighting) -> Result<Self> {
        for term in variable.terms() {
            if !term.function.shape().is_monotone() {
                return Err(unsuitable(
                    &variable,
                    &term.name,
                    &term.function,
                    "a Tsukamoto output needs a monotone one, such as ramp, sigmoid or s_shape",
                ));
            }
        }
        let name = named(&variable)?;
        let method = Method::Tsukamoto { variable, weighting };
        Ok(Self { name, method, no_rule_fires: NoRuleFires::Error })
    }

    /// The same output with another answer where no rule about it fires.
    pub fn when_no_rule_fires(mut self, answer: NoRuleFires) -> Result<Self> {
        if let NoRuleFires::Value(value) = answer {
            check::finite("the output when no rule fires", value)?;
        }
        self.no_rule_fires = answer;
        Ok(self)
    }

    /// The output's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its linguistic variable; a Sugeno output has none.
    pub fn variable(&self) -> Option<&Variable> {
        match &self.method {
            Method::Mamdani { variable, .. } | Method::Tsukamoto { variable, .. } => Some(variable),
            Method::Sugeno { .. } => None,
        }
    }

    /// How conclusions become a number.
    pub fn method(&self) -> &Method {
        &self.method
    }

    /// What the output is where no rule about it fires.
    pub fn no_rule_fires(&self) -> NoRuleFires {
        self.no_rule_fires
    }

    /// The names of the terms that rules may conclude.
    pub fn term_names(&self) -> Vec<&str> {
        match &self.method {
            Method::Sugeno { terms, .. } => terms.iter().map(|(name, _)| &**name).collect(),
            Method::Mamdani { variable, .. } | Method::Tsukamoto { variable, .. } => {
                variable.terms().iter().map(|term| &*term.name).collect()
            }
        }
    }

    /// The number of the term with this name.
    pub(crate) fn position(&self, term: &str) -> Result<usize> {
        let names = self.term_names();
        let found = names.iter().position(|name| *name == term);
        found.ok_or_else(|| Error::unknown_name("term", term, names))
    }

    /// The same Sugeno output with another value of a term.
    pub fn with_value(mut self, term: &str, value: Value) -> Result<Self> {
        check::all_finite(&format!("{}.{term}", self.name), value.parameters())?;
        let known = self.term_names().into_iter().map(str::to_owned).collect::<Vec<_>>();
        if let Method::Sugeno { terms, .. } = &mut self.method
            && let Some((_, old)) = terms.iter_mut().find(|(name, _)| name == term)
        {
            *old = value;
            return Ok(self);
        }
        Err(Error::unknown_name("term", term, known.iter().map(String::as_str)))
    }

    /// Adds the formula of a rule as a term of that name to a Sugeno output.
    pub(crate) fn add_formula(&mut self, term: &str, formula: Expression) -> Result<()> {
        let Method::Sugeno { terms, .. } = &mut self.method else {
            let reason = "only a Sugeno output takes a formula; conclude a term instead";
            return Err(Error::Unsuitable {
                what: format!("output \"{}\"", self.name),
                reason: reason.to_owned(),
            });
        };
        check_term(&self.name, term, terms)?;
        terms.push((term.to_owned(), Value::from_formula(formula)));
        Ok(())
    }

    /// The numbers that learners may change, term by term.
    pub fn parameters(&self) -> Vec<f64> {
        match &self.method {
            Method::Sugeno { terms, .. } => {
                terms.iter().flat_map(|(_, value)| value.parameters().to_vec()).collect()
            }
            Method::Mamdani { variable, .. } | Method::Tsukamoto { variable, .. } => {
                variable.parameters()
            }
        }
    }

    /// The same output with other numbers.
    pub(crate) fn with_parameters(&self, parameters: &[f64]) -> Result<Self> {
        let mut other = self.clone();
        match &mut other.method {
            Method::Mamdani { variable, .. } | Method::Tsukamoto { variable, .. } => {
                *variable = variable.with_parameters(parameters)?;
            }
            Method::Sugeno { terms, .. } => {
                let mut rest = parameters;
                for (name, value) in terms {
                    let (own, others) = rest.split_at(value.parameters().len());
                    check::all_finite(&format!("{}.{name}", self.name), own)?;
                    *value = value.with_parameters(own);
                    rest = others;
                }
            }
        }
        Ok(other)
    }
}

/// The name of a variable that can be an output.
fn named(variable: &Variable) -> Result<String> {
    check::at_least(&format!("terms of \"{}\"", variable.name()), variable.terms().len(), 1)?;
    Ok(variable.name().to_owned())
}

/// Nothing, if a term of this name may join the others.
fn check_term(output: &str, term: &str, others: &[(String, Value)]) -> Result<()> {
    check::name("term", term)?;
    if others.iter().any(|(other, _)| other == term) {
        let place = format!("output \"{output}\"");
        return Err(Error::DuplicateName { kind: "term", name: term.to_owned(), place });
    }
    Ok(())
}

/// Nothing, if the centroid of this output can be taken without samples.
fn check_exact(
    variable: &Variable,
    implication: TNorm,
    aggregation: Aggregation,
    defuzzifier: Defuzzifier,
) -> Result<()> {
    if variable.terms().len() > MOST_EXACT_TERMS {
        let reason = format!("exact sampling takes at most {MOST_EXACT_TERMS} terms");
        return Err(Error::Unsuitable { what: format!("output \"{}\"", variable.name()), reason });
    }
    if variable.parameter_count() > MOST_EXACT_PARAMETERS {
        let reason = format!(
            "exact sampling takes at most {MOST_EXACT_PARAMETERS} parameters of terms; use \
             endpoints or midpoints"
        );
        return Err(Error::Unsuitable { what: format!("output \"{}\"", variable.name()), reason });
    }
    for term in variable.terms() {
        if !term.function.shape().is_piecewise_linear() {
            let reason = "exact sampling needs piecewise-linear ones; use endpoints or midpoints";
            return Err(unsuitable(variable, &term.name, &term.function, reason));
        }
    }
    let simple = matches!(implication, TNorm::Min | TNorm::Product)
        && aggregation == Aggregation::Norm(SNorm::Max)
        && defuzzifier == Defuzzifier::Centroid;
    if simple {
        return Ok(());
    }
    let reason = "exact sampling needs min or product as implication, max as aggregation and the \
                  centroid; use endpoints or midpoints for others";
    let what = format!("output \"{}\"", variable.name());
    Err(Error::Unsuitable { what, reason: reason.to_owned() })
}

fn unsuitable(
    variable: &Variable,
    term: &str,
    function: &MembershipFunction,
    reason: &str,
) -> Error {
    let shape = function.shape().name();
    let what = format!("the {shape} term \"{term}\" of \"{}\"", variable.name());
    Error::Unsuitable { what, reason: reason.to_owned() }
}
