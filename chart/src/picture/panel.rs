//! One diagram of a picture.

use super::scale::Ruler;
use super::style::Style;
use super::{Axis, Panel, escaped};
use crate::table::Table;
use std::fmt::Write;

/// Height of the place for the points \[px\].
const HEIGHT: f64 = 250.0;

/// From the left edge to the axis, and from the top \[px\].
const ORIGIN: [f64; 2] = [80.0, 34.0];

/// Below the place for the points: numbers and name of the axis \[px\].
const BELOW: f64 = 56.0;

/// Width of the legend \[px\].
const LEGEND: f64 = 285.0;

/// From one line of the legend to the next \[px\].
const LINE: f64 = 18.0;

/// Length of a small and of a large mark \[px\].
const MARKS: [f64; 2] = [3.0, 6.0];

/// The points of a series.
struct Series {
    /// Its name.
    name: String,
    /// Across and upwards.
    points: Vec<[f64; 2]>,
}

/// Series in the order in which the table names them.
fn series(panel: &Panel, table: &Table) -> Vec<Series> {
    let mut all: Vec<Series> = Vec::new();
    let place = table.place(panel.series);
    for (number, row) in table.rows.iter().enumerate() {
        if panel.only.as_ref().is_some_and(|(column, word)| row[table.place(column)].to_string() != *word) {
            continue;
        }
        let name = row[place].to_string();
        let numbers = [panel.across, panel.upwards].map(|axis| table.number(number, axis.column));
        let [Some(across), Some(upwards)] = numbers else { continue };
        let found = all.iter().position(|series| series.name == name);
        let at = found.unwrap_or_else(|| {
            all.push(Series { name, points: Vec::new() });
            all.len() - 1
        });
        all[at].points.push([across, upwards]);
    }
    all
}

/// Draws a panel of this width \[px\]; says how high it is \[px\].
pub(super) fn draw(panel: &Panel, table: &Table, width: f64) -> (String, f64) {
    let all = series(panel, table);
    let ruler = |axis: Axis, place: usize| {
        Ruler::over(axis.scale, all.iter().flat_map(|series| series.points.iter().map(move |point| point[place])))
    };
    let plot = Plot {
        rulers: [ruler(panel.across, 0), ruler(panel.upwards, 1)],
        width: width - ORIGIN[0] - LEGEND,
        text: String::new(),
    };
    let text = plot.frame(panel, table).points(panel, &all).legend(panel, &all).text;
    let height = ORIGIN[1] + HEIGHT.max(LINE * all.len() as f64) + BELOW;
    (text, height)
}

/// A diagram that grows.
struct Plot {
    /// Both axes.
    rulers: [Ruler; 2],
    /// Width of the place for the points \[px\].
    width: f64,
    /// What has been drawn.
    text: String,
}

impl Plot {
    /// Adds.
    fn add(&mut self, text: std::fmt::Arguments) {
        self.text.write_fmt(text).expect("a text grows");
        self.text.push('\n');
    }

    /// Where a point is \[px\], if the axes reach it.
    fn place(&self, [across, upwards]: [f64; 2]) -> Option<[f64; 2]> {
        let [x, y] = [self.rulers[0].place(across)?, self.rulers[1].place(upwards)?];
        Some([ORIGIN[0] + x * self.width, ORIGIN[1] + (1.0 - y) * HEIGHT])
    }

    /// Frame, marks and what is written at them.
    fn frame(mut self, panel: &Panel, table: &Table) -> Self {
        let ([left, top], width) = (ORIGIN, self.width);
        let (bottom, middle) = (top + HEIGHT, left + 0.5 * width);
        self.add(format_args!(
            "<rect x=\"{left}\" y=\"{top}\" width=\"{width}\" height=\"{HEIGHT}\" fill=\"none\" stroke=\"black\"/>"
        ));
        let title = escaped(&panel.title);
        self.add(format_args!("<text x=\"{left}\" y=\"{}\" font-weight=\"bold\">{title}</text>", top - 12.0));
        for mark in self.rulers[0].marks() {
            let (x, long) = (left + mark.place * width, MARKS[usize::from(!mark.text.is_empty())]);
            self.add(format_args!("<path d=\"M{x:.1} {bottom} v-{long} M{x:.1} {top} v{long}\" stroke=\"black\"/>"));
            let y = bottom + 17.0;
            self.add(format_args!("<text x=\"{x:.1}\" y=\"{y}\" text-anchor=\"middle\">{}</text>", mark.text));
        }
        for mark in self.rulers[1].marks() {
            let (y, long) = (bottom - mark.place * HEIGHT, MARKS[usize::from(!mark.text.is_empty())]);
            let right = left + width;
            self.add(format_args!("<path d=\"M{left} {y:.1} h{long} M{right} {y:.1} h-{long}\" stroke=\"black\"/>"));
            let (x, y) = (left - 6.0, y + 4.0);
            self.add(format_args!("<text x=\"{x}\" y=\"{y:.1}\" text-anchor=\"end\">{}</text>", mark.text));
        }
        let [across, upwards] = [panel.across, panel.upwards].map(|axis| {
            let column = table.columns[table.place(axis.column)];
            escaped(&column.label())
        });
        let y = bottom + 38.0;
        self.add(format_args!("<text x=\"{middle:.1}\" y=\"{y}\" text-anchor=\"middle\">{across}</text>"));
        let y = top + 0.5 * HEIGHT;
        self.add(format_args!(
            "<text transform=\"translate(18 {y}) rotate(-90)\" text-anchor=\"middle\">{upwards}</text>"
        ));
        self
    }

    /// Lines and markers.
    fn points(mut self, panel: &Panel, all: &[Series]) -> Self {
        for (number, series) in all.iter().enumerate() {
            let style = Style { number };
            let places: Vec<_> = series.points.iter().filter_map(|point| self.place(*point)).collect();
            if !panel.single.contains(&&*series.name) {
                let points: Vec<_> = places.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
                self.add(format_args!("<polyline points=\"{}\" {}/>", points.join(" "), style.line()));
            }
            if !panel.theory.contains(&&*series.name) {
                for [x, y] in places {
                    self.text += &style.marker(x, y);
                }
            }
        }
        self
    }

    /// The legend, at the right.
    fn legend(mut self, panel: &Panel, all: &[Series]) -> Self {
        let left = ORIGIN[0] + self.width + 14.0;
        for (number, series) in all.iter().enumerate() {
            let style = Style { number };
            let y = ORIGIN[1] + 8.0 + LINE * number as f64;
            if !panel.single.contains(&&*series.name) {
                self.add(format_args!("<path d=\"M{left} {y} h28\" {}/>", style.line()));
            }
            if !panel.theory.contains(&&*series.name) {
                self.text += &style.marker(left + 14.0, y);
            }
            let (x, y) = (left + 36.0, y + 4.0);
            self.add(format_args!("<text x=\"{x}\" y=\"{y}\">{}</text>", escaped(&series.name)));
        }
        self
    }
}
