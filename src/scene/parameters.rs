//! Numbers of a scene that a unit shows as its parameters.
//!
//! A parameter is a number that stands in the text of the scene. Its name is the dotted key, as `--set` takes it, and it is
//! checked by the type that reads the key.

use super::SceneDraft;
use crate::base::quantity::{MaterialIndex, Positive, Range};
use crate::laws::bond::Law;
use crate::laws::bond::keys::KeyError;
use crate::laws::contact::Properties;

/// A number of the text that is a parameter of the unit.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name: the dotted key.
    pub name: String,
    /// Its value in this scene.
    pub value: f64,
    /// Its unit; none for a whole number.
    pub unit: Option<String>,
    /// Which numbers it takes.
    pub range: Range,
    /// Whether it may be changed between communication steps.
    pub tunable: bool,
    /// What it is.
    pub about: String,
}

impl SceneDraft {
    /// The parameters that may be changed between communication steps, in their order.
    pub fn tunables(&self) -> impl Iterator<Item = &Parameter> {
        self.parameters.iter().filter(|parameter| parameter.tunable)
    }

    /// The materials of a parameter `pair.<a>.<b>.<property>`.
    pub(crate) fn pair_of(&self, name: &str) -> Option<[MaterialIndex; 2]> {
        let [_, a, b, _] = name.strip_prefix("pair.").map(|_| name.split('.').collect::<Vec<_>>())?[..] else {
            return None;
        };
        let find = |name: &str| self.materials.iter().position(|material| material.name == name);
        Some([find(a)?, find(b)?].map(|index| MaterialIndex(index as u32)))
    }

    /// The bond law of a parameter `bond.<name>.breakage.<key>`, and the key.
    pub(crate) fn strength_of<'a>(&self, name: &'a str) -> Option<(usize, &'a str)> {
        let (bond, key) = name.strip_prefix("bond.")?.split_once(".breakage.")?;
        Some((self.bonds.iter().position(|it| it.name == bond)?, key))
    }

    /// The properties of two materials with these values of the tunable parameters.
    pub(crate) fn tuned_pair(&self, pair: [MaterialIndex; 2], tuned: &[f64]) -> Option<Properties> {
        let [a, b] = pair.map(MaterialIndex::index);
        let mut properties = self.pairs.get(a * self.materials.len() + b)?.clone();
        for (parameter, &value) in self.tunables().zip(tuned) {
            if self.pair_of(&parameter.name) == Some(pair) {
                let (property, _) = properties.named(parameter.name.rsplit('.').next()?)?;
                property.range.check(value).ok()?;
                properties = properties.with(property, value);
            }
        }
        Some(properties)
    }

    /// A bond law with these values of the tunable parameters, or what they contradict.
    pub(crate) fn tuned_law(&self, bond: usize, tuned: &[f64]) -> Result<Law, Vec<KeyError>> {
        let strength = |key: &str| {
            let is_it = |name| self.strength_of(name).is_some_and(|(law, its)| law == bond && its == key);
            let (_, value) = self.tunables().zip(tuned).find(|(parameter, _)| is_it(&parameter.name))?;
            Positive::new(*value)
        };
        self.bonds[bond].keys.tuned_law(self.run.scheme.predicts(), &strength)
    }
}
