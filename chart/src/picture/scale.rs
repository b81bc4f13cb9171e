//! Axes: from numbers to places, and where an axis has its marks.

/// How an axis is divided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By powers of ten.
    Logarithmic,
}

/// A mark of an axis.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    /// Where, from 0 to 1 along the axis.
    pub place: f64,
    /// What is written there; nothing at a small mark.
    pub text: String,
}

/// Marks that an axis should have about.
const MARKS: f64 = 5.0;

/// Part of the axis that stays free at either end.
const MARGIN: f64 = 0.04;

/// An axis with its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ruler {
    /// How it is divided.
    scale: Scale,
    /// Lower and upper end; their logarithms where it is divided so.
    ends: [f64; 2],
}

impl Ruler {
    /// An axis on which all these numbers have a place. Numbers that a logarithm does not have are left out.
    pub(super) fn over(scale: Scale, numbers: impl Iterator<Item = f64>) -> Self {
        let mut ends = [f64::INFINITY, f64::NEG_INFINITY];
        for value in numbers.filter_map(|number| along(scale, number)) {
            ends = [ends[0].min(value), ends[1].max(value)];
        }
        let [low, high] = if ends[0] <= ends[1] { ends } else { [0.0, 1.0] };
        let length = if high > low { high - low } else { low.abs().max(1.0) };
        let least = if scale == Scale::Logarithmic { length.max(1.0) } else { length };
        let free = 0.5 * (least - (high - low)) + MARGIN * least;
        Self { scale, ends: [low - free, high + free] }
    }

    /// Where a number is, from 0 to 1, if the axis reaches it.
    pub(super) fn place(&self, number: f64) -> Option<f64> {
        let [low, high] = self.ends;
        let place = (along(self.scale, number)? - low) / (high - low);
        (-1e-9..=1.0 + 1e-9).contains(&place).then_some(place)
    }

    /// Its marks, those with text and those without.
    pub(super) fn marks(&self) -> Vec<Mark> {
        match self.scale {
            Scale::Linear => self.even_marks(),
            Scale::Logarithmic => self.decades(),
        }
    }

    /// Marks at multiples of 1, 2 or 5 times a power of ten.
    fn even_marks(&self) -> Vec<Mark> {
        let [low, high] = self.ends;
        let rough = (high - low) / MARKS;
        let power = libm::floor(libm::log10(rough)) as i32;
        let unit = libm::pow(10.0, f64::from(power));
        let fits = |times: &f64| (high - low) / (times * unit) >= MARKS - 1.0;
        let step = unit * [10.0, 5.0, 2.0].into_iter().find(fits).unwrap_or(1.0);
        let digits = usize::try_from(-(libm::floor(libm::log10(1.0001 * step)) as i32)).unwrap_or(0);
        let first = (low / step).ceil() as i64;
        let last = (high / step).floor() as i64;
        let mark = |count: i64| {
            let value = count as f64 * step;
            Some(Mark { place: self.place(value)?, text: format!("{value:.digits$}").replace('-', "−") })
        };
        (first..=last).filter_map(mark).collect()
    }

    /// Marks at powers of ten, and small ones between them; over few decades at 2 and 5 as well.
    fn decades(&self) -> Vec<Mark> {
        let [low, high] = self.ends;
        let every = ((high - low) / (2.0 * MARKS)).ceil().max(1.0) as i32;
        let few = high - low < 1.7;
        let mut marks = Vec::new();
        for power in (low.floor() as i32)..=(high.ceil() as i32) {
            for digit in 1..10 {
                let value = f64::from(digit) * libm::pow(10.0, f64::from(power));
                let Some(place) = self.place(value) else { continue };
                let told = (digit == 1 && power % every == 0) || (few && [2, 5].contains(&digit));
                if told || every == 1 {
                    marks.push(Mark { place, text: if told { written(digit, power) } else { String::new() } });
                }
            }
        }
        marks
    }
}

/// Where a number is along an axis, before its ends are known.
fn along(scale: Scale, number: f64) -> Option<f64> {
    match scale {
        Scale::Linear => number.is_finite().then_some(number),
        Scale::Logarithmic => (number > 0.0 && number.is_finite()).then(|| libm::log10(number)),
    }
}

/// A digit times a power of ten as it is written: in full where that is short.
fn written(digit: i32, power: i32) -> String {
    match power {
        0..=3 => format!("{}", digit * 10_i32.pow(power as u32)),
        -2..=-1 => format!("{:.*}", (-power) as usize, f64::from(digit) * libm::pow(10.0, f64::from(power))),
        _ => {
            let factor = if digit == 1 { String::new() } else { format!("{digit}·") };
            let raised: String = power.to_string().chars().map(superscript).collect();
            format!("{factor}10{raised}")
        }
    }
}

/// A digit or sign, raised.
fn superscript(letter: char) -> char {
    match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit.to_digit(10).and_then(|digit| char::from_u32(0x2070 + digit)).unwrap_or(digit),
    }
}

#[cfg(test)]
mod tests {
    use super::{Ruler, Scale, written};

    /// What is written along an axis over these numbers.
    fn texts(scale: Scale, numbers: &[f64]) -> Vec<String> {
        let marks = Ruler::over(scale, numbers.iter().copied()).marks();
        marks.into_iter().map(|mark| mark.text).filter(|text| !text.is_empty()).collect()
    }

    #[test]
    fn an_even_axis_has_round_marks() {
        assert_eq!(texts(Scale::Linear, &[0.0, 1.0]), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(texts(Scale::Linear, &[-40.0, 60.0]), ["−40", "−20", "0", "20", "40", "60"]);
    }

    #[test]
    fn a_logarithmic_axis_has_powers_of_ten() {
        assert_eq!(texts(Scale::Logarithmic, &[1e-5, 1.0]), ["10⁻⁵", "10⁻⁴", "10⁻³", "0.01", "0.1", "1"]);
        assert_eq!(written(2, -4), "2·10⁻⁴");
    }

    #[test]
    fn numbers_without_logarithm_have_no_place() {
        let ruler = Ruler::over(Scale::Logarithmic, [0.0, 1.0, 100.0].into_iter());
        assert_eq!(ruler.place(0.0), None);
        assert!(ruler.place(10.0).is_some_and(|place| (place - 0.5).abs() < 1e-12));
    }
}
