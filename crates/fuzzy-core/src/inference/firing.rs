//! How strongly each rule fires: antecedents as one list of operations.
//!
//! The degree of a term that several rules share is taken once, and so is any part that
//! antecedents have in common, such as `x is a and y is b` in `x is a and y is b and z is c`.

use std::collections::HashMap;

use super::layout::{Run, TermSlot};
use crate::error::{Error, Result};
use crate::hedge::Hedge;
use crate::math::{Numbers, Real, Scalar};
use crate::norm::{SNorm, TNorm};
use crate::rule::{Antecedent, Rule};
use crate::variable::Variable;

/// The hedge that Antecedent::Not applies.
const NOT: &str = "not";

/// The antecedents of all rules, compiled. The nodes are the terms and then the operations, each
/// of which has the degree of one more node as its result.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Firing {
    conjunction: TNorm,
    disjunction: SNorm,
    hedges: Vec<Hedge>,
    terms: Vec<TermSlot>,
    runs: Vec<Run>,
    operations: Vec<Operations>,
    operation_count: usize,
    rules: Vec<usize>,
}

/// Operations of one kind, one after the other.
#[derive(Debug, Clone, PartialEq)]
enum Operations {
    And(Vec<[usize; 2]>),
    Or(Vec<[usize; 2]>),
    /// The hedge with this index applied to a node.
    Hedge(usize, usize),
}

/// Node numbers while terms are still being found: terms and operations are counted apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Node {
    Term(usize),
    Operation(usize),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Step {
    And(Node, Node),
    Or(Node, Node),
    Hedge(usize, Node),
}

struct Compiler<'a> {
    inputs: &'a [Variable],
    hedges: &'a [Hedge],
    terms: Vec<(usize, usize)>,
    steps: Vec<Step>,
    known_terms: HashMap<(usize, usize), Node>,
    known_steps: HashMap<Step, Node>,
}

impl Compiler<'_> {
    fn antecedent(&mut self, antecedent: &Antecedent) -> Result<Node> {
        match antecedent {
            Antecedent::Is { variable, hedges, term } => {
                let node = self.term(find_term(self.inputs, variable, term)?);
                hedges.iter().rev().try_fold(node, |node, hedge| self.hedge(hedge, node))
            }
            Antecedent::And(parts) => self.chain(parts, Step::And),
            Antecedent::Or(parts) => self.chain(parts, Step::Or),
            Antecedent::Not(part) => {
                let node = self.antecedent(part)?;
                self.hedge(NOT, node)
            }
            Antecedent::Hedged { hedge, of } => {
                let node = self.antecedent(of)?;
                self.hedge(hedge, node)
            }
        }
    }

    fn chain(&mut self, parts: &[Antecedent], join: fn(Node, Node) -> Step) -> Result<Node> {
        let mut joined = None;
        for part in parts {
            let node = self.antecedent(part)?;
            joined = Some(match joined {
                None => node,
                Some(earlier) => self.step(join(earlier, node)),
            });
        }
        joined.ok_or_else(|| Error::wrong_shape("parts of an antecedent", "at least 1", 0))
    }

    fn hedge(&mut self, name: &str, node: Node) -> Result<Node> {
        Ok(self.step(Step::Hedge(find_hedge(self.hedges, name)?, node)))
    }

    fn term(&mut self, term: (usize, usize)) -> Node {
        *self.known_terms.entry(term).or_insert_with(|| {
            self.terms.push(term);
            Node::Term(self.terms.len() - 1)
        })
    }

    fn step(&mut self, step: Step) -> Node {
        *self.known_steps.entry(step).or_insert_with(|| {
            self.steps.push(step);
            Node::Operation(self.steps.len() - 1)
        })
    }
}

/// The numbers of an input and of its term.
fn find_term(inputs: &[Variable], variable: &str, term: &str) -> Result<(usize, usize)> {
    let unknown = || Error::unknown_name("input", variable, inputs.iter().map(Variable::name));
    let input = inputs.iter().position(|input| input.name() == variable).ok_or_else(unknown)?;
    Ok((input, inputs[input].position(term)?))
}

/// The number of a hedge.
pub(super) fn find_hedge(hedges: &[Hedge], name: &str) -> Result<usize> {
    let unknown = || Error::unknown_name("hedge", name, hedges.iter().map(Hedge::name));
    hedges.iter().position(|hedge| hedge.name() == name).ok_or_else(unknown)
}

impl Firing {
    /// Compiles the antecedents of checked rules. `slots` has the terms of each input.
    pub(super) fn new(
        rules: &[Rule],
        inputs: &[Variable],
        hedges: Vec<Hedge>,
        (conjunction, disjunction): (TNorm, SNorm),
        slots: &[Vec<TermSlot>],
    ) -> Result<Self> {
        let mut compiler = Compiler {
            inputs,
            hedges: &hedges,
            terms: Vec::new(),
            steps: Vec::new(),
            known_terms: HashMap::new(),
            known_steps: HashMap::new(),
        };
        let nodes = rules
            .iter()
            .map(|rule| compiler.antecedent(&rule.antecedent))
            .collect::<Result<Vec<Node>>>()?;
        let Compiler { terms: used, steps, .. } = compiler;
        // Terms of one input stand together, so that their degrees are taken in one loop.
        let mut sorted = used.clone();
        sorted.sort_unstable();
        let number = |node: Node| match node {
            Node::Term(index) => sorted.partition_point(|term| *term < used[index]),
            Node::Operation(index) => used.len() + index,
        };
        let mut operations: Vec<Operations> = Vec::new();
        for step in &steps {
            match (*step, operations.last_mut()) {
                (Step::And(a, b), Some(Operations::And(pairs)))
                | (Step::Or(a, b), Some(Operations::Or(pairs))) => {
                    pairs.push([number(a), number(b)]);
                }
                (Step::And(a, b), _) => {
                    operations.push(Operations::And(vec![[number(a), number(b)]]));
                }
                (Step::Or(a, b), _) => {
                    operations.push(Operations::Or(vec![[number(a), number(b)]]));
                }
                (Step::Hedge(hedge, node), _) => {
                    operations.push(Operations::Hedge(hedge, number(node)));
                }
            }
        }
        let rules = nodes.into_iter().map(number).collect();
        let operation_count = steps.len();
        let terms: Vec<TermSlot> = sorted.iter().map(|&(input, term)| slots[input][term]).collect();
        let owners = sorted.iter().map(|&(input, _)| input);
        let runs = Run::of_terms(owners.zip(terms.iter().copied()));
        Ok(Self {
            conjunction,
            disjunction,
            hedges,
            terms,
            runs,
            operations,
            operation_count,
            rules,
        })
    }

    /// The number of degrees that [`fire`](Self::fire) writes: terms, operations, then rules.
    pub(super) fn scratch_count(&self) -> usize {
        self.first_rule() + self.rules.len()
    }

    /// Where the strengths of the rules begin in the scratch.
    pub(super) fn first_rule(&self) -> usize {
        self.terms.len() + self.operation_count
    }

    /// Prepares the terms that rules ask for.
    pub(super) fn prepare<N: Scalar>(&self, parameters: &[N]) -> Vec<N> {
        let count = self.terms.iter().map(|term| term.prepared_count()).sum();
        let mut prepared = vec![N::splat(0.0); count];
        let mut rest = prepared.as_mut_slice();
        for term in &self.terms {
            let (own, others) = rest.split_at_mut(term.prepared_count());
            term.prepare(parameters, own);
            rest = others;
        }
        prepared
    }

    /// Writes the degrees of all nodes and then the rules' firing strengths, each the degree of
    /// its antecedent times its weight.
    #[inline(always)]
    pub(super) fn fire<N: Scalar, R: Real>(
        &self,
        prepared: &[N],
        weights: &[N],
        x: &[R],
        scratch: &mut [R],
    ) where
        [N]: Numbers<R>,
    {
        self.runs.iter().for_each(|run| run.write(prepared, x, scratch));
        // The usual norms are named here, so that their loops hold no decision.
        match self.conjunction {
            TNorm::Min => self.operate(scratch, R::min),
            TNorm::Product => self.operate(scratch, |a, b| a * b),
            other => self.operate(scratch, |a, b| other.apply(a, b)),
        }
        let (nodes, strengths) = scratch.split_at_mut(self.first_rule());
        for ((rule, &node), strength) in self.rules.iter().enumerate().zip(strengths) {
            *strength = nodes[node] * weights.number(rule);
        }
    }

    #[inline(always)]
    fn operate<R: Real>(&self, scratch: &mut [R], and: impl Fn(R, R) -> R) {
        let mut next = self.terms.len();
        for operations in &self.operations {
            match operations {
                Operations::And(pairs) => next = join(pairs, scratch, next, &and),
                Operations::Or(pairs) => {
                    next = join(pairs, scratch, next, |a, b| self.disjunction.apply(a, b));
                }
                Operations::Hedge(hedge, node) => {
                    scratch[next] = self.hedges[*hedge].apply(scratch[*node]);
                    next += 1;
                }
            }
        }
    }
}

/// Writes the results of a norm from node `next` on, and returns the node behind them.
#[inline(always)]
fn join<R: Real>(
    pairs: &[[usize; 2]],
    scratch: &mut [R],
    next: usize,
    norm: impl Fn(R, R) -> R,
) -> usize {
    for (&[a, b], result) in pairs.iter().zip(next..) {
        scratch[result] = norm(scratch[a], scratch[b]);
    }
    next + pairs.len()
}
