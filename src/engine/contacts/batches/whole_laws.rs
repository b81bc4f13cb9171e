//! Laws that are met most, compiled whole beside their sub-models: the same functions in the same order. They keep in
//! registers what the others write and read, and their bits are the same.

use crate::base::lanes::{self, Kernel, Lane};
use crate::base::number::Vector;
use crate::laws::contact::batch::{FrictionResult, Gathered, Run, Stage, book};
use crate::laws::contact::cohesion::{self, attraction::Attraction};
use crate::laws::contact::normal::{hertzian::Hertzian, hooke_stiffness::HookeStiffness};
use crate::laws::contact::rolling::{self, cdt::Cdt};
use crate::laws::contact::tangential::history::History;
use crate::laws::contact::{
    Booked, Coefficients, CohesionForm, LawChoice, NormalForm, Rolling, Seen, Switches, Tangential,
};
use std::any::TypeId;
use std::marker::PhantomData;

/// The law that a scene composed, if it is compiled whole; with what it loses, if that is booked.
pub(super) fn find(choice: &LawChoice, is_booked: bool) -> Option<Run> {
    if choice.scheme.carries() {
        return None;
    }
    let forms = [
        choice.normal.row().form(),
        choice.tangential.row().form(),
        choice.rolling.row().form(),
        choice.cohesion.row().form(),
    ];
    let mut all = FUSED.iter().map(|fused| fused());
    all.find(|fused| fused.forms == forms).map(|fused| if is_booked { fused.booked } else { fused.run })
}

/// A law that is compiled whole.
struct Fused {
    /// What its normal, tangential, rolling and cohesion models compute.
    forms: [TypeId; 4],
    /// The law on a batch.
    run: Run,
    /// The same, and what is lost.
    booked: Run,
}

/// The law of these four; the cohesion model acts in touch alone and remembers nothing.
fn fused<A: NormalForm, B: Tangential, C: Rolling, D: CohesionForm>() -> Fused {
    Fused {
        forms: [TypeId::of::<A>(), TypeId::of::<B>(), TypeId::of::<C>(), TypeId::of::<D>()],
        run: |width, stage| lanes::run(width, WholeRun::<A, B, C, D, false>(stage, PhantomData)),
        booked: |width, stage| lanes::run(width, WholeRun::<A, B, C, D, true>(stage, PhantomData)),
    }
}

/// Laws that are compiled whole: those of which that saves 5 % of a time step or more (`docs/decisions/010`).
const FUSED: &[fn() -> Fused] = &[
    fused::<Hertzian, History, rolling::none::None, cohesion::none::None>,
    fused::<Hertzian, History, Cdt, cohesion::none::None>,
    fused::<Hertzian, History, Cdt, Attraction>,
    fused::<HookeStiffness, History, rolling::none::None, cohesion::none::None>,
];

/// A whole law over a batch. Roots, for which what follows would wait, are found a register ahead. BOOKED: what contacts lose is
/// booked with what is in the registers.
struct WholeRun<'a, 'b, A, B, C, D, const BOOKED: bool>(&'a mut Stage<'b>, PhantomData<(A, B, C, D)>);

impl<A: NormalForm, B: Tangential, C: Rolling, D: CohesionForm, const BOOKED: bool> Kernel
    for WholeRun<'_, '_, A, B, C, D, BOOKED>
{
    #[inline(always)]
    fn run<N: Lane>(self) {
        let stage = self.0;
        let after_normal = A::COUNT + Switches::COUNT;
        let count = after_normal + B::COUNT + C::COUNT + D::COUNT;
        let mut coefficients = Gathered::<N>::of(stage, 0, count);
        let shares_row = stage.history.normal_velocity == stage.history.tangential;
        let booked = Booked {
            friction: B::ACTIVE,
            spring: B::HAS_SPRING,
            keeps_stiffness: B::KEEPS_STIFFNESS,
            limits_dashpot: B::LIMITS_DASHPOT,
            projects: B::PROJECTS,
            rolling: C::ACTIVE,
            presses: true,
            other: D::ACTIVE,
            carries: false,
            ..*stage.booked
        };
        debug_assert_eq!(booked, *stage.booked);
        let mut done = 0;
        if A::HAS_ROOTS {
            // SAFETY: there is room for a register behind the batch; so below.
            unsafe { stage.buffer.find_roots::<N, A>(0) };
        }
        while done < stage.buffer.ready {
            // SAFETY: as above.
            unsafe {
                let row = coefficients.at(stage, done);
                let mut contact = stage.contact(done, A::HAS_PAIR_CONSTANT);
                let mut history = stage.tangential_history::<N, B>(done);
                let (velocity, spring_before) = (contact.normal_velocity, Vector::of_row(history));
                let weight = stage.foresee_normal(done, shares_row, &mut contact, &mut history);
                let mut roots = [N::zero(); 2];
                if A::HAS_ROOTS {
                    stage.buffer.find_roots::<N, A>(done + N::WIDTH);
                    roots = stage.buffer.roots(done);
                }
                let mut normal = stage.press::<N, A>(done, row, &contact, roots);
                normal.response.tangential_damping = normal.response.tangential_damping * weight;
                if D::ACTIVE {
                    let law = D::lanes(&row[after_normal + B::COUNT + C::COUNT..]);
                    D::add(law, D::force(law, &contact), &mut normal);
                }
                let rubbed = stage.rub::<N, B, false>(done, &row[after_normal..], &contact, &normal, history);
                if C::ACTIVE && !B::ACTIVE {
                    stage.leave_couple::<N>(done);
                }
                let mut rolling = Vector::zero();
                if C::ACTIVE {
                    rolling = stage.roll::<N, C, false>(done, &row[after_normal + B::COUNT..], &contact, &normal);
                }
                if BOOKED {
                    let FrictionResult { force, spring, sliding } = rubbed;
                    let step = N::splat(stage.step);
                    let before = [stage.history.loads, stage.history.other_loads];
                    let seen = Seen {
                        normal,
                        pressing: contact.overlap,
                        least_force: row[A::COUNT],
                        acts: true,
                        normal_displacement: velocity * step,
                        tangential_displacement: contact.slip * step,
                        turn: contact.relative_spin * step,
                        force,
                        rolling,
                        spring_before,
                        spring,
                        sliding,
                        before: before.map(|row| stage.remembered(true, row, done)),
                        contact,
                    };
                    book(stage, done, &seen, &booked);
                }
            }
            done += N::WIDTH;
        }
    }
}
