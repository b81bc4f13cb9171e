//! What the program knows of a rule of breakage: one static row for each, made from its type.

use super::{Breakage, Loaded, LoadedBonds, Strength};
use crate::base::document::{Document, Faults, Part};
use crate::base::lanes::{self, Kernel, Lane, Width};
use crate::base::quantity::Positive;
use crate::laws::bond::formulation::FormulationChoice;
use crate::laws::bond::key_error::KeyError;
use crate::laws::kept::{self, Kept, keep, of_kind, own};
use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// New values of strengths, by their keys below `[bond.<name>.breakage]`.
pub(in crate::laws::bond) type NewStrengths<'a> = &'a dyn Fn(&str) -> Option<Positive>;

/// Makes a rule of its keys and new strengths, among all rules of a bond of this formulation; adds what the keys contradict.
type MakeRule = fn(Kept, NewStrengths, (&[BreakageChoice], FormulationChoice), &mut Vec<KeyError>) -> Rule;

/// What the program knows of a rule of breakage.
pub struct BreakageRow {
    /// Its name.
    name: &'static str,
    /// Its keys in `[bond.<name>.breakage]`.
    keys: &'static [&'static str],
    /// Those of which one at least must stand there.
    limits: &'static [&'static str],
    /// Reads its keys from the breakage of a bond table.
    read: fn(&Document, &str, &mut Faults) -> Option<Kept>,
    /// Its strengths: key and unit.
    strengths: fn(Kept) -> Vec<(String, &'static str)>,
    /// The rule in numbers.
    rule: MakeRule,
}

impl BreakageRow {
    /// The row of a rule.
    pub const fn of<B: Breakage>() -> &'static Self {
        const {
            &Self {
                name: B::NAME,
                keys: if B::FLAT_KEYS.is_empty() { &[B::NAME] } else { B::FLAT_KEYS },
                limits: B::LIMITS,
                read: read::<B>,
                strengths: |keys| {
                    let mut keys = *own::<B::Keys>(keys);
                    B::strengths(&mut keys).iter().map(|strength| (name::<B>(strength), strength.unit)).collect()
                },
                rule: rule::<B>,
            }
        }
    }

    /// Its name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Its keys in `[bond.<name>.breakage]`.
    pub(crate) fn keys(&self) -> &'static [&'static str] {
        self.keys
    }

    /// Those of which one at least must stand there.
    pub(crate) fn limits(&self) -> &'static [&'static str] {
        self.limits
    }

    /// Reads the rule from the breakage of this bond table.
    pub(crate) fn read(&'static self, document: &Document, bond: &str, faults: &mut Faults) -> Option<BreakageChoice> {
        (self.read)(document, bond, faults).map(|keys| BreakageChoice { row: self, keys })
    }
}

impl fmt::Debug for BreakageRow {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name)
    }
}

/// Reads the keys of a rule: a table of its own, or its part of the table of all rules.
fn read<B: Breakage>(document: &Document, bond: &str, faults: &mut Faults) -> Option<Kept> {
    match B::FLAT_KEYS {
        [] => kept::read::<B::Keys>(document, bond, &format!("breakage.{}", B::NAME), faults),
        flat => document.read_part::<B::Keys>(bond, "breakage", Part::Only(flat), faults).map(keep),
    }
}

/// The key of a strength below `[bond.<name>.breakage]`.
fn name<B: Breakage>(strength: &Strength) -> String {
    if B::FLAT_KEYS.is_empty() { format!("{}.{}", B::NAME, strength.key) } else { strength.key.to_owned() }
}

/// The rule in numbers, with other strengths than its keys have.
fn rule<B: Breakage>(
    keys: Kept,
    new: NewStrengths,
    (all, formulation): (&[BreakageChoice], FormulationChoice),
    wrong: &mut Vec<KeyError>,
) -> Rule {
    let mut keys = *own::<B::Keys>(keys);
    for strength in B::strengths(&mut keys) {
        if let Some(value) = new(&name::<B>(&strength)) {
            *strength.value = value;
        }
    }
    if formulation.is_engine() && !B::IS_THE_ENGINES {
        let key = format!("breakage.{}", B::LIMITS.first().unwrap_or(&B::NAME));
        let message = "expected a limit of the engine, as engine_exact has no other, found this one";
        wrong.push(KeyError::at(key, message));
    }
    B::check(&keys, all, formulation, wrong);
    Rule::of(B::of(&keys, formulation))
}

/// A rule as a scene chose it: its row and its keys.
#[derive(Clone, Copy, Debug)]
pub struct BreakageChoice {
    /// What the program knows of it.
    row: &'static BreakageRow,
    /// What the scene writes of it.
    keys: Kept,
}

impl BreakageChoice {
    /// A rule with these keys.
    pub fn of<B: Breakage>(keys: B::Keys) -> Self {
        Self { row: BreakageRow::of::<B>(), keys: keep(keys) }
    }

    /// What the program knows of it.
    pub fn row(&self) -> &'static BreakageRow {
        self.row
    }

    /// Its keys, if they are of this type.
    pub fn keys<K: 'static>(&self) -> Option<&'static K> {
        of_kind(self.keys)
    }

    /// What a unit may change while it runs: the key below `[bond.<name>.breakage]`, and the unit.
    pub fn strengths(&self) -> Vec<(String, &'static str)> {
        (self.row.strengths)(self.keys)
    }

    /// The rule in numbers, one of all of a bond of this formulation, with new strengths; what its keys contradict is added.
    pub(in crate::laws::bond) fn rule(
        &self,
        new: NewStrengths,
        beside: (&[Self], FormulationChoice),
        wrong: &mut Vec<KeyError>,
    ) -> Rule {
        (self.row.rule)(self.keys, new, beside, wrong)
    }
}

/// A rule in numbers, whose type is forgotten.
#[derive(Clone, Debug)]
pub struct Rule {
    /// What judges.
    judge: Arc<dyn Judge>,
    /// [`Breakage::CAUSES`]
    causes: &'static [&'static str],
}

/// [`Breakage::judge`] of a rule whose type is forgotten.
trait Judge: Any + fmt::Debug + Send + Sync {
    /// Of one bond.
    fn one(&self, loaded: &Loaded) -> f64;
    /// Of a register's worth of bonds: enters the causes, `before` above their places.
    fn several(&self, width: Width, bonds: &mut LoadedBonds, radius_multiplier: f64, before: f64);
}

impl<B: Breakage> Judge for B {
    fn one(&self, loaded: &Loaded) -> f64 {
        self.judge(loaded)
    }

    fn several(&self, width: Width, bonds: &mut LoadedBonds, radius_multiplier: f64, before: f64) {
        lanes::run(width, JudgeBonds { rule: self, bonds, radius_multiplier, before });
    }
}

impl Rule {
    /// A rule with these numbers.
    pub fn of<B: Breakage>(numbers: B) -> Self {
        Self { judge: Arc::new(numbers), causes: B::CAUSES }
    }

    /// Its numbers, if they are of this type.
    pub fn numbers<B: Breakage>(&self) -> Option<&B> {
        let any: &dyn Any = &*self.judge;
        any.downcast_ref()
    }

    /// The causes that it reports.
    pub fn causes(&self) -> &'static [&'static str] {
        self.causes
    }

    /// 0 if the bond holds, else the place of its cause among [`Rule::causes`], from 1.
    pub(in crate::laws::bond) fn judge(&self, loaded: &Loaded) -> f64 {
        self.judge.one(loaded)
    }

    /// Enters the causes of a register's worth of bonds, `before` above their places.
    pub(crate) fn judge_several(&self, width: Width, bonds: &mut LoadedBonds, radius_multiplier: f64, before: f64) {
        self.judge.several(width, bonds, radius_multiplier, before);
    }
}

/// A rule that looks at a register's worth of bonds.
struct JudgeBonds<'a, B> {
    /// The rule.
    rule: &'a B,
    /// The bonds.
    bonds: &'a mut LoadedBonds,
    /// λ: bond radius over the smaller radius.
    radius_multiplier: f64,
    /// How far the codes of its causes lie above their places.
    before: f64,
}

impl<B: Breakage> Kernel for JudgeBonds<'_, B> {
    #[inline(always)]
    fn run<N: Lane>(self) {
        let found = self.rule.judge(&self.bonds.loaded(N::splat(self.radius_multiplier)));
        let code = N::select(found.greater(N::zero()), found + N::splat(self.before), N::zero());
        self.bonds.enter_causes(code);
    }
}
