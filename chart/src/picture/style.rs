//! Markers, dashes and colours of series.

/// Colours that differ for eyes that see fewer of them (Okabe and Ito, without yellow), and in their grey.
const COLOURS: [&str; 7] = ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00"];

/// Dashes \[px\].
const DASHES: [&str; 4] = ["", "6 3", "2 2", "8 3 2 3"];

/// Half the size of a marker \[px\].
const HALF: f64 = 3.6;

/// How a series looks, by its number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Style {
    /// Number of the series in its panel.
    pub number: usize,
}

impl Style {
    /// Its colour.
    pub(super) fn colour(self) -> &'static str {
        COLOURS[self.number % COLOURS.len()]
    }

    /// What its line says of itself.
    pub(super) fn line(self) -> String {
        let dashes = DASHES[self.number % DASHES.len()];
        format!("fill=\"none\" stroke=\"{}\" stroke-width=\"1.3\" stroke-dasharray=\"{dashes}\"", self.colour())
    }

    /// Its marker around a point \[px\].
    pub(super) fn marker(self, x: f64, y: f64) -> String {
        let colour = self.colour();
        // full and open ones in turn
        let (kind, fill) = (self.number / 2 % 5, if self.number.is_multiple_of(2) { colour } else { "white" });
        let look = format!("fill=\"{fill}\" stroke=\"{colour}\" stroke-width=\"1.2\"");
        let polygon = |corners: &[(f64, f64)]| {
            let points: Vec<_> =
                corners.iter().map(|(a, b)| format!("{:.1},{:.1}", x + a * HALF, y + b * HALF)).collect();
            format!("<polygon points=\"{}\" {look}/>\n", points.join(" "))
        };
        match kind {
            0 => format!("<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{HALF}\" {look}/>\n"),
            1 => polygon(&[(-0.9, -0.9), (0.9, -0.9), (0.9, 0.9), (-0.9, 0.9)]),
            2 => polygon(&[(0.0, -1.2), (1.1, 0.9), (-1.1, 0.9)]),
            3 => polygon(&[(0.0, -1.3), (1.3, 0.0), (0.0, 1.3), (-1.3, 0.0)]),
            _ => polygon(&[(0.0, 1.2), (1.1, -0.9), (-1.1, -0.9)]),
        }
    }
}
