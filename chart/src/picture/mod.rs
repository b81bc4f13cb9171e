//! A picture of a table: panels one below the other, each with axes, series of points and a legend at its side.
//!
//! It is drawn as SVG: text that printers and journals take, and that shows in any browser. Series differ in their
//! markers and dashes, so that they can be told apart without colour.

mod bars;
mod panel;
mod scale;
mod style;

pub use bars::Bars;
pub use scale::Scale;

use crate::table::Table;
use std::fmt::Write;
use std::path::Path;

/// An axis: a column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Axis {
    /// The column.
    pub column: &'static str,
    /// How it is divided.
    pub scale: Scale,
}

/// An axis that is divided by powers of ten.
pub const fn logarithmic(column: &'static str) -> Axis {
    Axis { column, scale: Scale::Logarithmic }
}

/// An axis that is divided evenly.
pub const fn linear(column: &'static str) -> Axis {
    Axis { column, scale: Scale::Linear }
}

/// One diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// What is written above it.
    pub title: String,
    /// To the right.
    pub across: Axis,
    /// Upwards.
    pub upwards: Axis,
    /// The column whose words divide the rows into series.
    pub series: &'static str,
    /// Only rows that have this word in this column.
    pub only: Option<(&'static str, String)>,
    /// Series that are lines without markers: theory.
    pub theory: Vec<&'static str>,
    /// Series that are markers without a line: measurements of others, single settings.
    pub single: Vec<&'static str>,
}

impl Panel {
    /// A diagram of all rows.
    pub fn new(title: &str, across: Axis, upwards: Axis, series: &'static str) -> Self {
        Self { title: title.to_owned(), across, upwards, series, only: None, theory: Vec::new(), single: Vec::new() }
    }
}

/// Width of a panel with its legend \[px\].
const WIDTH: f64 = 720.0;

/// A picture.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// Its diagrams, row by row.
    pub panels: Vec<Panel>,
    /// Diagrams beside each other; 0 stands for one.
    pub columns: usize,
    /// Bars, below them.
    pub bars: Vec<Bars>,
}

impl Picture {
    /// Draws the picture of a table.
    pub fn draw(&self, table: &Table) -> String {
        let mut bodies = String::new();
        let mut height = 0.0;
        let columns = self.columns.max(1);
        let mut put = |row: Vec<(String, f64)>| {
            let mut highest = 0.0_f64;
            for (column, (body, high)) in row.into_iter().enumerate() {
                let left = WIDTH * column as f64;
                write!(bodies, "<g transform=\"translate({left} {height})\">\n{body}</g>\n").expect("a text grows");
                highest = highest.max(high);
            }
            height += highest;
        };
        for row in self.panels.chunks(columns) {
            put(row.iter().map(|panel| panel::draw(panel, table, WIDTH)).collect());
        }
        for bars in &self.bars {
            put(vec![bars::draw(bars, table, WIDTH)]);
        }
        let width = WIDTH * columns as f64;
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\" \
             font-family=\"DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"12\">\n\
             <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n{bodies}</svg>\n"
        )
    }

    /// Draws the picture of a table into a file.
    pub fn write(&self, table: &Table, path: &Path) -> std::io::Result<()> {
        std::fs::write(path, self.draw(table))
    }
}

/// Text that holds no markup.
fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::{Panel, Picture, linear, logarithmic};
    use crate::table::Table;

    #[test]
    fn a_picture_has_a_legend_entry_for_each_series_and_survives_markup_in_names() {
        let mut table = Table::new([("law", ""), ("steps", "1"), ("error", "1")]);
        for (law, steps) in [("a < b", 10.0), ("a < b", 100.0), ("c & d", 10.0)] {
            table.push([law.into(), steps.into(), (1.0 / steps).into()]);
        }
        let picture = Picture {
            panels: vec![Panel::new("title", linear("steps"), logarithmic("error"), "law")],
            ..Picture::default()
        };
        let text = picture.draw(&table);
        assert!(text.contains("a &lt; b") && text.contains("c &amp; d"), "{text}");
        assert_eq!((text.matches("<polyline").count(), text.matches("<circle").count()), (2, 5), "{text}");
    }
}
