//! What is wrong with a scene, and where.

use super::mistake::Mistake;
use std::fmt;

/// How many mistakes are printed.
const PRINTED: usize = 20;

/// How many characters of one word are printed.
const LONGEST: usize = 100;

/// Everything found wrong with a scene, in the order of its lines.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneErrors {
    /// The mistakes, at least one.
    pub list: Vec<SceneError>,
}

impl std::error::Error for SceneErrors {}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, error) in self.list.iter().take(PRINTED).enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{error}")?;
        }
        match self.list.len().saturating_sub(PRINTED) {
            0 => Ok(()),
            1 => write!(f, "\nand 1 more mistake"),
            more => write!(f, "\nand {more} more mistakes"),
        }
    }
}

/// One mistake and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneError {
    /// The scene or a file it names; empty for a scene built in code.
    pub file: String,
    /// The line there, if the mistake has one.
    pub line: Option<usize>,
    /// The table of the scene, as `boundary.floor`; empty at the top.
    pub table: String,
    /// The key or column; inside a list, entries count from 1: `list.3.radius`.
    pub key: String,
    /// What is wrong.
    pub mistake: Mistake,
}

impl fmt::Display for SceneError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut place = Vec::new();
        if !self.file.is_empty() {
            place.push(self.file.clone());
        }
        if let Some(line) = self.line {
            place.push(format!("line {line}"));
        }
        match (self.table.as_str(), self.key.as_str()) {
            ("", "") => {}
            ("", key) => place.push(key.to_owned()),
            (table, "") => place.push(format!("[{table}]")),
            (table, key) => place.push(format!("[{table}] {key}")),
        }
        write!(f, "{}", printable(&format!("{}: {}", place.join(", "), self.mistake)))
    }
}

/// The text without characters that steer a terminal, and without numbers of hundreds of digits.
fn printable(text: &str) -> String {
    let word = |word: &str| {
        let count = word.chars().count();
        let kept: String = word.chars().take(if count > LONGEST { LONGEST / 2 } else { count }).collect();
        let shown: String = kept
            .chars()
            .flat_map(|letter| match letter.is_control() && letter != '\n' {
                true => letter.escape_default().collect::<Vec<_>>(),
                false => vec![letter],
            })
            .collect();
        if count > LONGEST { format!("{shown}.. ({count} characters)") } else { shown }
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}
