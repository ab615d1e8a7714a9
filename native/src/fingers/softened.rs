//! Several fingers, each on a place that softens: what each does to its own place departs from the
//! linear relation, what it does to the others' stays linear.
//!
//! What they feel of it depends on how they are coupled: `felt_coupling.rs`.
//!
//! Own parts v of the displacements are sought with v_p + c_p F_p + sum_q C_pq F_q = u_p for the
//! others q, and F_p the force of p's own relation at v_p. That is the least of a sum of energies of
//! forces, convex with the couplings' relations, so the forces are one gradient and unique. Each round
//! replaces the relations by their tangents at the v found so far and solves as for linear ones, cones
//! and all: Newton's method, from the tick before.

use glam::{DMat3, DVec3};

use crate::algebra::series_share;
use crate::body::softening::{BLEND_SECONDS, Relation};
use crate::contact::cones::{Blocks, Cone, MAX_FINGERS, Members, Vectors, solve_distinct};
use crate::contact::touch::inverse_of_definite;
use crate::fingers::felt_coupling::{Held, couplings};
use crate::fingers::press::{Answers, Presses, Reaction, numbered};

/// Rounds in one tick; two or three are enough from the tick before.
const MOST_ROUNDS: usize = 8;
/// Displacements are taken when they change by this share of the largest one.
const CONVERGED: f64 = 1e-13;
/// They are no answer where the last round still changed them by this share.
const FOUND: f64 = 1e-6;

type Relations = [Option<Relation>; MAX_FINGERS];

/// The problem of linear relations.
pub(crate) struct Pressing {
    /// C_pq, made distinct, between tools that answer.
    pub compliance: Blocks,
    /// C_pp without tools.
    pub own: [DMat3; MAX_FINGERS],
    /// c_p: what lies between a finger and the body.
    pub between: [f64; MAX_FINGERS],
    /// u, m.
    pub asked: Vectors,
    pub cones: [Cone; MAX_FINGERS],
    /// Those that touch.
    pub members: Members,
}

/// What is remembered from tick to tick.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Softened {
    forces: Vectors,
    own: Vectors,
    /// By how much each force was beside the linear relation at its own part.
    departures: Vectors,
    /// By how much these were beside those of the answer when it last changed by more than the way
    /// does, and how much of that is left, from 1 to 0.
    carried: Vectors,
    left: f64,
    /// How much of each place's softening is in the force; `None` for one that did not touch.
    shares: [Option<f64>; MAX_FINGERS],
    /// Whether the rounds came to an answer; `None` before the first tick.
    found: Option<bool>,
}

impl Softened {
    /// Replaces the answers of linear relations, after a tick of `dt` seconds. `None` where rounding
    /// has made nonsense.
    ///
    /// Another finger that comes to touch or goes changes how much of the correction the first one
    /// gets; and where the rounds come to no answer, there is none. What the forces had beside the
    /// linear ones goes from one to the other within [`BLEND_SECONDS`].
    pub fn solve(
        &mut self,
        pressing: &Pressing,
        presses: &Presses,
        tools: &Reaction,
        answers: &mut Answers,
        dt: f64,
    ) -> Option<()> {
        let step = dt / BLEND_SECONDS;
        let members = &pressing.members;
        let mut relations = [None; MAX_FINGERS];
        for p in members.numbers() {
            relations[p] = Some(Relation {
                stiffness: inverse_of_definite(&pressing.own[p])?,
                softening: presses[p]?.softening,
            });
        }
        let couplings = couplings(&pressing.compliance, members, &relations);
        let held = couplings.map(Held::at);
        for p in members.numbers() {
            relations[p] = Some(held[p].relation(&relations[p]?, &pressing.own[p]));
        }
        let same_fingers =
            (0..MAX_FINGERS).all(|p| self.shares[p].is_some() == relations[p].is_some());
        for (p, relation) in relations.iter().enumerate() {
            if self.shares[p].is_none() || relation.is_none() {
                (self.own[p], self.departures[p]) = (DVec3::ZERO, DVec3::ZERO);
                self.carried[p] = DVec3::ZERO;
            }
        }
        let tangents = self.find(pressing, &relations);
        let found = tangents.is_some();
        let mut departures = [DVec3::ZERO; MAX_FINGERS];
        let mut beyond = [DVec3::ZERO; MAX_FINGERS];
        for (p, relation) in numbered(&relations) {
            let sprung = self.forces[p] * pressing.between[p];
            if found {
                let (v, force) = (self.own[p], relation.force(self.own[p]));
                departures[p] = force - relation.stiffness * v;
                beyond[p] = relation.force(v + sprung) - force;
            }
        }
        if self
            .found
            .is_some_and(|before| before != found || !same_fingers)
        {
            self.left = 1.0;
            for p in members.numbers() {
                self.carried[p] = self.departures[p] - departures[p];
            }
        }
        self.found = Some(found);
        self.left = (self.left - step).max(0.0);
        for p in members.numbers() {
            self.departures[p] = departures[p] + self.carried[p] * self.left;
        }
        let mut own = self.own;
        if !found || self.left > 0.0 {
            own = self.depart(pressing)?;
        }
        let seen = members.held(&tangents.unwrap_or(pressing.compliance))?;
        for (p, press) in numbered(presses) {
            let by_all: DVec3 = (members.numbers())
                .map(|q| pressing.compliance[p][q] * self.forces[q])
                .sum();
            let answer = &mut answers[p];
            answer.by_others = by_all + tools.moved[p] - pressing.own[p] * self.forces[p];
            let Some(relation) = &relations[p] else {
                self.shares[p] = None;
                continue;
            };
            let aim = if found { held[p].share } else { 0.0 };
            let told = self.shares[p].unwrap_or(aim);
            let told = told + (aim - told).clamp(-step, step);
            self.shares[p] = Some(told);
            answer.felt_share = told;
            let force = self.forces[p];
            let sprung = force * pressing.between[p];
            answer.force = force;
            answer.energy = relation.energy(own[p]) + 0.5 * force.dot(press.displacement - own[p]);
            answer.is_settled = found && self.left == 0.0;
            answer.contact_force = if found {
                force + beyond[p]
            } else {
                force + relation.stiffness * sprung
            };
            answer.slip = own[p] + sprung + answer.by_others - press.displacement;
            answer.seen_stiffness = series_share(&seen[p], answer.spring) * seen[p];
        }
        Some(())
    }

    /// Newton's rounds: the compliance with each one's own by its tangent, and `None` where they
    /// come to no answer in this tick.
    fn find(&mut self, pressing: &Pressing, relations: &Relations) -> Option<Blocks> {
        let mut tangents = pressing.compliance;
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        let mut forces = self.forces;
        for _ in 0..MOST_ROUNDS {
            let mut series = pressing.compliance;
            let mut asked = pressing.asked;
            let mut owns = [DMat3::ZERO; MAX_FINGERS];
            for (p, relation) in numbered(relations) {
                let v = self.own[p];
                let own = inverse_of_definite(&relation.tangent(v))?;
                // What is not its own stays as it is.
                tangents[p][p] = own + (pressing.compliance[p][p] - pressing.own[p]);
                series[p][p] = tangents[p][p] + DMat3::IDENTITY * pressing.between[p];
                asked[p] += own * relation.force(v) - v;
                owns[p] = own;
            }
            let Pressing { cones, members, .. } = pressing;
            forces = solve_distinct(&series, &asked, cones, members, &forces)?;
            (change, largest) = (0.0, 0.0);
            for (p, relation) in numbered(relations) {
                let v = self.own[p];
                let step = owns[p] * (forces[p] - relation.force(v));
                self.own[p] = v + step;
                change = change.max(step.abs().max_element());
                largest = largest.max(self.own[p].abs().max_element());
            }
            if change <= CONVERGED * largest {
                break;
            }
        }
        let is_finite = (self.own.iter().chain(&forces)).all(|vector| vector.is_finite());
        if !is_finite {
            self.own = [DVec3::ZERO; MAX_FINGERS];
        }
        if !is_finite || change > FOUND * largest {
            return None;
        }
        self.forces = forces;
        Some(tangents)
    }

    /// Forces of linear relations with the departures beside them, which are always found; the own
    /// parts of the displacements.
    fn depart(&mut self, pressing: &Pressing) -> Option<Vectors> {
        let Pressing { compliance, .. } = pressing;
        let mut series = *compliance;
        let mut asked = pressing.asked;
        for p in pressing.members.numbers() {
            series[p][p] += DMat3::IDENTITY * pressing.between[p];
            asked[p] += pressing.own[p] * self.departures[p];
        }
        let Pressing { cones, members, .. } = pressing;
        self.forces = solve_distinct(&series, &asked, cones, members, &self.forces)?;
        let mut own = [DVec3::ZERO; MAX_FINGERS];
        for p in members.numbers() {
            own[p] = pressing.own[p] * (self.forces[p] - self.departures[p]);
        }
        Some(own)
    }
}
