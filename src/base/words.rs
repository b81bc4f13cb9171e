//! Numbers as people expect to read them.

/// Significant digits of a number that rounding may have touched.
const DIGITS: usize = 12;

/// A number without the digits that rounding has left behind it: 0.0000375 for 0.000037500000000000003.
pub fn plain(number: f64) -> f64 {
    format!("{number:.*e}", DIGITS - 1).parse().unwrap_or(number)
}

/// A number of things: `1 particle`, `2 particles`.
pub fn counted(number: impl TryInto<u64>, thing: &str) -> String {
    let number = number.try_into().unwrap_or(u64::MAX);
    format!("{number} {thing}{}", if number == 1 { "" } else { "s" })
}

/// A length of time \[s\].
pub fn duration(seconds: f64) -> String {
    match seconds {
        seconds if seconds >= 2.0 * 86400.0 => format!("{:.1} days", seconds / 86400.0),
        seconds if seconds >= 7200.0 => format!("{:.1} h", seconds / 3600.0),
        seconds if seconds >= 120.0 => format!("{:.1} min", seconds / 60.0),
        seconds if seconds >= 100.0 => format!("{seconds:.0} s"),
        seconds if seconds >= 10.0 => format!("{seconds:.1} s"),
        seconds if seconds >= 0.1 => format!("{seconds:.2} s"),
        seconds => format!("{seconds:.2e} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_rounding_left_is_not_shown() {
        assert_eq!(plain(0.000037500000000000003).to_string(), "0.0000375");
        assert_eq!(plain(0.1 + 0.2).to_string(), "0.3");
        assert_eq!(plain(1.0 / 3.0).to_string(), "0.333333333333");
        assert_eq!(plain(0.0).to_string(), "0");
        assert!(plain(f64::NAN).is_nan() && plain(f64::INFINITY).is_infinite());
    }

    #[test]
    fn one_thing_is_one_thing() {
        assert_eq!(counted(1_usize, "particle"), "1 particle");
        assert_eq!(counted(0_u64, "contact"), "0 contacts");
    }
}
