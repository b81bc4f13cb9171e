//! What is wrong with a scene, and where.

use super::mistake::Mistake;
use std::fmt;

/// Everything found wrong with a scene, in the order of its lines.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneErrors {
    /// The mistakes, at least one.
    pub list: Vec<SceneError>,
}

impl std::error::Error for SceneErrors {}

impl fmt::Display for SceneErrors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, error) in self.list.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{error}")?;
        }
        Ok(())
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
        write!(f, "{}: {}", place.join(", "), self.mistake)
    }
}
