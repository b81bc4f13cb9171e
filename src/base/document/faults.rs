//! The mistakes that are found in a document, with their places.

use super::{Document, Mistake, SceneError, SceneErrors};

/// Collects mistakes.
pub(crate) struct Faults<'d, 'a> {
    /// Where lines are looked up.
    document: &'d Document<'a>,
    /// The mistakes so far.
    list: Vec<SceneError>,
    /// What is written and legal and nothing reads, in words.
    unread: Vec<String>,
}

impl<'d, 'a> Faults<'d, 'a> {
    /// None yet.
    pub(crate) fn new(document: &'d Document<'a>) -> Self {
        Self { document, list: Vec::new(), unread: Vec::new() }
    }

    /// How many there are.
    pub(crate) fn count(&self) -> usize {
        self.list.len()
    }

    /// A mistake at a key of a table, or at the table itself.
    pub(crate) fn add(&mut self, table: &str, key: &str, mistake: Mistake) {
        self.at_line(self.document.line_of(table, key), table, key, mistake);
    }

    /// A mistake at a line of the scene.
    pub(crate) fn at_line(&mut self, line: Option<usize>, table: &str, key: &str, mistake: Mistake) {
        let file = self.document.name.to_owned();
        self.list.push(SceneError { file, line, table: table.to_owned(), key: key.to_owned(), mistake });
    }

    /// A mistake in a file that the scene names.
    pub(crate) fn in_file(&mut self, file: &str, line: Option<usize>, table: &str, key: &str, mistake: Mistake) {
        let (file, table, key) = (file.to_owned(), table.to_owned(), key.to_owned());
        self.list.push(SceneError { file, line, table, key, mistake });
    }

    /// A key of a table that nothing reads, and why.
    pub(crate) fn unread(&mut self, table: &str, key: &str, why: &str) {
        self.unread.push(format!("[{table}] {key}: nothing reads it; {why}"));
    }

    /// What a file of a table says and nothing reads.
    pub(crate) fn left_out(&mut self, table: &str, file: &str, names: &[String]) {
        if !names.is_empty() {
            self.unread.push(format!("[{table}] file: nothing reads {} of {file}", names.join(", ")));
        }
    }

    /// What nothing reads.
    pub(crate) fn all_unread(&self) -> &[String] {
        &self.unread
    }

    /// All of them, in the order of the scene's lines and then of other files'; none is success.
    pub(crate) fn finish(mut self) -> Result<(), SceneErrors> {
        if self.list.is_empty() {
            return Ok(());
        }
        let name = self.document.name;
        self.list.sort_by_key(|error| (error.file != name, error.line.unwrap_or(usize::MAX)));
        Err(SceneErrors { list: self.list })
    }

    /// Stops here if there is any.
    pub(crate) fn so_far(&self) -> Result<(), SceneErrors> {
        Self { list: self.list.clone(), ..Self::new(self.document) }.finish()
    }
}
