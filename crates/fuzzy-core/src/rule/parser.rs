//! From tokens to rules: each function below reads one line of the grammar, and resolves the names.

use std::ops::Range;

use super::vocabulary::{Words, too_deep, weight};
use super::{
    Antecedent, Conclusion, Consequent, KEYWORDS, MAX_CHARACTERS, MAX_NESTING, NOT, Rule,
    Vocabulary,
};
use crate::error::{Error, Result};
use crate::expression::formula;
use crate::lexer::{Fault, Kind, Reader, Token, tokens};

/// The rules of a text, numbered from 1 in messages.
///
/// Each begins on a line of its own with `if`; see [the module](super) for the whole grammar.
pub fn parse_rules(text: &str, vocabulary: &Vocabulary) -> Result<Vec<Rule>> {
    check_length(text)?;
    let tokens = tokens(text);
    let inputs = vocabulary.input_names();
    let ranges = split(text, &tokens);
    let parse = |(index, range): (usize, Range<usize>)| {
        parse_tokens(text, &tokens[range], vocabulary, &inputs, index + 1)
    };
    ranges.into_iter().enumerate().map(parse).collect()
}

/// The one rule of a text.
pub(super) fn parse_rule(text: &str, vocabulary: &Vocabulary, number: usize) -> Result<Rule> {
    check_length(text)?;
    parse_tokens(text, &tokens(text), vocabulary, &vocabulary.input_names(), number)
}

fn check_length(text: &str) -> Result<()> {
    if text.chars().nth(MAX_CHARACTERS).is_none() {
        return Ok(());
    }
    let most = format!("at most {MAX_CHARACTERS}");
    Err(Error::wrong_shape("characters of a text of rules", most, text.chars().count()))
}

/// Where the tokens of each rule are.
fn split(text: &str, tokens: &[Token]) -> Vec<Range<usize>> {
    let mut starts = Vec::new();
    let (mut end, mut open) = (0, 0_usize);
    for (index, token) in tokens.iter().enumerate() {
        let first = index == 0;
        if first || (open == 0 && begins_rule(&text[end..token.start], &token.kind)) {
            starts.push(index);
        }
        open = match token.kind {
            Kind::Sign("(") => open + 1,
            Kind::Sign(")") => open.saturating_sub(1),
            _ => open,
        };
        end = token.end;
    }
    let ends = starts.iter().copied().skip(1).chain([tokens.len()]);
    starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect()
}

/// Whether a token outside parentheses begins a rule; `gap` is what separates it from the one
/// before.
fn begins_rule(gap: &str, token: &Kind) -> bool {
    let begins_line = gap.contains('\n');
    let indented = !gap.ends_with('\n');
    begins_line && (!indented || matches!(token, Kind::Word(word) if is_keyword(word, "if")))
}

fn is_keyword(word: &str, keyword: &str) -> bool {
    word.eq_ignore_ascii_case(keyword)
}

fn parse_tokens(
    text: &str,
    tokens: &[Token],
    vocabulary: &Vocabulary,
    inputs: &[&str],
    number: usize,
) -> Result<Rule> {
    let reader = Reader::new(text, tokens);
    let mut parser = Parser { reader, vocabulary, inputs, levels: 0 };
    parser.rule().map_err(|fault| located(text, fault, number))
}

/// The error that a fault is, with its line and column.
fn located(text: &str, fault: Fault, rule: usize) -> Error {
    let before = &text[..fault.at];
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
    let several = text.trim().contains('\n');
    Error::Rule { rule, line: several.then_some(line), column: Some(column), reason: fault.reason }
}

struct Parser<'p, 't, 'a> {
    reader: Reader<'t, 'a>,
    vocabulary: &'p Vocabulary,
    inputs: &'p [&'p str],
    /// How many parentheses, hedges and `not`s are open.
    levels: usize,
}

type Parsed<T> = Result<T, Fault>;

impl<'p> Parser<'p, '_, '_> {
    fn rule(&mut self) -> Parsed<Rule> {
        self.keyword("if")?;
        let antecedent = self.antecedent()?;
        if !self.reader.take_word("then") {
            return Err(self
                .reader
                .expected("\"and\", \"or\" or \"then\"", &["and", "or", "then"]));
        }
        let mut conclusions = vec![self.conclusion()?];
        while self.reader.take_word("and") || self.reader.take_sign(",") {
            conclusions.push(self.conclusion()?);
        }
        let weight = if self.reader.take_word("with") { self.weight()? } else { 1.0 };
        self.reader.take_sign(";");
        match self.reader.peek() {
            None => Ok(Rule { antecedent, conclusions, weight }),
            Some(_) => {
                let expected = "\"and\", \",\", \"with\" or the end of the rule";
                Err(self.reader.expected(expected, &["and", "with"]))
            }
        }
    }

    fn antecedent(&mut self) -> Parsed<Antecedent> {
        self.chain("or", Self::conjunction, Antecedent::Or)
    }

    fn conjunction(&mut self) -> Parsed<Antecedent> {
        self.chain("and", Self::prefixed, Antecedent::And)
    }

    /// One operand, or several with a connective between them.
    fn chain(
        &mut self,
        connective: &str,
        operand: fn(&mut Self) -> Parsed<Antecedent>,
        join: fn(Vec<Antecedent>) -> Antecedent,
    ) -> Parsed<Antecedent> {
        let first = operand(self)?;
        if !self.reader.at_word(connective) {
            return Ok(first);
        }
        let mut operands = vec![first];
        while self.reader.take_word(connective) {
            operands.push(operand(self)?);
        }
        Ok(join(operands))
    }

    fn prefixed(&mut self) -> Parsed<Antecedent> {
        if self.reader.take_word(NOT) {
            return Ok(Antecedent::Not(Box::new(self.nested(Self::reached)?)));
        }
        if self.at_hedge() {
            let (at, hedge) = self.name("a hedge")?;
            self.vocabulary.hedge(&hedge).map_err(|reason| Fault { at, reason })?;
            let of = Box::new(self.nested(Self::reached)?);
            return Ok(Antecedent::Hedged { hedge, of });
        }
        if self.reader.take_sign("(") {
            return self.nested(Self::group);
        }
        self.proposition()
    }

    /// What a hedge or `not` reaches. Parentheses right behind it open no further level, so that
    /// a tree has as many levels whether they are written or not.
    fn reached(&mut self) -> Parsed<Antecedent> {
        if self.reader.take_sign("(") { self.group() } else { self.prefixed() }
    }

    fn group(&mut self) -> Parsed<Antecedent> {
        let antecedent = self.antecedent()?;
        if self.reader.take_sign(")") {
            return Ok(antecedent);
        }
        Err(self.reader.expected("\"and\", \"or\" or \")\"", &["and", "or"]))
    }

    /// Whether the next name is a hedge before a condition rather than an input.
    fn at_hedge(&self) -> bool {
        let (Some(name), Some(next)) = (self.reader.peek(), self.reader.peek_after(1)) else {
            return false;
        };
        match (name_of(name), next) {
            (Some(name), Kind::Sign("(")) => {
                self.vocabulary.has_hedge(name) || !self.inputs.contains(&name)
            }
            (Some(name), next) => begins_term(next) && self.vocabulary.has_hedge(name),
            (None, _) => false,
        }
    }

    fn proposition(&mut self) -> Parsed<Antecedent> {
        let (at, variable) = self.name("an input, \"not\", a hedge or \"(\"")?;
        let input = self.vocabulary.input(&variable).map_err(|reason| Fault { at, reason })?;
        self.keyword("is")?;
        let (hedges, term) = self.term(input)?;
        Ok(Antecedent::Is { variable, hedges, term })
    }

    fn conclusion(&mut self) -> Parsed<Conclusion> {
        let (at, name) = self.name("an output")?;
        let output = self.vocabulary.output(&name).map_err(|reason| Fault { at, reason })?;
        let value = if self.reader.take_sign("=") {
            Consequent::Formula(formula(&mut self.reader, self.inputs)?)
        } else if self.reader.take_word("is") {
            let (hedges, term) = self.term(output)?;
            Consequent::Term { hedges, term }
        } else {
            return Err(self.reader.expected("\"is\" or \"=\"", &["is"]));
        };
        Ok(Conclusion { output: name, value })
    }

    /// The hedges before a term of a variable, and the term.
    fn term(&mut self, variable: &'p Words) -> Parsed<(Vec<String>, String)> {
        let mut hedges = Vec::new();
        loop {
            if self.reader.take_word(NOT) {
                hedges.push(NOT.to_owned());
                continue;
            }
            let (at, name) = self.name(&format!("a term of \"{}\"", variable.name))?;
            let fault = |reason| Fault { at, reason };
            // The last name is the term, even if a hedge has the same name.
            let last = !self.reader.peek().is_some_and(begins_term);
            if !last && self.vocabulary.has_hedge(&name) {
                hedges.push(name);
                continue;
            }
            // A term that another name follows lacks an "and", which the caller will say.
            if !last && !variable.has_term(&name) {
                self.vocabulary.hedge(&name).map_err(fault)?;
            }
            variable.term(&name).map_err(fault)?;
            return Ok((hedges, name));
        }
    }

    fn weight(&mut self) -> Parsed<f64> {
        let Some(&Kind::Number(value)) = self.reader.peek() else {
            return Err(self.reader.expected("a weight between 0 and 1", &[]));
        };
        weight(value).map_err(|reason| self.reader.fault(reason))?;
        self.reader.advance();
        Ok(value)
    }

    /// Reads a name, and where it begins.
    fn name(&mut self, expected: &str) -> Parsed<(usize, String)> {
        match self.reader.peek().and_then(name_of) {
            Some(name) => {
                let at = self.reader.offset();
                self.reader.advance();
                Ok((at, name.to_owned()))
            }
            None => Err(self.reader.expected(expected, &[])),
        }
    }

    fn keyword(&mut self, keyword: &str) -> Parsed<()> {
        if self.reader.take_word(keyword) {
            return Ok(());
        }
        Err(self.reader.expected(&format!("\"{keyword}\""), &[keyword]))
    }

    /// Parses one level deeper. The limit keeps a hostile text from exhausting the stack.
    fn nested(&mut self, parse: fn(&mut Self) -> Parsed<Antecedent>) -> Parsed<Antecedent> {
        if self.levels == MAX_NESTING {
            return Err(self.reader.fault(too_deep()));
        }
        self.levels += 1;
        let parsed = parse(self)?;
        self.levels -= 1;
        Ok(parsed)
    }
}

/// The name that a token is: between quotes anything, otherwise no keyword.
fn name_of<'a>(token: &'a Kind) -> Option<&'a str> {
    match token {
        Kind::Word(word) if KEYWORDS.iter().any(|keyword| is_keyword(word, keyword)) => None,
        Kind::Word(word) => Some(word),
        Kind::Quoted(name) => Some(name),
        _ => None,
    }
}

/// Whether a term, or a hedge before it, may begin with the token.
fn begins_term(token: &Kind) -> bool {
    name_of(token).is_some() || matches!(token, Kind::Word(word) if is_keyword(word, NOT))
}
