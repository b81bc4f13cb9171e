//! Stored trajectories of the engine against the laws, with the smallest possible time stepping: all pairs, no contact.

use super::stored::{Case, vector};
use crate::bond::creation::{Moment, near_pair, near_plane};
use crate::bond::keys::{FormulationChoice, Keys, TakeLaw};
use crate::bond::{Body, BondLaw, Carried, Coefficients, Law, Pair, Quaternion, Reaction, Rows};
use crate::number::Vector;

/// A law whose type is known no more.
struct Untyped {
    /// [`BondLaw::create`]
    create: fn(&Coefficients, &Pair) -> Rows,
    /// [`BondLaw::carried`]
    carried: fn(&Law, &Pair, &Rows) -> Carried,
    /// [`BondLaw::react`]
    react: fn(&Coefficients, &Pair, &Rows) -> Reaction<f64>,
}

/// Takes the functions of a law.
struct Untype;

impl TakeLaw for Untype {
    type Output = Untyped;
    fn take<L: BondLaw>(self) -> Untyped {
        Untyped { create: L::create::<f64>, react: L::react::<f64>, carried: L::carried }
    }
}

/// A bond that is or may come to be.
pub(super) struct Link {
    /// Index of body i.
    pub(super) i: usize,
    /// Index of body j; `None`: a plane.
    pub(super) j: Option<usize>,
    /// What the scene would write.
    keys: Keys,
    /// The law in numbers.
    law: Law,
    /// Its functions.
    functions: Untyped,
    /// State, while there is a bond.
    pub(super) rows: Option<Rows>,
    /// Foot point on a plane \[m\].
    foot: Vector,
    /// Force on i in the last evaluation \[N\].
    pub(super) force: Vector,
}

/// Bodies and bonds in motion.
pub(super) struct Run {
    /// Bodies.
    pub(super) bodies: Vec<Body>,
    /// Force and torque on each \[N, N m\].
    pub(super) loads: Vec<[Vector; 2]>,
    /// Constant force on each \[N\].
    applied: Vec<Vector>,
    /// Position at the start and prescribed velocity of bodies that do not move by force \[m, m/s\].
    prescribed: Vec<Option<(Vector, Vector)>>,
    /// Ids of the bodies.
    pub(super) ids: Vec<i64>,
    /// All possible bonds.
    pub(super) links: Vec<Link>,
    /// Axis and position of a plane \[m\].
    plane: Option<(usize, f64)>,
    /// Time step \[s\].
    pub(super) step: f64,
}

impl Run {
    /// A case at its start.
    pub(super) fn new(case: &Case, formulation: FormulationChoice) -> Self {
        Self::with(case, &|types| case.keys(formulation, types))
    }

    /// A case at its start, with a table for each two types.
    pub(super) fn with(case: &Case, keys: &dyn Fn([usize; 2]) -> Option<Keys>) -> Self {
        let json = &case.json;
        let mut particles: Vec<_> = json["particles"].as_array().unwrap().iter().collect();
        particles.sort_by_key(|particle| particle["id"].as_i64());
        let ids: Vec<_> = particles.iter().map(|particle| particle["id"].as_i64().unwrap()).collect();
        let kind: Vec<_> = particles.iter().map(|particle| particle["type"].as_u64().unwrap() as usize - 1).collect();
        let bodies: Vec<Body> = particles
            .iter()
            .map(|particle| {
                let radius = particle["radius"].as_f64().unwrap();
                let density = particle["density"].as_f64().unwrap();
                let mass = 4.0 * std::f64::consts::PI / 3.0 * (radius * radius * radius) * density;
                Body {
                    position: vector(&particle["position"]),
                    velocity: vector(&particle["velocity"]),
                    spin: vector(&particle["omega"]),
                    attitude: Quaternion::identity(),
                    radius,
                    mass,
                    inertia: 0.4 * mass * radius * radius,
                }
            })
            .collect();
        let mut applied: Vec<_> = bodies.iter().map(|body| vector(&json["gravity"]) * body.mass).collect();
        for force in json["external_forces"].as_array().unwrap() {
            for (body, id) in ids.iter().enumerate() {
                if force["ids"].as_array().unwrap().iter().any(|other| other.as_i64() == Some(*id)) {
                    applied[body] += vector(&force["force"]);
                }
            }
        }
        let mut run = Self {
            loads: vec![[Vector::zero(); 2]; bodies.len()],
            prescribed: vec![None; bodies.len()],
            applied,
            links: Vec::new(),
            plane: None,
            step: json["dt"].as_f64().unwrap(),
            ids,
            bodies,
        };
        for motion in json["prescribed_motion"].as_array().unwrap() {
            for body in 0..run.bodies.len() {
                if motion["ids"].as_array().unwrap().iter().any(|id| id.as_i64() == Some(run.ids[body])) {
                    let velocity = vector(&motion["velocity"]);
                    run.prescribed[body] = Some((run.bodies[body].position, velocity));
                    if velocity.length() > 0.0 {
                        run.bodies[body].velocity = velocity;
                    }
                }
            }
        }
        for i in 0..run.bodies.len() {
            for j in i + 1..run.bodies.len() {
                run.link(keys([kind[i], kind[j]]), i, Some(j));
            }
            for wall in json["walls"].as_array().unwrap() {
                let axis = "xyz".find(wall["axis"].as_str().unwrap()).unwrap();
                run.plane = Some((axis, wall["position"].as_f64().unwrap()));
                run.link(keys([kind[i], wall["type"].as_u64().unwrap() as usize - 1]), i, None);
            }
        }
        run.evaluate(0);
        run
    }

    /// Adds a possible bond.
    fn link(&mut self, keys: Option<Keys>, i: usize, j: Option<usize>) {
        let Some(keys) = keys else { return };
        let law = keys.law().unwrap();
        let functions = keys.visit(Untype);
        let none = Vector::zero();
        self.links.push(Link { i, j, keys, law, functions, rows: None, foot: none, force: none });
    }

    /// The other body of a bond: a sphere, or a point of the plane at rest.
    fn other(&self, link: &Link) -> Body {
        link.j.map_or_else(
            || Body {
                position: link.foot,
                velocity: Vector::zero(),
                spin: Vector::zero(),
                attitude: Quaternion::identity(),
                radius: 0.0,
                mass: f64::INFINITY,
                inertia: f64::INFINITY,
            },
            |j| self.bodies[j],
        )
    }

    /// Forces at the present positions; step 0 stores nothing.
    fn evaluate(&mut self, number: u64) {
        for (load, applied) in self.loads.iter_mut().zip(&self.applied) {
            *load = [*applied, Vector::zero()];
        }
        let time = number as f64 * self.step;
        let moment = Moment { number, from: time - self.step, to: time };
        for index in 0..self.links.len() {
            let mut link = self.links[index].rows.take();
            let at = &self.links[index];
            let one = self.bodies[at.i];
            let reach = at.keys.create_distance.unwrap().get();
            let coefficients = at.law.coefficients(if number > 0 { self.step } else { 0.0 });
            let creating = link.is_none() && at.keys.create.bonds_near_pairs(&moment);
            let (create, react) = (at.functions.create, at.functions.react);
            let mut other = self.other(at);
            if at.j.is_none() && link.is_none() {
                let (axis, position) = self.plane.unwrap();
                let mut foot = one.position.to_array();
                foot[axis] = position;
                other.position = foot.into();
            }
            let distance = (one.position - other.position).length();
            assert!(distance > one.radius + other.radius, "bodies touch; this stepping has no contact");
            let pair = if at.j.is_some() { Pair::of_spheres(&one, &other) } else { Pair::at_wall(&one, &other) };
            let near = if at.j.is_some() { near_pair(distance, reach) } else { near_plane(distance, reach) };
            if creating && near {
                link = Some(create(&coefficients, &pair));
                self.links[index].foot = other.position;
            }
            self.links[index].force = Vector::zero();
            if let (Some(rows), true) = (link, number > 0) {
                let reaction = react(&coefficients, &pair, &rows);
                self.apply(index, &reaction);
                link = (reaction.cause == 0.0).then_some(reaction.rows);
            }
            self.links[index].rows = link;
        }
    }

    /// Adds what a bond does to its bodies.
    fn apply(&mut self, index: usize, reaction: &Reaction<f64>) {
        let link = &mut self.links[index];
        link.force = reaction.force;
        self.loads[link.i][0] += reaction.force;
        self.loads[link.i][1] += reaction.torque_i;
        if let Some(j) = link.j {
            self.loads[j][0] += -reaction.force;
            self.loads[j][1] += reaction.torque_j;
        }
    }

    /// Kinetic energy at the present time \[J\].
    pub(super) fn kinetic(&self) -> f64 {
        let of = |body: &Body| {
            0.5 * (body.mass * body.velocity.dot(body.velocity) + body.inertia * body.spin.dot(body.spin))
        };
        self.bodies.iter().map(of).sum()
    }

    /// Elastic energy of all bonds at the present time \[J\].
    pub(super) fn elastic(&self) -> f64 {
        let of = |link: &Link| {
            let (one, other) = (self.bodies[link.i], self.other(link));
            let pair = if link.j.is_some() { Pair::of_spheres(&one, &other) } else { Pair::at_wall(&one, &other) };
            link.rows.map_or(0.0, |rows| (link.functions.carried)(&link.law, &pair, &rows).energy)
        };
        self.links.iter().map(of).sum()
    }

    /// Force on a body, the constant one included \[N\].
    pub(super) fn net_force(&self, body: usize) -> Vector {
        self.loads[body][0]
    }

    /// Runs through the time steps of these numbers.
    pub(super) fn advance_over(&mut self, numbers: std::ops::RangeInclusive<u64>) {
        numbers.for_each(|number| self.advance(number));
    }

    /// One time step, the `number`th.
    pub(super) fn advance(&mut self, number: u64) {
        self.kick();
        for (body, prescribed) in self.bodies.iter_mut().zip(&self.prescribed) {
            match prescribed {
                Some((start, velocity)) => body.position = *start + *velocity * (number as f64 * self.step),
                None => body.position += body.velocity * self.step,
            }
            body.attitude = body.attitude.turned(body.spin, self.step);
        }
        self.evaluate(number);
        self.kick();
    }

    /// Half a kick.
    fn kick(&mut self) {
        for ((body, load), prescribed) in self.bodies.iter_mut().zip(&self.loads).zip(&self.prescribed) {
            if prescribed.is_none() {
                body.velocity += load[0] * (0.5 * self.step / body.mass);
                body.spin += load[1] * (0.5 * self.step / body.inertia);
            }
        }
    }
}

/// The largest component.
pub(super) fn largest(vector: Vector) -> f64 {
    vector.to_array().into_iter().fold(0.0, |largest, component| largest.max(component.abs()))
}
