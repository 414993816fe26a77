//! Tables of texts, for the terminal and for a browser.

use std::fmt::{Display, Formatter, Result};

/// A table with a head. Numbers stand at the right of their columns, texts at the left.
#[derive(Debug, Default)]
pub struct Table {
    columns: Vec<Column>,
    /// A remark below.
    pub note: Option<String>,
}

#[derive(Debug)]
struct Column {
    head: String,
    cells: Vec<String>,
    right: bool,
}

impl Table {
    /// The table with a column of texts more.
    pub fn texts(self, head: &str, cells: Vec<String>) -> Self {
        self.column(head, cells, false)
    }

    /// The table with a column of numbers more.
    pub fn numbers(self, head: &str, cells: impl IntoIterator<Item = f64>) -> Self {
        self.column(head, cells.into_iter().map(short).collect(), true)
    }

    fn column(mut self, head: &str, cells: Vec<String>, right: bool) -> Self {
        self.columns.push(Column { head: head.to_owned(), cells, right });
        self
    }

    fn height(&self) -> usize {
        self.columns.iter().map(|column| column.cells.len()).max().unwrap_or(0)
    }

    /// The table as an HTML element.
    pub fn to_html(&self) -> String {
        let align = |column: &Column| if column.right { "right" } else { "left" };
        let line = |tag: &str, text: &dyn Fn(&Column) -> String| {
            let cells = self.columns.iter().map(|column| {
                let text = escaped(&text(column));
                format!("<{tag} style=\"text-align: {}\">{text}</{tag}>", align(column))
            });
            format!("<tr>{}</tr>\n", cells.collect::<String>())
        };
        let head = line("th", &|column| column.head.clone());
        let rows: String = (0..self.height())
            .map(|row| line("td", &|column| column.cells.get(row).cloned().unwrap_or_default()))
            .collect();
        let note = self.note.as_deref().map(|note| format!("<p>{}</p>\n", escaped(note)));
        format!("<table>\n{head}{rows}</table>\n{}", note.unwrap_or_default())
    }
}

impl Display for Table {
    fn fmt(&self, f: &mut Formatter) -> Result {
        self.line(f, |column| &column.head)?;
        for row in 0..self.height() {
            self.line(f, |column| column.cells.get(row).map_or("", String::as_str))?;
        }
        self.note.iter().try_for_each(|note| writeln!(f, "{note}"))
    }
}

impl Table {
    fn line<'a>(&'a self, f: &mut Formatter, text: impl Fn(&'a Column) -> &'a str) -> Result {
        let mut line = String::new();
        for (index, column) in self.columns.iter().enumerate() {
            let (text, width) = (text(column), column.width());
            let gap = if index > 0 { "  " } else { "" };
            line += &match column.right {
                true => format!("{gap}{text:>width$}"),
                false => format!("{gap}{text:<width$}"),
            };
        }
        writeln!(f, "{}", line.trim_end())
    }
}

impl Column {
    fn width(&self) -> usize {
        let texts = self.cells.iter().chain([&self.head]);
        texts.map(|text| text.chars().count()).max().unwrap_or(0)
    }
}

/// A number with five digits, none for NaN.
pub fn short(value: f64) -> String {
    const DIGITS: i32 = 5;
    if !value.is_finite() {
        return if value.is_nan() { String::new() } else { value.to_string() };
    }
    // Adding 0 makes 0 of −0.
    let scientific = format!("{:.*e}", DIGITS as usize - 1, value + 0.0);
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-4..=DIGITS).contains(&exponent) {
        let decimals = (DIGITS - 1 - exponent).max(0) as usize;
        return trimmed(&format!("{:.decimals$}", value + 0.0)).to_owned();
    }
    format!("{}e{exponent}", trimmed(mantissa))
}

/// The number without zeros at the end of its decimals.
fn trimmed(number: &str) -> &str {
    match number.contains('.') {
        true => number.trim_end_matches('0').trim_end_matches('.'),
        false => number,
    }
}

/// The text with the characters that mean something in HTML written otherwise.
pub fn escaped(text: &str) -> String {
    let escapes = [('&', "&amp;"), ('<', "&lt;"), ('>', "&gt;"), ('"', "&quot;"), ('\'', "&#39;")];
    escapes.into_iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_widest_text() {
        let table = Table::default()
            .texts("name", vec!["é".into(), "longer".into()])
            .numbers("x", [0.5, -10.0])
            .texts("more", vec!["a".into(), String::new()]);
        assert_eq!(table.to_string(), "name      x  more\né       0.5  a\nlonger  -10\n");
    }

    #[test]
    fn numbers_have_five_digits() {
        let cases = [
            (0.0, "0"),
            (-0.0, "0"),
            (1.0 / 3.0, "0.33333"),
            (7.01694, "7.0169"),
            (-12345.67, "-12346"),
            (100.0, "100"),
            (1234567.0, "1.2346e6"),
            (0.000012, "1.2e-5"),
            (0.99999999, "1"),
            (f64::INFINITY, "inf"),
            (f64::NAN, ""),
        ];
        for (value, text) in cases {
            assert_eq!(short(value), text);
        }
    }

    #[test]
    fn what_means_something_in_html_is_escaped() {
        let mut table = Table::default().texts("<b>", vec!["a & \"b\"".into()]);
        table.note = Some("it's".into());
        let html = table.to_html();
        assert!(html.contains(">&lt;b&gt;</th>"), "{html}");
        assert!(html.contains(">a &amp; &quot;b&quot;</td>"), "{html}");
        assert!(html.contains("<p>it&#39;s</p>"), "{html}");
    }
}
