//! The words and signs of the text languages, formulas and rules, and a reader that walks them.
//!
//! White space and comments from `#` to the end of the line separate tokens and mean nothing else.

use crate::error::nearest;

/// What is wrong at a place in a text. Its language makes an [`Error`](crate::Error) of it.
#[derive(Debug)]
pub(crate) struct Fault {
    /// The place, in bytes from the beginning of the text.
    pub at: usize,
    /// What is wrong.
    pub reason: String,
}

/// One word or sign.
#[derive(Debug)]
pub(crate) struct Token<'a> {
    pub kind: Kind<'a>,
    /// Its first byte.
    pub start: usize,
    /// The byte behind it.
    pub end: usize,
}

#[derive(Debug)]
pub(crate) enum Kind<'a> {
    /// A letter or `_`, then letters, digits and `_`.
    Word(&'a str),
    /// A name between quotes, without them.
    Quoted(String),
    Number(f64),
    Sign(&'static str),
    /// Something that is none of these, and why; an error only if a reader gets that far.
    Bad(String),
}

/// Longer signs come before those that they begin with.
const SIGNS: [&str; 14] = ["<=", ">=", "<", ">", "=", "+", "-", "*", "/", "^", "(", ")", ",", ";"];

/// All tokens of a text.
pub(crate) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut start = 0;
    while let Some(first) = text[start..].chars().next() {
        if first.is_whitespace() {
            start += first.len_utf8();
        } else if first == '#' {
            start += text[start..].find('\n').unwrap_or(text.len() - start);
        } else {
            let (kind, length) = token(&text[start..], first);
            tokens.push(Token { kind, start, end: start + length });
            start += length;
        }
    }
    tokens
}

/// The token at the beginning of a text, and its length in bytes.
fn token(text: &str, first: char) -> (Kind<'_>, usize) {
    if begins_word(first) {
        let length = text.find(|c| !continues_word(c)).unwrap_or(text.len());
        return (Kind::Word(&text[..length]), length);
    }
    if let Some(length) = number_length(text.as_bytes()) {
        return (number(&text[..length]), length);
    }
    if first == '"' || first == '\'' {
        return quoted(text, first);
    }
    match SIGNS.into_iter().find(|sign| text.starts_with(sign)) {
        Some(sign) => (Kind::Sign(sign), sign.len()),
        None => (Kind::Bad(format!("unexpected character {first:?}")), first.len_utf8()),
    }
}

fn begins_word(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}

fn continues_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Whether a name needs no quotes, as far as its characters go.
pub(crate) fn is_word(name: &str) -> bool {
    name.starts_with(begins_word) && name.chars().all(continues_word)
}

/// The length of the number at the beginning of a text: digits with or without a point, and an
/// exponent.
fn number_length(text: &[u8]) -> Option<usize> {
    let digits = |from: usize| text[from..].iter().take_while(|c| c.is_ascii_digit()).count();
    let whole = digits(0);
    let mut length = whole;
    if text.get(length) == Some(&b'.') {
        let fraction = digits(length + 1);
        if whole + fraction > 0 {
            length += 1 + fraction;
        }
    }
    if length == 0 {
        return None;
    }
    if let Some(b'e' | b'E') = text.get(length) {
        let sign = usize::from(matches!(text.get(length + 1), Some(b'+' | b'-')));
        // Without digits the letter begins the next word.
        match text.get(length + 1 + sign) {
            Some(c) if c.is_ascii_digit() => length += 1 + sign + digits(length + 1 + sign),
            _ => {}
        }
    }
    Some(length)
}

fn number(text: &str) -> Kind<'_> {
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Kind::Number(value),
        _ => Kind::Bad(format!("the number {} is too large", shown(text))),
    }
}

/// A quoted name on one line. A quote in it is doubled or follows a backslash, a backslash may
/// follow another.
fn quoted(text: &str, quote: char) -> (Kind<'_>, usize) {
    let mut name = String::new();
    let mut characters = text.char_indices().skip(1).peekable();
    while let Some((at, c)) = characters.next() {
        let next = characters.peek().map(|&(_, next)| next);
        if c == '\n' {
            return (Kind::Bad("the quoted name does not end on its line".to_owned()), at);
        }
        let escapes = (c == '\\' && matches!(next, Some('\\' | '"' | '\'')))
            || (c == quote && next == Some(quote));
        if escapes {
            name.extend(next);
            characters.next();
        } else if c == quote {
            return (Kind::Quoted(name), at + 1);
        } else {
            name.push(c);
        }
    }
    (Kind::Bad("the quoted name does not end".to_owned()), text.len())
}

/// The name in double quotes, as [`tokens`] reads it.
pub(crate) fn quote(name: &str) -> String {
    format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""))
}

/// The beginning of a text that may be long, for messages.
pub(crate) fn shown(text: &str) -> String {
    const MOST: usize = 40;
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

/// Walks along the tokens of a formula or a rule.
pub(crate) struct Reader<'t, 'a> {
    text: &'a str,
    tokens: &'t [Token<'a>],
    position: usize,
}

impl<'t, 'a> Reader<'t, 'a> {
    /// A reader of some of the tokens of a text.
    pub fn new(text: &'a str, tokens: &'t [Token<'a>]) -> Self {
        Self { text, tokens, position: 0 }
    }

    /// The next token.
    pub fn peek(&self) -> Option<&'t Kind<'a>> {
        self.peek_after(0)
    }

    /// The token behind so many others.
    pub fn peek_after(&self, others: usize) -> Option<&'t Kind<'a>> {
        self.tokens.get(self.position + others).map(|token| &token.kind)
    }

    /// Goes on to the token behind the next.
    pub fn advance(&mut self) {
        self.position += 1;
    }

    /// Whether the sign comes next.
    pub fn at_sign(&self, sign: &str) -> bool {
        matches!(self.peek(), Some(Kind::Sign(next)) if *next == sign)
    }

    /// Whether the sign came next; if so, it has been read.
    pub fn take_sign(&mut self, sign: &str) -> bool {
        let found = self.at_sign(sign);
        self.position += usize::from(found);
        found
    }

    /// Whether the word comes next, in small or large letters.
    pub fn at_word(&self, word: &str) -> bool {
        matches!(self.peek(), Some(Kind::Word(next)) if next.eq_ignore_ascii_case(word))
    }

    /// Whether the word came next; if so, it has been read.
    pub fn take_word(&mut self, word: &str) -> bool {
        let found = self.at_word(word);
        self.position += usize::from(found);
        found
    }

    /// How many tokens have been read.
    pub fn position(&self) -> usize {
        self.position
    }

    /// Where the next token begins, or where the last one ends.
    pub fn offset(&self) -> usize {
        match (self.tokens.get(self.position), self.tokens.last()) {
            (Some(next), _) => next.start,
            (None, Some(last)) => last.end,
            (None, None) => 0,
        }
    }

    /// The tokens that have been read since a position as a text of one line, without comments.
    pub fn text_since(&self, position: usize) -> String {
        let mut text = String::new();
        let mut end = None;
        for token in &self.tokens[position..self.position] {
            if end.is_some_and(|end| end < token.start) {
                text.push(' ');
            }
            text.push_str(&self.text[token.start..token.end]);
            end = Some(token.end);
        }
        text
    }

    /// A fault at the next token.
    pub fn fault(&self, reason: impl Into<String>) -> Fault {
        Fault { at: self.offset(), reason: reason.into() }
    }

    /// The fault that the next token is not what it should be: words and signs, or in words.
    pub fn expected(&self, expected: &str, words: &[&str]) -> Fault {
        let found = match self.tokens.get(self.position) {
            None => "the end".to_owned(),
            Some(Token { kind: Kind::Bad(reason), .. }) => return self.fault(reason),
            Some(token) => {
                let text = shown(&self.text[token.start..token.end]);
                if matches!(token.kind, Kind::Quoted(_)) { text } else { format!("\"{text}\"") }
            }
        };
        let meant = match self.peek() {
            Some(Kind::Word(word)) => nearest(word, words),
            _ => None,
        };
        self.fault(match meant {
            Some(word) => format!("expected \"{word}\", found {found}; did you mean \"{word}\"?"),
            None => format!("expected {expected}, found {found}"),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Vec<String> {
        let show = |token: &Token| match &token.kind {
            Kind::Word(word) => (*word).to_owned(),
            Kind::Quoted(name) => format!("<{name}>"),
            Kind::Number(value) => format!("{value:?}"),
            Kind::Sign(sign) => (*sign).to_owned(),
            Kind::Bad(reason) => format!("! {reason}"),
        };
        tokens(text).iter().map(show).collect()
    }

    #[test]
    fn numbers_end_where_they_stop_making_sense() {
        assert_eq!(
            read("1 .5 1. 1e-3 2E+2 1.5e3"),
            ["1.0", "0.5", "1.0", "0.001", "200.0", "1500.0"]
        );
        assert_eq!(
            read("1e 1e+ 2pi 1.2.3"),
            ["1.0", "e", "1.0", "e", "+", "2.0", "pi", "1.2", "0.3"]
        );
        assert_eq!(read("."), ["! unexpected character '.'"]);
        assert_eq!(read("1e999"), ["! the number 1e999 is too large"]);
        assert_eq!(read("1e-999"), ["0.0"]);
    }

    #[test]
    fn words_may_use_any_letters() {
        assert_eq!(read("größe_2 _x если"), ["größe_2", "_x", "если"]);
        assert_eq!(read("a-b<=c"), ["a", "-", "b", "<=", "c"]);
        assert!(is_word("größe_2") && !is_word("2x") && !is_word("a b") && !is_word(""));
    }

    #[test]
    fn quotes_are_doubled_or_follow_a_backslash() {
        assert_eq!(read(r#"'a b' "c""d" 'e''f'"#), ["<a b>", "<c\"d>", "<e'f>"]);
        assert_eq!(read(r#""a\"b" "c\\" "d\n""#), ["<a\"b>", "<c\\>", "<d\\n>"]);
        assert_eq!(read("'a"), ["! the quoted name does not end"]);
        assert_eq!(read("'a\nb"), ["! the quoted name does not end on its line", "b"]);
        for name in ["a b", "\"", "\\", "\\\"", "'", "a\\'b\"\"", "\\n"] {
            assert_eq!(read(&quote(name)), [format!("<{name}>")]);
        }
    }

    #[test]
    fn comments_mean_nothing() {
        assert_eq!(read("a # b ' \n c # d"), ["a", "c"]);
        assert_eq!(read("'a # b'"), ["<a # b>"]);
        let tokens = tokens("ab # c\n  +  d");
        let mut reader = Reader::new("ab # c\n  +  d", &tokens);
        (0..3).for_each(|_| reader.advance());
        assert_eq!(reader.text_since(0), "ab + d");
    }

    #[test]
    fn long_texts_are_cut_in_messages() {
        assert_eq!(shown(&"ä".repeat(40)), "ä".repeat(40));
        assert_eq!(shown(&"ä".repeat(41)), "ä".repeat(40) + "…");
    }
}
