//! From `[bond.<name>.breakage]` to its rules: what the list makes of its rows.

use crate::base::quantity::Positive;
use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, Visitor};
use std::fmt;

/// The keys of one rule among those of the table.
pub trait KeysOf: Clone + Copy + Default + fmt::Debug + PartialEq + Send + Sync + 'static {
    /// Their names in the table.
    const NAMES: &'static [&'static str];
    /// Reads the value of the key of this place in [`KeysOf::NAMES`].
    fn read<'de, A: MapAccess<'de>>(&mut self, place: usize, table: &mut A) -> Result<(), A::Error>;
    /// What a unit may change while it runs.
    fn strengths(&mut self) -> Vec<Strength<'_>>;
}

/// A strength that a unit may change while it runs.
#[derive(Debug)]
pub struct Strength<'a> {
    /// Its key below `[bond.<name>.breakage]`.
    pub key: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its value.
    pub value: &'a mut Positive,
}

/// Declares keys that a rule has directly in `[bond.<name>.breakage]`; each may be absent. Strengths have a unit.
macro_rules! flat_keys {
    ($(#[$doc:meta])* { $($(#[$key_doc:meta])* $key:ident: $type:ty $([$unit:literal])?,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct Keys {
            $($(#[$key_doc])* pub $key: Option<$type>,)+
        }

        impl $crate::laws::bond::breakage::KeysOf for Keys {
            const NAMES: &'static [&'static str] = &[$(stringify!($key)),+];
            fn read<'de, A: serde::de::MapAccess<'de>>(&mut self, place: usize, table: &mut A) -> Result<(), A::Error> {
                let mut _next = 0;
                $(
                    if place == _next {
                        self.$key = Some(table.next_value()?);
                    }
                    _next += 1;
                )+
                Ok(())
            }
            fn strengths(&mut self) -> Vec<$crate::laws::bond::breakage::Strength<'_>> {
                let mut all = Vec::new();
                $($(
                    if let Some(value) = &mut self.$key {
                        all.push($crate::laws::bond::breakage::Strength { key: stringify!($key), unit: $unit, value });
                    }
                )?)+
                all
            }
        }
    };
}
pub(in crate::laws::bond) use flat_keys;

/// Declares the keys of a rule that has a table of its own, `[bond.<name>.breakage.<rule>]`. Strengths have a unit.
macro_rules! named_keys {
    ($(#[$doc:meta])* $rule:ident { $($(#[$key_doc:meta])* $key:ident: $type:ty $([$unit:literal])?,)+ }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
        #[serde(deny_unknown_fields)]
        pub struct Table {
            $($(#[$key_doc])* pub $key: $type,)+
        }

        /// The rule's table, if the scene has it.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct Keys(pub Option<Table>);

        impl $crate::laws::bond::breakage::KeysOf for Keys {
            const NAMES: &'static [&'static str] = &[stringify!($rule)];
            fn read<'de, A: serde::de::MapAccess<'de>>(&mut self, _: usize, table: &mut A) -> Result<(), A::Error> {
                self.0 = Some(table.next_value()?);
                Ok(())
            }
            fn strengths(&mut self) -> Vec<$crate::laws::bond::breakage::Strength<'_>> {
                let mut all = Vec::new();
                if let Some(_table) = &mut self.0 {
                    $($(
                        all.push($crate::laws::bond::breakage::Strength {
                            key: concat!(stringify!($rule), ".", stringify!($key)),
                            unit: $unit,
                            value: &mut _table.$key,
                        });
                    )?)+
                }
                all
            }
        }
    };
}
pub(in crate::laws::bond) use named_keys;

/// Declares the list of rules: yields the keys of `[bond.<name>.breakage]`, the rules they mean, and the names of all
/// causes. A new rule is one row.
macro_rules! breakage_rules {
    ($($name:ident: $file:ident::$rule:ident,)+) => {
        /// `[bond.<name>.breakage]`: the keys of each rule.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct BreakageKeys {
            $(#[doc = concat!("Those of `", stringify!($name), "`.")] pub $name: <$file::$rule as Breakage>::Keys,)+
        }

        /// One of the rules, in numbers.
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(clippy::enum_variant_names, reason = "rules have the names of their files")]
        pub enum Rule {
            $(#[doc = concat!("`", stringify!($name), "`")] $rule($file::$rule),)+
        }

        /// The names of the causes of each rule, in the order of the list. The code of a cause is its place in all of
        /// them, from 1.
        const CAUSES: &[&[&str]] = &[$(<$file::$rule as Breakage>::CAUSES),+];

        /// The keys of which one at least must stand in the table.
        const LIMITS: &[&[&str]] = &[$(<$file::$rule as Breakage>::LIMITS),+];

        /// Names of the rules, in the order of the list.
        const NAMES: &[&str] = &[$(stringify!($name)),+];

        /// The name of the cause with this code in `breakage.csv`; `None` where no rule reports it.
        pub fn cause_name(code: f64) -> Option<&'static str> {
            (1..).zip(CAUSES.concat()).find(|(number, _)| f64::from(*number) == code).map(|(_, name)| name)
        }

        /// What is to be done with a rule once its type is known.
        pub trait TakeRule {
            /// The type of the result.
            type Output;
            /// Called once. What the rule answers lies this far above its place among the causes of all rules.
            fn take<B: Breakage>(self, rule: B, before: f64) -> Self::Output;
        }

        impl Rule {
            /// Goes from the row of the list to its type.
            pub fn visit<V: TakeRule>(&self, visitor: V) -> V::Output {
                let before = |name: &str| -> f64 {
                    let rows = NAMES.iter().zip(CAUSES).take_while(|(other, _)| **other != name);
                    rows.map(|(_, causes)| causes.len() as f64).sum()
                };
                match *self {
                    $(Self::$rule(rule) => visitor.take(rule, before(stringify!($name))),)+
                }
            }
        }

        impl BreakageKeys {
            /// The rules that they mean, in the order of the list.
            pub fn rules(&self, formulation: FormulationChoice) -> Vec<Rule> {
                let mut rules = Vec::new();
                $(rules.extend(<$file::$rule>::of(&self.$name, formulation).map(Rule::$rule));)+
                rules
            }

            /// What they say that cannot be.
            pub(in crate::laws::bond) fn check(&self, formulation: FormulationChoice, wrong: &mut Vec<KeyError>) {
                $(<$file::$rule>::check(&self.$name, self, formulation, wrong);)+
                if self.rules(formulation).is_empty() {
                    let message = format!("expected {} or no table, found no limit", LIMITS.concat().join(", "));
                    wrong.push(KeyError { key: "breakage", message });
                }
            }

            /// What a unit may change while it runs.
            pub fn strengths(&mut self) -> Vec<Strength<'_>> {
                let mut all = Vec::new();
                $(all.extend(self.$name.strengths());)+
                all
            }
        }

        impl<'de> serde::Deserialize<'de> for BreakageKeys {
            fn deserialize<D: serde::Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                /// Reads the table key by key.
                struct Reader;
                impl<'de> serde::de::Visitor<'de> for Reader {
                    type Value = BreakageKeys;
                    fn expecting(&self, formatter: &mut std::fmt::Formatter) -> std::fmt::Result {
                        formatter.write_str("a table")
                    }
                    fn visit_map<A: serde::de::MapAccess<'de>>(self, mut table: A) -> Result<BreakageKeys, A::Error> {
                        let names = [$(<<$file::$rule as Breakage>::Keys as KeysOf>::NAMES),+].concat();
                        let mut keys = BreakageKeys::default();
                        while let Some(place) = table.next_key_seed($crate::laws::bond::breakage::keys::OneOf(&names))? {
                            let mut _from = 0;
                            $(
                                let count = <<$file::$rule as Breakage>::Keys as KeysOf>::NAMES.len();
                                if (_from.._from + count).contains(&place) {
                                    keys.$name.read(place - _from, &mut table)?;
                                }
                                _from += count;
                            )+
                        }
                        Ok(keys)
                    }
                }
                deserializer.deserialize_map(Reader)
            }
        }
    };
}
pub(in crate::laws::bond) use breakage_rules;

/// A key that must be one of these: read as its place among them.
pub(in crate::laws::bond) struct OneOf<'a>(pub(in crate::laws::bond) &'a [&'static str]);

impl<'de> DeserializeSeed<'de> for OneOf<'_> {
    type Value = usize;
    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<usize, D::Error> {
        deserializer.deserialize_identifier(self)
    }
}

impl Visitor<'_> for OneOf<'_> {
    type Value = usize;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("a key")
    }

    fn visit_str<E: Error>(self, found: &str) -> Result<usize, E> {
        let known = || self.0.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ");
        let place = self.0.iter().position(|name| *name == found);
        // In the words of serde's own error, which the messages of a scene start from.
        place.ok_or_else(|| E::custom(format_args!("unknown field `{found}`, expected one of {}", known())))
    }
}
