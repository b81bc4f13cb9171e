//! Keys of tables: what reads a key is its line in the documentation, and the parameter of a unit.

use crate::base::quantity::Range;

/// Declares a table of a scene: each key once, with its type, what it means, and its default in words. The type refuses what the key
/// does not take and other keys, and names the nearest. The line of the documentation is printed of the same: a test finds it.
///
/// What stands behind `beside` is no key that the documentation has: what is read on its own, and what is answered.
macro_rules! keys {
    (
        $(#[$attribute:meta])*
        $visible:vis struct $table:ident {
            $($(#[doc = $about:literal])+ $(#[serde($($serde:tt)*)])? $see:vis $key:ident: $type:ty = $default:literal,)*
        }
        $(beside { $($(#[$further:meta])+ $beside_see:vis $beside:ident: $beside_type:ty,)* })?
    ) => {
        #[derive(serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        $(#[$attribute])*
        $visible struct $table {
            $($(#[doc = $about])+ $(#[serde($($serde)*)])? $see $key: $type,)*
            $($($(#[$further])+ $beside_see $beside: $beside_type,)*)?
        }

        impl $crate::base::document::Table for $table {
            #[cfg(test)]
            const NAME: &'static str = stringify!($table);
            const KEYS: &'static [$crate::base::document::Key] = &[$($crate::base::document::Key {
                name: stringify!($key),
                about: concat!($($about),+),
                takes: stringify!($type),
                #[cfg(test)]
                default: $default,
            }),*];
        }
    };
}
pub(crate) use keys;

/// A key of a table.
pub(crate) struct Key {
    /// Its name, as code has it.
    pub(crate) name: &'static str,
    /// What it means, with its unit in brackets.
    pub(crate) about: &'static str,
    /// The type that reads it.
    pub(crate) takes: &'static str,
    /// What holds where it is absent, in words.
    #[cfg(test)]
    pub(crate) default: &'static str,
}

/// A table of keys.
pub(crate) trait Table {
    /// Name of its type.
    #[cfg(test)]
    const NAME: &'static str;
    /// Its keys.
    const KEYS: &'static [Key];
}

impl Key {
    /// Which numbers it takes, if it is a number.
    pub(crate) fn range(&self) -> Option<Range> {
        Range::of_type(self.takes.trim_start_matches("Option<").trim_end_matches('>'))
    }

    /// What it means, and its unit as variables of a unit have it; 1 where it has none.
    pub(crate) fn meaning(&self) -> (String, String) {
        let about = self.about.trim().trim_end_matches('.');
        match about.split_once(r" \[").and_then(|(before, rest)| Some((before, rest.split_once(r"\]")?))) {
            Some((before, (unit, after))) => {
                (format!("{before}{after}"), unit.replace('²', "2").replace('³', "3").replace(' ', "."))
            }
            None => (about.to_owned(), "1".to_owned()),
        }
    }
}

#[cfg(test)]
impl Key {
    /// Its name and its meaning in the documentation.
    fn told(&self) -> [String; 2] {
        let (name, about) = (self.name.trim_start_matches("r#"), self.about.trim().trim_end_matches('.'));
        let range = self.range().map_or_else(String::new, |range| format!(", {}", range.words()));
        [format!("`{name}`"), format!("{about}{range}")]
    }

    /// Its line in the documentation.
    fn line(&self) -> String {
        let [name, meaning] = self.told();
        format!("| {name} | {meaning} | {} |\n", self.default)
    }

    /// The same among others in one cell, its default in brackets where it has one.
    fn phrase(&self) -> String {
        let [name, meaning] = self.told();
        let default = if self.default == "required" { String::new() } else { format!(" ({})", self.default) };
        format!("{name}: {meaning}{default}")
    }
}

/// The table of the documentation.
#[cfg(test)]
pub(crate) fn printed(keys: &[Key]) -> String {
    let lines: String = keys.iter().map(Key::line).collect();
    format!("| key | meaning | default |\n|---|---|---|\n{lines}")
}

/// The table of the documentation of models: a line for each key, with all models that have it.
#[cfg(test)]
pub(crate) fn printed_by_model(models: &[(&str, &[Key])]) -> String {
    let mut lines: Vec<(String, String)> = Vec::new();
    for (model, key) in models.iter().flat_map(|(model, keys)| keys.iter().map(move |key| (model, key))) {
        let line = key.line();
        match lines.iter_mut().find(|(_, own)| *own == line) {
            Some((models, _)) => models.push_str(&format!(", `{model}`")),
            None => lines.push((format!("`{model}`"), line)),
        }
    }
    let lines: String = lines.into_iter().map(|(models, line)| format!("| {models} {line}")).collect();
    format!("| model | key | meaning | default |\n|---|---|---|---|\n{lines}")
}

/// The table of the documentation of several tables: a line for each.
#[cfg(test)]
pub(crate) fn printed_together(what: &str, tables: &[(&str, &[Key])]) -> String {
    let line = |(name, keys): &(&str, &[Key])| {
        let phrases: Vec<String> = keys.iter().map(Key::phrase).collect();
        format!("| `{name}` | {} |\n", phrases.join("; "))
    };
    let lines: String = tables.iter().map(line).collect();
    format!("| {what} | keys (default) |\n|---|---|\n{lines}")
}
