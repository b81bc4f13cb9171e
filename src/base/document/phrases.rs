//! Parts of sentences that messages are made of.

use super::nearest::nearest;

/// How many known words a message lists at most.
const LISTED: usize = 40;

/// Bytes of the longest name of a column.
const LONGEST_COLUMN: usize = 32;

/// A length in at most four digits: `2.0e-3`, `1.837e-3`.
pub(super) fn short(length: f64) -> String {
    let text = format!("{length:.3e}");
    match text.split_once('e') {
        Some((digits, power)) => {
            let digits = digits.trim_end_matches('0');
            let zero = if digits.ends_with('.') { "0" } else { "" };
            format!("{digits}{zero}e{power}")
        }
        None => text,
    }
}

/// The distances that bond a pair.
pub(super) fn bonding_distance(closest: Option<f64>) -> String {
    match closest {
        Some(distance) => format!("a distance above {} (the closest centres)", short(distance)),
        None => "centres near enough to be bonded".to_owned(),
    }
}

/// ", and 3 more pairs", or nothing.
pub(super) fn and_more(more: usize, what: &str) -> String {
    match more {
        0 => String::new(),
        1 => format!(", and 1 more {what}"),
        more => format!(", and {more} more {what}s"),
    }
}

/// Names the nearest known word, or all of them.
pub(crate) fn proposal(found: &str, known: &[String], all: &str) -> String {
    match nearest(found, known.iter().map(String::as_str)) {
        Some(near) => format!("the nearest is {near}"),
        None if known.is_empty() => "none is known here".to_owned(),
        None if known.len() > LISTED => format!("{all} {}, ..", listed(&known[..LISTED])),
        None => format!("{all} {}", listed(known)),
    }
}

/// Names of columns, as a message may tell them; none of a first line that is no table's, which is nobody's business.
pub(crate) fn told_columns(found: &[String]) -> Option<String> {
    let is_name = |name: &String| {
        let word = |letter: char| letter.is_alphanumeric() || "_.-[]()/ ^²³".contains(letter);
        name.len() <= LONGEST_COLUMN && name.starts_with(char::is_alphabetic) && name.chars().all(word)
    };
    (found.len() > 1 && found.iter().all(is_name)).then(|| listed(found))
}

/// `; the nearest is "near"`, or nothing where no known word is near, or only one is known.
pub(super) fn and_nearest(found: &str, known: &[String]) -> String {
    let near = nearest(found, known.iter().map(String::as_str)).filter(|_| known.len() > 1);
    near.map_or_else(String::new, |near| format!("; the nearest is {near:?}"))
}

/// `a, b, c`
pub(super) fn listed(words: &[String]) -> String {
    words.join(", ")
}

/// `"a", "b" or "c"`
pub(super) fn alternatives(words: &[String]) -> String {
    match words {
        [] => "nothing".to_owned(),
        [one] => format!("{one:?}"),
        [first @ .., last] => {
            let first: Vec<String> = first.iter().map(|word| format!("{word:?}")).collect();
            format!("{} or {last:?}", first.join(", "))
        }
    }
}
