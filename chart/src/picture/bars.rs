//! Bars of a picture: a word and a number in each line.

use super::scale::{Ruler, Scale};
use crate::table::Table;
use std::fmt::Write;

/// Numbers of words, as bars.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bars {
    /// What is written above them.
    pub title: String,
    /// The column of the words.
    pub words: &'static str,
    /// The column of the numbers.
    pub number: &'static str,
}

/// Width of the place for words, and of that for the numbers behind the bars \[px\].
const MARGINS: [f64; 2] = [290.0, 50.0];

/// From one line to the next, and height of a bar \[px\].
const LINE: [f64; 2] = [20.0, 12.0];

/// Above the first bar, and below the last one \[px\].
const ENDS: [f64; 2] = [34.0, 48.0];

/// Draws bars over this width \[px\]; says how high they are \[px\].
pub(super) fn draw(bars: &Bars, table: &Table, width: f64) -> (String, f64) {
    let numbers: Vec<_> = (0..table.rows.len()).map(|row| table.number(row, bars.number).unwrap_or(0.0)).collect();
    let ruler = Ruler::over(Scale::Linear, numbers.iter().copied().chain([0.0]));
    let ([left, right], [line, thick], [above, below]) = (MARGINS, LINE, ENDS);
    let (long, bottom) = (width - left - right, above + line * numbers.len() as f64);
    let place = |number: f64| left + long * ruler.place(number).unwrap_or(0.0);
    let mut text = String::new();
    let mut add = |line: std::fmt::Arguments| writeln!(text, "{line}").expect("a text grows");
    add(format_args!(
        "<text x=\"12\" y=\"{}\" font-weight=\"bold\">{}</text>",
        above - 14.0,
        super::escaped(&bars.title)
    ));
    let words = table.place(bars.words);
    for (row, number) in numbers.iter().enumerate() {
        let y = above + line * row as f64;
        let (x, end, base) = (place(0.0), place(*number), y + thick - 2.0);
        let word = super::escaped(&table.rows[row][words].to_string());
        add(format_args!("<text x=\"{}\" y=\"{base}\" text-anchor=\"end\">{word}</text>", x - 6.0));
        add(format_args!(
            "<rect x=\"{x:.1}\" y=\"{y}\" width=\"{:.1}\" height=\"{thick}\" fill=\"#b0b0b0\" stroke=\"black\"/>",
            end - x
        ));
        add(format_args!("<text x=\"{:.1}\" y=\"{base}\">{number:.2}</text>", end + 6.0));
    }
    let zero = place(0.0);
    add(format_args!("<path d=\"M{zero:.1} {above} V{bottom} H{}\" stroke=\"black\" fill=\"none\"/>", left + long));
    for mark in ruler.marks() {
        let x = left + mark.place * long;
        add(format_args!("<path d=\"M{x:.1} {bottom} v-6\" stroke=\"black\"/>"));
        add(format_args!("<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{}</text>", bottom + 17.0, mark.text));
    }
    let label = super::escaped(&table.columns[table.place(bars.number)].label());
    let (x, y) = (left + 0.5 * long, bottom + 36.0);
    add(format_args!("<text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{label}</text>"));
    (text, bottom + below)
}
