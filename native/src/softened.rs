//! Several fingers, each on a place that softens: what each does to its own place departs from the
//! linear relation, what it does to the others' stays linear.
//!
//! Own parts v of the displacements are sought with v_p + c_p F_p + sum_q C_pq F_q = u_p for the
//! others q, and F_p the force of p's own relation at v_p. That is the least of a sum of energies of
//! forces: convex where places soften, so the forces are one gradient and unique. Each round replaces
//! the relations by their tangents at the v found so far and solves as for linear ones, cones and
//! all: Newton's method, from the tick before.

use glam::{DMat3, DVec3};

use crate::cones::{Blocks, Cone, MAX_FINGERS, Members, Vectors, solve_distinct};
use crate::contact::inverse_of_definite;
use crate::felt::Relation;
use crate::several::{Answer, Press, numbered};

/// Rounds in one tick; two or three are enough from the tick before.
const MOST_ROUNDS: usize = 8;
/// Displacements are taken when they change by this share of the largest one.
const CONVERGED: f64 = 1e-13;

/// The problem of linear relations.
pub(crate) struct Pressing {
    /// C_pq, made distinct.
    pub compliance: Blocks,
    /// c_p: what lies between a finger and the body.
    pub between: [f64; MAX_FINGERS],
    /// u, m.
    pub asked: Vectors,
    pub cones: [Cone; MAX_FINGERS],
    /// Those that touch.
    pub members: Members,
}

/// What is remembered from tick to tick.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Softened {
    forces: Vectors,
    own: Vectors,
}

impl Default for Softened {
    fn default() -> Self {
        Self {
            forces: [DVec3::ZERO; MAX_FINGERS],
            own: [DVec3::ZERO; MAX_FINGERS],
        }
    }
}

impl Softened {
    /// Replaces the answers of linear relations. `None` where rounding has made nonsense.
    pub fn solve(
        &mut self,
        pressing: &Pressing,
        presses: &[Option<Press>; MAX_FINGERS],
        answers: &mut [Answer; MAX_FINGERS],
    ) -> Option<()> {
        let (compliance, members) = (&pressing.compliance, &pressing.members);
        let mut relations = [None; MAX_FINGERS];
        for p in members.numbers() {
            relations[p] = Some(Relation {
                stiffness: inverse_of_definite(&compliance[p][p])?,
                softening: presses[p]?.softening,
            });
        }
        let mut tangents = *compliance;
        for _ in 0..MOST_ROUNDS {
            let mut series = *compliance;
            let mut asked = pressing.asked;
            for (p, relation) in numbered(&relations) {
                let v = self.own[p];
                tangents[p][p] = inverse_of_definite(&relation.tangent(v))?;
                series[p][p] = tangents[p][p] + DMat3::IDENTITY * pressing.between[p];
                asked[p] += tangents[p][p] * relation.force(v) - v;
            }
            self.forces = solve_distinct(&series, &asked, &pressing.cones, members, &self.forces)?;
            let (mut change, mut largest) = (0.0_f64, 0.0_f64);
            for (p, relation) in numbered(&relations) {
                let v = self.own[p];
                let step = tangents[p][p] * (self.forces[p] - relation.force(v));
                self.own[p] = v + step;
                change = change.max(step.abs().max_element());
                largest = largest.max(self.own[p].abs().max_element());
            }
            if change <= CONVERGED * largest {
                break;
            }
        }
        let held = members.held(&tangents)?;
        for (p, press) in numbered(presses) {
            let others = members.numbers().filter(|&q| q != p);
            let by_points: DVec3 = others.map(|q| compliance[p][q] * self.forces[q]).sum();
            let answer = &mut answers[p];
            answer.by_others = by_points + press.moved_by_tools;
            if let Some(relation) = &relations[p] {
                let (force, own) = (self.forces[p], self.own[p]);
                let sprung = force * pressing.between[p];
                answer.force = force;
                answer.contact_force = relation.force(own + sprung);
                answer.slip = own + sprung + answer.by_others - press.displacement;
                let share = (DMat3::IDENTITY + held[p] * answer.spring).inverse();
                answer.seen_stiffness = share * held[p];
            }
        }
        Some(())
    }
}
