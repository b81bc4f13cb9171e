//! Single values of a scene that are set from outside its text: `--set pair.glass.glass.friction=0.4`.
//!
//! The text itself is changed, so a set value is read, checked, packaged and fingerprinted like any other. Mistakes in it are
//! told by the setting, those elsewhere by the lines of the text as it was.

use super::error::{SceneError, SceneErrors};
use super::mistake::Mistake;
use std::fmt;
use std::str::FromStr;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A key of a scene, dotted, and the value that it gets.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Setting {
    /// The dotted key; entries of lists count from 1.
    key: String,
    /// The value as TOML.
    value: String,
}

/// Why a text is not a setting.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SettingError {
    /// There is no `=`.
    #[error("expected KEY=VALUE, found {0:?}")]
    NoValue(String),
    /// The text before `=` is not a key.
    #[error("expected names with dots between them, as pair.glass.glass.friction, found {0:?}")]
    Key(String),
    /// The text after `=` is not a value.
    #[error("expected a number, a word, true, false or a list in brackets, found {0:?}")]
    Value(String),
}

impl FromStr for Setting {
    type Err = SettingError;

    /// Reads `KEY=VALUE`. A word needs no quotes.
    fn from_str(text: &str) -> Result<Self, SettingError> {
        let (key, value) = text.split_once('=').ok_or_else(|| SettingError::NoValue(text.to_owned()))?;
        let (key, value) = (key.trim(), value.trim());
        let is_name = |name: &str| {
            !name.is_empty() && name.chars().all(|letter| letter.is_ascii_alphanumeric() || "_-".contains(letter))
        };
        if !key.split('.').all(is_name) {
            return Err(SettingError::Key(key.to_owned()));
        }
        let is_toml = |value: &str| {
            !value.contains('\n')
                && DeTable::parse(&format!("x = {value}")).is_ok_and(|table| table.get_ref().len() == 1)
        };
        let quoted = format!("{value:?}");
        let value = match () {
            () if is_toml(value) => value.to_owned(),
            () if is_name(value) => quoted,
            () => return Err(SettingError::Value(value.to_owned())),
        };
        Ok(Self { key: key.to_owned(), value })
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{}={}", self.key, self.value)
    }
}

/// A change of a text.
struct Change {
    /// Line of the new text, from 1, where it begins.
    line: usize,
    /// Lines of the old text that it goes over, beyond the one where it begins.
    old: usize,
    /// Lines of the new text, likewise.
    new: usize,
    /// Whether the line where it begins is all its own.
    whole: bool,
    /// Who made it.
    setting: Setting,
}

/// Changes of a text, in their order.
#[derive(Default)]
pub(crate) struct Changes(Vec<Change>);

/// Changes a text; refuses what cannot be set. A text that cannot be parsed stays as it is; its mistakes are reported when the scene is
/// read.
pub(crate) fn apply(text: &mut String, settings: &[Setting]) -> Result<Changes, SceneErrors> {
    let mut changes = Changes::default();
    for setting in settings {
        let Ok(root) = DeTable::parse(text) else { break };
        let root = Spanned::new(root.span(), DeValue::Table(root.into_inner()));
        if let Some(mistake) = objection(text, &root, setting) {
            let (file, key) = (format!("--set {setting}"), setting.key.clone());
            return Err(SceneErrors {
                list: vec![SceneError { file, line: None, table: String::new(), key, mistake }],
            });
        }
        let edit = edit(text, &root, setting);
        let (from, to) = (edit.from, edit.to);
        let lines = |text: &str| text.matches('\n').count();
        let line = 1 + lines(&text[..from]);
        // A whole line begins with the new text and ends with it.
        let new = lines(&edit.text) - usize::from(edit.whole);
        changes.0.push(Change { line, old: lines(&text[from..to]), new, whole: edit.whole, setting: setting.clone() });
        text.replace_range(from..to, &edit.text);
    }
    Ok(changes)
}

/// Why a text has no place for a setting.
fn objection(text: &str, root: &Spanned<DeValue>, setting: &Setting) -> Option<Mistake> {
    let unexpected = |found: &str, expected: String| Some(Mistake::Unexpected { found: found.to_owned(), expected });
    let mut value = root;
    for name in setting.key.split('.') {
        value = match (child(value, name), value.get_ref()) {
            (Some(below), _) => below,
            (None, DeValue::Table(_)) => return None,
            (None, DeValue::Array(list)) => return unexpected(name, format!("an entry from 1 to {}", list.len())),
            (None, other) => return unexpected(other.type_str(), format!("a table that may have a key {name}")),
        };
    }
    let is_value = !matches!(value.get_ref(), DeValue::Table(_)) || text[value.span()].starts_with('{');
    if is_value { None } else { unexpected("a table under a heading", "its keys one by one".to_owned()) }
}

/// What replaces a part of a text.
struct Edit {
    /// Where the part begins.
    from: usize,
    /// Where it ends.
    to: usize,
    /// What comes there.
    text: String,
    /// Whether that is whole lines.
    whole: bool,
}

/// How a setting changes a text.
fn edit(text: &str, root: &Spanned<DeValue>, setting: &Setting) -> Edit {
    let names: Vec<&str> = setting.key.split('.').collect();
    let (mut value, mut found) = (root, 0);
    while let Some(below) = names.get(found).and_then(|name| child(value, name)) {
        (value, found) = (below, found + 1);
    }
    let span = value.span();
    let insert = |at: usize, text: String, whole: bool| Edit { from: at, to: at, text, whole };
    let rest = names[found..].join(".");
    let is_table = matches!(value.get_ref(), DeValue::Table(_));
    let written = text.get(span.clone()).unwrap_or_default();
    if found == names.len() && (!is_table || written.starts_with('{')) {
        return Edit { from: span.start, to: span.end, text: setting.value.clone(), whole: false };
    }
    if found + 1 == names.len() && found == 0 {
        return insert(0, format!("{rest} = {}\n", setting.value), true);
    }
    if found > 0 && is_table && written.starts_with('{') {
        let comma = if written[1..].trim_start().starts_with('}') { "" } else { "," };
        return insert(span.start + 1, format!(" {rest} = {}{comma}", setting.value), false);
    }
    if found + 1 == names.len() && is_table && written.starts_with('[') {
        let end = text[span.start..].find('\n').map_or(text.len(), |end| span.start + end + 1);
        let before = if text[..end].ends_with('\n') { "" } else { "\n" };
        return insert(end, format!("{before}{rest} = {}\n", setting.value), before.is_empty());
    }
    let (table, key) = setting.key.rsplit_once('.').unwrap_or(("", &setting.key));
    let before = if text.is_empty() || text.ends_with('\n') { "" } else { "\n" };
    insert(text.len(), format!("{before}[{table}]\n{key} = {}\n", setting.value), before.is_empty())
}

/// The value of a key, or the entry of a list with this number.
fn child<'v, 'a>(value: &'v Spanned<DeValue<'a>>, name: &str) -> Option<&'v Spanned<DeValue<'a>>> {
    match value.get_ref() {
        DeValue::Table(table) => table.get(name),
        DeValue::Array(list) => list.get(name.parse::<usize>().ok()?.checked_sub(1)?),
        _ => None,
    }
}

impl Changes {
    /// Errors in the changed text, in the words of the text as it was.
    pub(crate) fn told(&self, scene: &str, mut errors: SceneErrors) -> SceneErrors {
        for error in errors.list.iter_mut().filter(|error| error.file == scene) {
            self.tell(error);
        }
        errors
    }

    /// The same for one error.
    fn tell(&self, error: &mut SceneError) {
        let place = [error.table.as_str(), error.key.as_str()].join(".");
        for Change { line, old, new, whole, setting } in self.0.iter().rev() {
            let Some(told) = error.line else { return };
            let inside = (*line..=line + new).contains(&told);
            if inside && (*whole || place.trim_start_matches('.') == setting.key) {
                error.file = format!("--set {setting}");
                error.line = None;
            } else if told > line + new {
                error.line = Some(told + old - new - usize::from(*whole));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A text with these settings.
    fn with(text: &str, settings: &[&str]) -> (String, Changes) {
        let settings: Vec<_> = settings.iter().map(|text| text.parse().unwrap()).collect();
        let mut text = text.to_owned();
        let changes = apply(&mut text, &settings).unwrap();
        (text, changes)
    }

    #[test]
    fn a_value_that_is_there_is_replaced_where_it_stands() {
        let text = "[run]\nend = 1.0 # so long\n[a]\nlist = [{ x = 1, y = 2 },\n  { x = 3 }]\n";
        let (changed, _) = with(text, &["run.end=2.5", "a.list.2.x=7"]);
        assert_eq!(changed, text.replace("1.0", "2.5").replace("x = 3", "x = 7"));
    }

    #[test]
    fn a_key_that_is_not_there_is_added_to_its_table() {
        let text = "[run] # all\nend = 1.0\n[pair.a.b]\nfriction = 0.1\n[m]\nshape = { x = 1 }\nother = {}\n";
        let settings =
            ["run.step=auto", "gravity=[0, 0, -9.81]", "m.shape.y=2", "m.other.z=3", "pair.a.a.friction=0.5"];
        let (changed, _) = with(text, &settings);
        let expected = "gravity = [0, 0, -9.81]\n[run] # all\nstep = \"auto\"\nend = 1.0\n[pair.a.b]\nfriction = 0.1\n[m]\n\
                        shape = { y = 2, x = 1 }\nother = { z = 3}\n[pair.a.a]\nfriction = 0.5\n";
        assert_eq!(changed, expected);
    }

    #[test]
    fn a_table_is_replaced_only_where_it_is_a_value() {
        let (changed, _) = with("[a]\nx = { y = 1 }\n", &["a.x={ z = 2 }"]);
        assert_eq!(changed, "[a]\nx = { z = 2 }\n");
    }

    #[test]
    fn what_a_text_has_no_place_for_is_refused() {
        let text = "[a.x.y]\nz = 1\nlist = [{ x = 1 }, { x = 3 }]\n";
        let told = |setting: &str| {
            let refused = apply(&mut text.to_owned(), &[setting.parse().unwrap()]);
            refused.err().map(|errors| errors.to_string())
        };
        let expected = [
            ("a.x={ z = 2 }", "expected its keys one by one, found a table under a heading"),
            ("a.x.y.list.3.x=1", "expected an entry from 1 to 2, found 3"),
            ("a.x.y.list.0.x=1", "expected an entry from 1 to 2, found 0"),
            ("a.x.y.list.x=1", "expected an entry from 1 to 2, found x"),
            ("a.x.y.z.w=1", "expected a table that may have a key w, found integer"),
        ];
        for (setting, words) in expected {
            let told = told(setting).unwrap_or_default();
            assert!(told.starts_with(&format!("--set {setting}")) && told.contains(words), "{told}");
        }
        assert_eq!(told("a.b.c=1"), None);
    }

    #[test]
    fn what_is_no_setting_is_refused() {
        let told = |text: &str| text.parse::<Setting>().unwrap_err().to_string();
        assert!(told("run.end").contains("expected KEY=VALUE"));
        assert!(told("run..end=1").contains("expected names with dots between them"));
        assert!(told("run.end=[1").contains("expected a number"));
        assert!(told("run.end=1\n[x]").contains("expected a number"));
    }

    #[test]
    fn mistakes_are_told_by_the_setting_or_by_the_line_of_the_old_text() {
        let (_, changes) = with("[run]\nend = 1.0\n[m]\nx = 1\n", &["run.step=1", "m.x=2", "gravity=3"]);
        let told = |line: usize, table: &str, key: &str| {
            let [file, table, key] = ["s", table, key].map(str::to_owned);
            let mistake = crate::base::document::Mistake::NoUnits;
            let error = SceneError { file, line: Some(line), table, key, mistake };
            let error = changes.told("s", SceneErrors { list: vec![error] }).list.remove(0);
            (error.file, error.line)
        };
        assert_eq!(told(1, "", "gravity"), ("--set gravity=3".to_owned(), None));
        assert_eq!(told(3, "run", "step"), ("--set run.step=1".to_owned(), None));
        assert_eq!(told(4, "run", "end"), ("s".to_owned(), Some(2)));
        assert_eq!(told(6, "m", "x"), ("--set m.x=2".to_owned(), None));
        assert_eq!(told(6, "m", "y"), ("s".to_owned(), Some(4)));
    }
}
