//! A bond law, whole, and what it does to one bond.

use super::breakage::{Loaded, NewStrengths, Rule, stress};
use super::damping::{Damping, DampingChoice, DampingLoad, LastDamping, TakeDamping};
use super::elasticity::Parts;
use super::formulation::{Formulation, FormulationChoice, FormulationNeeds, TakeFormulation};
use super::keys::{BreakageChoice, KeyError, Keys};
use super::{Coefficients, Elastic, Elasticity, Motion, Pair, RateRows, Rates, Rows};
use crate::base::number::Vector;
use crate::base::quantity::Positive;

/// |u| up to which the engine's bond bears no normal force \[m\].
const ENGINE_DEAD_BAND: f64 = 1e-15;

/// The law of a `[bond.<name>]` table in numbers.
#[derive(Clone, Debug)]
pub struct Law {
    /// How force and moments follow from the motion.
    pub formulation: FormulationChoice,
    /// Section, stiffnesses, relaxation.
    pub elasticity: Elasticity,
    /// Damping, if there is any.
    pub damping: Option<DampingChoice>,
    /// Whether dashpots see the rates at the end of the step, extrapolated from those of the middle of this step and of the one before.
    pub foresees: bool,
    /// Rules of breakage, in the order of their list.
    pub breakage: Vec<Rule>,
    /// What compression adds to the reported normal stress of a bond, over |N|/A: 1 where compression breaks, −1 where
    /// it relieves.
    pub compression_share: f64,
}

/// What one bond does to its two bodies.
#[derive(Clone, Copy, Debug)]
pub struct Reaction {
    /// Force on i; j gets the opposite. 0 where the bond broke \[N\].
    pub force: Vector,
    /// Torque on i \[N m\].
    pub torque_i: Vector,
    /// Torque on j \[N m\].
    pub torque_j: Vector,
    /// Elastic energy that relaxation took in this evaluation \[J\].
    pub relaxed: f64,
    /// What damping does, as part of that, and what it remembers.
    pub damping: LastDamping,
    /// Energy that damping took since the last evaluation \[J\].
    pub damped: f64,
    /// 0, or why the bond broke: the code of [`Law::cause_name`].
    pub cause: f64,
    /// Whether the bond is bent beyond what can be followed.
    pub overbent: bool,
    /// The state to remember.
    pub rows: Rows,
}

/// What a formulation makes of the law at a step, the bodies and the rows of a bond.
type ResponseFunction = fn(&Coefficients, &Pair, &Rows) -> (Motion, Elastic<f64>);

/// A formulation for one bond at a time, its type forgotten.
#[derive(Clone, Copy, Debug)]
pub struct OneBond {
    /// [`Formulation::ROWS`]
    pub rows: usize,
    /// [`Formulation::FIXED_ROWS`]
    pub fixed_rows: usize,
    /// [`Formulation::NEEDS_ORIENTATIONS`]
    pub needs_orientations: bool,
    /// [`Formulation::RATES`]
    pub rates: Rates,
    /// [`Formulation::create`]
    pub create: fn(&Coefficients, &Pair) -> Rows,
    /// [`Formulation::respond`]
    pub respond: ResponseFunction,
}

/// Takes the functions of a formulation.
pub(super) struct TakeFunctions;

impl TakeFormulation for TakeFunctions {
    type Output = OneBond;
    fn take<F: Formulation>(self) -> OneBond {
        OneBond {
            rows: F::ROWS,
            fixed_rows: F::FIXED_ROWS,
            needs_orientations: F::NEEDS_ORIENTATIONS,
            rates: F::RATES,
            create: F::create::<f64>,
            respond: F::respond::<f64>,
        }
    }
}

/// Asks damping what it is to the stable time step, with these stiffnesses.
struct TakeLinear<'a>(&'a Pair, Parts);

impl TakeDamping for TakeLinear<'_> {
    type Output = [Parts; 2];
    fn take<D: Damping>(self, damping: D) -> [Parts; 2] {
        damping.linear(self.0, self.1)
    }
}

/// Takes what a formulation remembers.
struct TakeRemembered;

impl TakeFormulation for TakeRemembered {
    type Output = &'static str;
    fn take<F: Formulation>(self) -> &'static str {
        F::REMEMBERED
    }
}

/// How many rows of state a bond of this formulation has.
pub fn rows(formulation: FormulationChoice) -> usize {
    formulation.visit(FormulationNeeds::ALL, TakeFunctions).rows
}

/// What each formulation of the program remembers of a bond, as text.
pub fn remembered() -> String {
    let line = |choice: &FormulationChoice| {
        format!("{}: {}\n", choice.name(), choice.visit(FormulationNeeds::ALL, TakeRemembered))
    };
    FormulationChoice::ALL.iter().map(line).collect()
}

impl Keys {
    /// The law in numbers, or every contradiction among the keys. Dashpots see the rates at the middle of the step, or those at
    /// its end where the time integration predicts them (`[run] scheme = "predicted"`).
    pub fn law(&self, predicts: bool) -> Result<Law, Vec<KeyError>> {
        self.tuned_law(predicts, &|_| None)
    }

    /// The same with new strengths, by their keys below `[bond.<name>.breakage]`.
    pub(crate) fn tuned_law(&self, predicts: bool, new: NewStrengths) -> Result<Law, Vec<KeyError>> {
        let mut wrong = self.contradictions();
        let rule = |rule: &BreakageChoice| rule.rule(new, (&self.breakage, self.formulation), &mut wrong);
        let breakage: Vec<Rule> = self.breakage.iter().map(rule).collect();
        let own_share = self.breakage.iter().find_map(|rule| rule.keys::<stress::Keys>()).copied().unwrap_or_default();
        if !wrong.is_empty() {
            return Err(wrong);
        }
        let part = |bears: bool, stiffness: f64| if bears { stiffness } else { 0.0 };
        let (normal, tangential) = (self.normal_stiffness.get(), self.tangential_stiffness.get());
        Ok(Law {
            formulation: self.formulation,
            elasticity: Elasticity {
                radius_multiplier: self.radius_multiplier.map_or(1.0, Positive::get),
                tension: part(self.tension, normal),
                compression: part(self.compression, normal),
                shear: part(self.shear, tangential),
                torsion: part(self.torsion, tangential),
                bending: part(self.bending, normal),
                dead_band: if self.formulation.is_engine() { ENGINE_DEAD_BAND } else { 0.0 },
                relaxation_rate: self.relaxation.map_or([0.0; 4], |keys| keys.parts(|time| 1.0 / time.get())),
            },
            damping: self.damping,
            foresees: predicts && self.damping.is_some_and(|damping| damping.is_dashpots()),
            breakage,
            compression_share: own_share.compression_share(self.formulation),
        })
    }
}

impl Law {
    /// What a bond of this pair is to the stable time step: stiffness \[N/m, N m\] and dashpots \[kg/s, N m s\] of each part.
    pub fn linear(&self, pair: &Pair) -> [Parts; 2] {
        let stiffness = self.elasticity.stiffness(pair.least_radius);
        let Some(damping) = self.damping else { return [stiffness, [0.0; 4]] };
        let [stiffness, dashpots] = damping.visit(TakeLinear(pair, stiffness));
        // Rates that are extrapolated count twice, as at contacts ([`crate::laws::contact::Scheme::damping_factor`]).
        [stiffness, dashpots.map(|dashpot| if self.foresees { 2.0 * dashpot } else { dashpot })]
    }

    /// How many rows a bond remembers of its damping.
    pub fn damping_rows(&self) -> usize {
        let of_rates = if self.foresees { LastDamping::default().rates.len() } else { 0 };
        self.damping.map_or(0, |_| LastDamping::default().load.len() + of_rates)
    }

    /// What a new bond remembers of its damping: no load, and the rates with which it begins.
    pub fn first_damping(&self, law: &Coefficients, pair: &Pair) -> LastDamping {
        let rates = if self.foresees { self.rates(law, pair) } else { RateRows::default() };
        LastDamping { rates, ..LastDamping::default() }
    }

    /// The rates of a bond at the middle of the step.
    fn rates(&self, law: &Coefficients, pair: &Pair) -> RateRows {
        Motion::of(self.one_bond().rates, law, pair).settled().rates()
    }

    /// A conservative bond that does not break.
    pub fn elastic(formulation: FormulationChoice, elasticity: Elasticity) -> Self {
        let compression_share = if formulation.is_engine() { 1.0 } else { -1.0 };
        Self { formulation, elasticity, damping: None, foresees: false, breakage: Vec::new(), compression_share }
    }

    /// What it asks of its formulation.
    pub fn asked(&self) -> FormulationNeeds {
        FormulationNeeds { relaxation: self.elasticity.relaxes(), rates: self.damping.is_some() }
    }

    /// Whether a living bond loses energy.
    pub fn dissipates(&self) -> bool {
        self.damping.is_some() || self.asked().relaxation
    }

    /// Its formulation for one bond.
    pub fn one_bond(&self) -> OneBond {
        self.formulation.visit(self.asked(), TakeFunctions)
    }

    /// Force, torque, breakage and new state of one bond, whose damping left this in the last evaluation.
    pub fn react(&self, law: &Coefficients, pair: &Pair, rows: &Rows, last: &LastDamping) -> Reaction {
        let (motion, elastic) = (self.one_bond().respond)(law, pair, rows);
        let mut reaction = Reaction {
            force: elastic.force,
            torque_i: elastic.torque_i,
            torque_j: elastic.torque_j,
            relaxed: elastic.relaxed,
            damping: LastDamping { load: [[0.0; 4]; 3], ..*last },
            damped: DampingLoad::from_rows(last.load).taken(pair, law.step),
            cause: self.judge(&elastic.loaded(&motion)),
            overbent: elastic.overbent,
            rows: elastic.rows,
        };
        if reaction.cause != 0.0 {
            [reaction.force, reaction.torque_i, reaction.torque_j] = [Vector::zero(); 3];
        } else if let Some(damping) = &self.damping {
            let settled = motion.settled();
            // Without a time step the velocities are already those of its end.
            let foresees = self.foresees && law.step > 0.0;
            let motion = if foresees { settled.foreseen(last.rates) } else { settled };
            let load = damping.visit(DampOne { law, pair, motion: &motion, elastic: &elastic });
            reaction.force += load.force;
            reaction.torque_i += load.torque_i;
            reaction.torque_j += load.torque_j;
            reaction.damped += load.taken(pair, law.step);
            let rates = if foresees { settled.rates() } else { last.rates };
            reaction.damping = LastDamping { load: load.to_rows(), rates };
        }
        reaction
    }

    /// 0, or the code of the first cause for which a bond under this load breaks.
    pub fn judge(&self, loaded: &Loaded) -> f64 {
        let code = |(rule, before): (&Rule, f64)| Some(rule.judge(loaded)).filter(|it| *it > 0.0).map(|it| it + before);
        self.rules().find_map(code).unwrap_or(0.0)
    }

    /// Its rules of breakage, and how far the codes of their causes lie above their places: the code of a cause is its place
    /// among those of all rules, from 1.
    pub(crate) fn rules(&self) -> impl Iterator<Item = (&Rule, f64)> {
        self.breakage.iter().scan(0.0, |before, rule| {
            let here = *before;
            *before += rule.causes().len() as f64;
            Some((rule, here))
        })
    }

    /// The name of the cause with this code, as in `breakage.csv`; `None` where no rule reports it.
    pub fn cause_name(&self, code: f64) -> Option<&'static str> {
        let names = self.breakage.iter().flat_map(|rule| rule.causes());
        (1..).zip(names).find(|(number, _)| f64::from(*number) == code).map(|(_, name)| *name)
    }
}

/// One bond to be damped.
struct DampOne<'a> {
    /// The law at this step.
    law: &'a Coefficients,
    /// Its bodies.
    pair: &'a Pair,
    /// How they move.
    motion: &'a Motion,
    /// What the formulation answers.
    elastic: &'a Elastic<f64>,
}

impl TakeDamping for DampOne<'_> {
    type Output = DampingLoad;
    fn take<D: Damping>(self, damping: D) -> DampingLoad {
        damping.damp(self.law, self.pair, self.motion, self.elastic).load(self.pair, self.motion)
    }
}
