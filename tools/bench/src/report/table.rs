//! Tables as Markdown, padded so that they can be read in a terminal, and as JSON.

use std::fmt::Write as _;

use serde_json::{Value, json};

use crate::timing::Spread;

/// One figure or word of a table.
#[derive(Clone, Debug)]
pub(crate) enum Cell {
    /// A name.
    Text(String),
    /// A single figure with the digits to show behind the point.
    Number(f64, usize),
    /// A median with its range and, unless it is the baseline itself, its ratio to the baseline.
    Measured {
        /// In the unit of the column.
        value: Spread,
        /// Speed as a multiple of the baseline's.
        ratio: Option<Spread>,
    },
}

impl Cell {
    /// Where there is nothing to measure.
    pub(crate) fn none() -> Self {
        Self::Text("-".to_owned())
    }

    fn to_markdown(&self) -> String {
        match self {
            Self::Text(text) => text.replace('|', "\\|"),
            Self::Number(value, digits) => format!("{value:.digits$}"),
            Self::Measured { value, ratio } => {
                let digits = digits_for(value.median);
                let Spread { median, min, max } = value;
                let mut text = format!("{median:.digits$} ({min:.digits$}-{max:.digits$})");
                if let Some(ratio) = ratio {
                    let digits = digits_for(ratio.median).max(2);
                    // Writing to a String cannot fail.
                    let _ = write!(text, " x{:.digits$}", ratio.median);
                }
                text
            }
        }
    }

    fn to_json(&self) -> Value {
        let spread = |s: &Spread| json!({ "median": s.median, "min": s.min, "max": s.max });
        match self {
            Self::Text(text) => json!(text),
            Self::Number(value, _) => json!(value),
            Self::Measured { value, ratio } => {
                json!({ "value": spread(value), "ratio": ratio.as_ref().map(spread) })
            }
        }
    }
}

/// Digits after the point that leave three significant ones.
fn digits_for(value: f64) -> usize {
    match value.abs() {
        v if v >= 100.0 => 0,
        v if v >= 10.0 => 1,
        v if v >= 1.0 => 2,
        _ => 3,
    }
}

/// A table with a title and notes on how to read it.
#[derive(Clone, Debug)]
pub(crate) struct Table {
    title: String,
    notes: Vec<String>,
    columns: Vec<String>,
    rows: Vec<Vec<Cell>>,
}

impl Table {
    pub(crate) fn new(title: impl Into<String>, columns: &[&str]) -> Self {
        Self {
            title: title.into(),
            notes: Vec::new(),
            columns: columns.iter().map(|&name| name.to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    pub(crate) fn note(&mut self, text: impl Into<String>) {
        self.notes.push(text.into());
    }

    /// One cell a column.
    pub(crate) fn row(&mut self, cells: Vec<Cell>) {
        debug_assert_eq!(cells.len(), self.columns.len(), "a cell for each column");
        self.rows.push(cells);
    }

    pub(crate) fn to_markdown(&self) -> String {
        let text: Vec<Vec<String>> = self
            .rows
            .iter()
            .map(|row| row.iter().map(Cell::to_markdown).collect())
            .collect();
        let width = |column: usize| {
            let cells = text.iter().map(|row| row[column].chars().count());
            cells
                .chain([self.columns[column].chars().count()])
                .max()
                .unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.columns.len()).map(width).collect();
        let mut out = format!("### {}\n\n", self.title);
        for note in &self.notes {
            out.push_str(note);
            out.push_str("\n\n");
        }
        line(&mut out, &self.columns, &widths);
        // Figures to the right, the first column's names to the left.
        let rules = widths
            .iter()
            .enumerate()
            .map(|(column, &width)| match column {
                0 => "-".repeat(width),
                _ => format!("{}:", "-".repeat(width.saturating_sub(1))),
            });
        line(&mut out, &rules.collect::<Vec<_>>(), &widths);
        for row in &text {
            line(&mut out, row, &widths);
        }
        out
    }

    pub(crate) fn to_json(&self) -> Value {
        let rows: Vec<Vec<Value>> = self
            .rows
            .iter()
            .map(|row| row.iter().map(Cell::to_json).collect())
            .collect();
        json!({
            "title": self.title,
            "notes": self.notes,
            "columns": self.columns,
            "rows": rows,
        })
    }
}

fn line(out: &mut String, cells: &[String], widths: &[usize]) {
    for (column, (cell, &width)) in cells.iter().zip(widths).enumerate() {
        let padded = if column == 0 {
            format!("{cell:<width$}")
        } else {
            format!("{cell:>width$}")
        };
        out.push_str("| ");
        out.push_str(&padded);
        out.push(' ');
    }
    out.push_str("|\n");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markdown_is_padded() {
        let mut table = Table::new("T", &["name", "M/s"]);
        table.note("a note");
        let value = Spread {
            median: 12.34,
            min: 9.0,
            max: 20.0,
        };
        let ratio = Some(Spread {
            median: 0.5,
            min: 0.4,
            max: 0.6,
        });
        table.row(vec![
            Cell::Text("a".into()),
            Cell::Measured { value, ratio },
        ]);
        table.row(vec![Cell::Text("longer".into()), Cell::Number(2.0, 1)]);
        let expect = "### T\n\na note\n\n\
            | name   |                    M/s |\n\
            | ------ | ---------------------: |\n\
            | a      | 12.3 (9.0-20.0) x0.500 |\n\
            | longer |                    2.0 |\n";
        assert_eq!(table.to_markdown(), expect);
    }
}
