//! Keys of tables: what reads a key is its line in the documentation.

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

        #[cfg(test)]
        impl $crate::base::document::Table for $table {
            const NAME: &'static str = stringify!($table);
            const KEYS: &'static [$crate::base::document::Key] = &[$($crate::base::document::Key {
                name: stringify!($key),
                about: concat!($($about),+),
                takes: stringify!($type),
                default: $default,
            }),*];
        }
    };
}
pub(crate) use keys;

/// A key of a table.
#[cfg(test)]
pub(crate) struct Key {
    /// Its name, as code has it.
    pub(crate) name: &'static str,
    /// What it means.
    pub(crate) about: &'static str,
    /// The type that reads it.
    pub(crate) takes: &'static str,
    /// What holds where it is absent, in words.
    pub(crate) default: &'static str,
}

/// A table of keys.
#[cfg(test)]
pub(crate) trait Table {
    /// Name of its type.
    const NAME: &'static str;
    /// Its keys.
    const KEYS: &'static [Key];
}

#[cfg(test)]
impl Key {
    /// Its line in the documentation.
    fn line(&self) -> String {
        let (name, about) = (self.name.trim_start_matches("r#"), self.about.trim().trim_end_matches('.'));
        let takes = self.takes.trim_start_matches("Option<").trim_end_matches('>');
        let range = match takes {
            "Positive" => ", > 0",
            "NonNegative" => ", ≥ 0",
            "AtLeastOne" | "NonZeroU32" => ", ≥ 1",
            "Porosity" => ", > 0 and ≤ 1",
            "Fraction" => ", 0 to 1",
            "Safety" => ", > 0 and < 1",
            "PoissonsRatio" => ", 0 to 0.5",
            _ => "",
        };
        format!("| `{name}` | {about}{range} | {} |\n", self.default)
    }
}

/// The table of the documentation.
#[cfg(test)]
pub(crate) fn printed(keys: &[Key]) -> String {
    let lines: String = keys.iter().map(Key::line).collect();
    format!("| key | meaning | default |\n|---|---|---|\n{lines}")
}
