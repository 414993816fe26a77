//! From tokens to steps: each function below reads one line of the grammar.

use super::function::{CONSTANTS, Function, NAMED};
use super::{Expression, MAX_CHARACTERS, MAX_NESTING, Step};
use crate::error::hint;
use crate::lexer::{Fault, Kind, Reader, shown};

type Result<T = ()> = std::result::Result<T, Fault>;

const COMPARISONS: [(&str, Function); 4] = [
    ("<", Function::Less),
    ("<=", Function::LessOrEqual),
    (">", Function::Greater),
    (">=", Function::GreaterOrEqual),
];
const SUMS: [(&str, Function); 2] = [("+", Function::Add), ("-", Function::Subtract)];
const PRODUCTS: [(&str, Function); 2] = [("*", Function::Multiply), ("/", Function::Divide)];

/// Reads a formula as far as it goes; what follows is left to the caller.
pub(crate) fn formula(reader: &mut Reader, variables: &[&str]) -> Result<Expression> {
    let (start, fault) = (reader.position(), reader.fault(""));
    let mut parser = Parser { reader, variables, code: Vec::new(), height: 0, stack: 0, levels: 0 };
    parser.formula()?;
    let Parser { code, stack, .. } = parser;
    let source = reader.text_since(start);
    if source.chars().nth(MAX_CHARACTERS).is_some() {
        let reason = format!("a formula has at most {MAX_CHARACTERS} characters");
        return Err(Fault { reason, ..fault });
    }
    Ok(Expression { source, code, stack, variables: variables.len() })
}

struct Parser<'r, 't, 'a, 'v> {
    reader: &'r mut Reader<'t, 'a>,
    variables: &'v [&'v str],
    code: Vec<Step>,
    /// The number of intermediate results after the code, and the largest so far.
    height: usize,
    stack: usize,
    /// How many parentheses, functions, signs and powers are open.
    levels: usize,
}

impl Parser<'_, '_, '_, '_> {
    fn formula(&mut self) -> Result {
        self.sum()?;
        let Some(comparison) = self.take(&COMPARISONS) else { return Ok(()) };
        self.sum()?;
        self.push(Step::Apply(comparison))?;
        if COMPARISONS.iter().any(|(sign, _)| self.reader.at_sign(sign)) {
            return Err(self.reader.fault("comparisons cannot be chained; use parentheses"));
        }
        Ok(())
    }

    fn sum(&mut self) -> Result {
        self.chain(&SUMS, Self::product)
    }

    fn product(&mut self) -> Result {
        self.chain(&PRODUCTS, Self::factor)
    }

    /// Operands with operators between them, from left to right.
    fn chain(
        &mut self,
        operators: &[(&str, Function)],
        operand: fn(&mut Self) -> Result,
    ) -> Result {
        operand(self)?;
        while let Some(operator) = self.take(operators) {
            operand(self)?;
            self.push(Step::Apply(operator))?;
        }
        Ok(())
    }

    fn factor(&mut self) -> Result {
        if self.reader.take_sign("-") {
            self.nested(Self::factor)?;
            return self.push(Step::Apply(Function::Negate));
        }
        self.operand()?;
        if self.reader.take_sign("^") {
            self.nested(Self::factor)?;
            self.push(Step::Apply(Function::Power))?;
        }
        Ok(())
    }

    fn operand(&mut self) -> Result {
        match self.reader.peek() {
            Some(&Kind::Number(value)) => self.read(Step::Constant(value)),
            Some(Kind::Quoted(name)) => match self.variable(name) {
                Some(variable) => self.read(variable),
                None => Err(self.unknown("variable", name, self.variables.to_vec())),
            },
            Some(Kind::Word(name)) => self.word(name),
            Some(Kind::Sign("(")) => {
                self.reader.advance();
                self.nested(Self::formula)?;
                self.close()
            }
            _ => Err(self.reader.expected("a number, a name or \"(\"", &[])),
        }
    }

    /// A function call, a variable or a constant.
    fn word(&mut self, name: &str) -> Result {
        let function = Function::named(name);
        let called = matches!(self.reader.peek_after(1), Some(Kind::Sign("(")));
        if let (Some(function), true) = (function, called) {
            return self.call(name, function);
        }
        if let Some(variable) = self.variable(name) {
            return self.read(variable);
        }
        if let Some(&(_, value)) = CONSTANTS.iter().find(|(known, _)| *known == name) {
            return self.read(Step::Constant(value));
        }
        if function.is_some() {
            self.reader.advance();
            return Err(self.reader.expected(&format!("\"(\" after \"{name}\""), &[]));
        }
        let functions = NAMED.iter().map(|(known, _)| *known);
        if called {
            return Err(self.unknown("function", name, functions.collect()));
        }
        let constants = CONSTANTS.iter().map(|(known, _)| *known);
        let known = self.variables.iter().copied().chain(constants).chain(functions);
        Err(self.unknown("name", name, known.collect()))
    }

    /// The arguments of a function and the function itself.
    fn call(&mut self, name: &str, function: Function) -> Result {
        let at = self.reader.offset();
        self.reader.advance();
        self.reader.advance();
        let mut count = 0;
        loop {
            self.nested(Self::formula)?;
            count += 1;
            if function.is_variadic() && count > 1 {
                self.push(Step::Apply(function))?;
            }
            if !self.reader.take_sign(",") {
                break;
            }
        }
        self.close()?;
        let arity = function.arity();
        if function.is_variadic() && count >= arity {
            return Ok(());
        }
        if count != arity {
            let least = if function.is_variadic() { "at least " } else { "" };
            let numbers = if arity == 1 { "number" } else { "numbers" };
            let reason = format!("\"{name}\" takes {least}{arity} {numbers}, got {count}");
            return Err(Fault { at, reason });
        }
        self.push(Step::Apply(function))
    }

    fn close(&mut self) -> Result {
        if self.reader.take_sign(")") {
            return Ok(());
        }
        Err(self.reader.expected("an operator or \")\"", &[]))
    }

    fn variable(&self, name: &str) -> Option<Step> {
        self.variables.iter().position(|known| *known == name).map(Step::Variable)
    }

    fn unknown(&self, kind: &str, name: &str, known: Vec<&str>) -> Fault {
        self.reader.fault(format!("unknown {kind} \"{}\"{}", shown(name), hint(name, &known)))
    }

    /// The operator that comes next; it has been read.
    fn take(&mut self, operators: &[(&str, Function)]) -> Option<Function> {
        let (_, operator) = operators.iter().find(|(sign, _)| self.reader.at_sign(sign))?;
        self.reader.advance();
        Some(*operator)
    }

    /// Parses one level deeper. The limit keeps a hostile text from exhausting the stack.
    fn nested(&mut self, parse: fn(&mut Self) -> Result) -> Result {
        if self.levels == MAX_NESTING {
            return Err(self.too_deep());
        }
        self.levels += 1;
        parse(self)?;
        self.levels -= 1;
        Ok(())
    }

    fn too_deep(&self) -> Fault {
        self.reader.fault(format!("the formula is nested more than {MAX_NESTING} levels deep"))
    }

    /// Makes the next token a step.
    fn read(&mut self, step: Step) -> Result {
        self.push(step)?;
        self.reader.advance();
        Ok(())
    }

    fn push(&mut self, step: Step) -> Result {
        match step {
            Step::Apply(function) => self.height -= function.arity() - 1,
            _ if self.height == MAX_NESTING => return Err(self.too_deep()),
            _ => self.height += 1,
        }
        self.stack = self.stack.max(self.height);
        self.code.push(step);
        Ok(())
    }
}
