//! Several points on soft bodies: each feels the others through it, equation (10) and its extension
//! to places on triangles. See `docs/contact.md`.
//!
//! Contact point p moves by the forces on all, u_p = sum_q C_pq F_q / E with
//! C_pq = sum_ab a_pa a_qb L_ab over the nodes of both triangles. A finger may only push: its force
//! stays in a cone about the direction of its push. The forces are those of least energy under these
//! cones. Everything here is at unit modulus, of fixed size and bounded.

use glam::{DMat3, DVec3};

use crate::algebra::series_share;
use crate::body::surface::Body;
use crate::contact::cones::{Blocks, Cone, MAX_FINGERS, Members, Vectors, mean, solve_distinct};
use crate::contact::fading::fading;
use crate::contact::ground::Ground;
use crate::contact::touch::{contact_compliance, inverse_of_definite};
use crate::control::coupling::series_compliance;
use crate::fingers::press::{Answer, Answers, Press, Presses, Reaction, numbered};

/// Where the others hold a finger, it still finds this share of the compliance it finds alone.
const DISTINCT: f64 = 0.02;
/// C_pp is enlarged by this share before looking for what is missing: far less than `DISTINCT`, far
/// more than what rounding and compression leave of a zero.
const TELLING_SHIFT: f64 = 1e-3;

/// L between the nodes of two triangles, kept until one of them changes.
#[derive(Debug, Clone, Copy)]
struct Cross {
    triangles: [u32; 2],
    body: u32,
    blocks: [[DMat3; 3]; 3],
}

/// The solver and what it remembers from tick to tick.
#[derive(Debug, Clone)]
pub struct Several {
    cross: [[Cross; MAX_FINGERS]; MAX_FINGERS],
    forces: Vectors,
}

impl Default for Several {
    fn default() -> Self {
        let unread = Cross {
            triangles: [u32::MAX; 2],
            body: u32::MAX,
            blocks: [[DMat3::ZERO; 3]; 3],
        };
        Self {
            cross: [[unread; MAX_FINGERS]; MAX_FINGERS],
            forces: [DVec3::ZERO; MAX_FINGERS],
        }
    }
}

impl Several {
    /// The last forces, at unit modulus.
    pub fn forces(&self) -> &Vectors {
        &self.forces
    }

    /// Forces of all fingers that touch, and how far they move the surface at all that are there,
    /// between tools that answer as told.
    ///
    /// `None` for a press on a body that is not there or does not keep
    /// its whole compliance, or where rounding has made nonsense of one.
    pub fn solve(
        &mut self,
        grounds: &[Ground<'_>],
        presses: &Presses,
        tools: &Reaction,
    ) -> Option<Answers> {
        let mut alone = self.coupled_compliance(grounds, presses)?;
        tell_apart(&mut alone, &Members::of(presses))?;
        carry(&mut alone, grounds, presses);
        let compliance = tools.on(&alone);
        let drift = |press: &Press| grounds[usize::from(press.body)].drift();
        let touching = presses.map(|press| press.filter(|p| p.touches));
        let members = Members::of(&touching);
        let held = members.held(&compliance)?;
        let mut answers = [Answer::default(); MAX_FINGERS];
        // What lies between a finger and the body gives way in series with the body.
        let mut series = compliance;
        let mut between = [0.0; MAX_FINGERS];
        let mut asked = [DVec3::ZERO; MAX_FINGERS];
        let mut cones = [Cone::default(); MAX_FINGERS];
        for (p, press) in numbered(&touching) {
            let spring = series_compliance(&held[p], press.most_stiffness);
            let fading = mean(&alone[p][p]) * fading(press.presence);
            between[p] = spring + fading;
            series[p][p] += DMat3::IDENTITY * between[p];
            answers[p].seen_stiffness = series_share(&held[p], spring) * held[p];
            answers[p].spring = spring;
            asked[p] = press.displacement - tools.moved[p] - drift(&press) - press.remembered;
            let own = alone[p][p] + DMat3::IDENTITY * between[p];
            cones[p] = match press.cone {
                Some(cone) => cone,
                None => Cone::about(press.push, &own)?,
            };
        }
        self.forces = solve_distinct(&series, &asked, &cones, &members, &self.forces)?;
        for (p, press) in numbered(presses) {
            let by_all = members.numbers().map(|q| compliance[p][q] * self.forces[q]);
            let by_all = by_all.sum::<DVec3>() + tools.moved[p] + drift(&press) + press.remembered;
            let force = self.forces[p];
            answers[p].by_others = by_all - alone[p][p] * force;
            if press.touches {
                let own = inverse_of_definite(&alone[p][p])?;
                answers[p].force = force;
                answers[p].carried = press.carried;
                answers[p].remembered = force.dot(press.remembered);
                let ground = &grounds[usize::from(press.body)];
                answers[p].along =
                    ground.carried(place(ground, &press), place(ground, &press)) * force;
                let held = press.displacement - press.remembered;
                answers[p].energy = 0.5 * force.dot(held);
                let own_part = press.displacement - answers[p].by_others;
                answers[p].own_energy = 0.5 * force.dot(own_part);
                answers[p].contact_force = force + own * force * between[p];
                let moved = by_all + force * between[p];
                answers[p].slip = moved - press.displacement;
            }
        }
        Some(answers)
    }

    /// Nobody touches: what was remembered of the forces is over.
    pub fn release(&mut self) {
        self.forces = [DVec3::ZERO; MAX_FINGERS];
    }

    /// C_pq of all fingers that are there, zero between bodies, each of which is taken as held.
    fn coupled_compliance(&mut self, grounds: &[Ground<'_>], presses: &Presses) -> Option<Blocks> {
        let mut compliance = [[DMat3::ZERO; MAX_FINGERS]; MAX_FINGERS];
        for (p, press) in numbered(presses) {
            let ground = grounds.get(usize::from(press.body))?;
            let Ground { body, number, .. } = *ground;
            compliance[p][p] = contact_compliance(body, press.hold.triangle, press.hold.alpha)?;
            let before = numbered(presses).take_while(|&(q, _)| q < p);
            for (q, other) in before.filter(|(_, other)| other.body == press.body) {
                let triangles = [press.hold.triangle, other.hold.triangle];
                let cross = &mut self.cross[p][q];
                if (cross.triangles, cross.body) != (triangles, number) {
                    cross.blocks = blocks_between(body, triangles)?;
                    (cross.triangles, cross.body) = (triangles, number);
                }
                let mut sum = DMat3::ZERO;
                for (row, a) in cross.blocks.iter().zip(press.hold.alpha) {
                    for (block, b) in row.iter().zip(other.hold.alpha) {
                        sum += *block * (a * b);
                    }
                }
                (compliance[p][q], compliance[q][p]) = (sum, sum.transpose());
            }
        }
        Some(compliance)
    }
}

fn place(ground: &Ground<'_>, press: &Press) -> DVec3 {
    ground.place(press.hold.triangle, press.hold.alpha)
}

/// Adds how bodies that nobody holds go along: that tells fingers apart which the surface cannot.
fn carry(compliance: &mut Blocks, grounds: &[Ground<'_>], presses: &Presses) {
    for (p, press) in numbered(presses) {
        let ground = &grounds[usize::from(press.body)];
        if ground.mobility.is_none() {
            continue;
        }
        for (q, other) in numbered(presses).filter(|(_, other)| other.body == press.body) {
            compliance[p][q] += ground.carried(place(ground, &press), place(ground, &other));
        }
    }
}

fn blocks_between(body: &Body, [p, q]: [u32; 2]) -> Option<[[DMat3; 3]; 3]> {
    let mut blocks = [[DMat3::ZERO; 3]; 3];
    for (row, a) in blocks.iter_mut().zip(body.triangles[p as usize]) {
        for (block, b) in row.iter_mut().zip(body.triangles[q as usize]) {
            *block = body.block(a, b)?;
        }
    }
    Some(blocks)
}

/// Makes contacts distinct that the surface can hardly tell apart: what they do to each other is
/// reduced, C_pq t_p t_q with t_p^2 = 1 - max(0, DISTINCT - y_p). What p yields while all others are
/// held is the inverse of the block pp of C^-1; y_p is its share of C_pp, what p yields alone. `None`
/// unless C is definite.
pub fn tell_apart(compliance: &mut Blocks, members: &Members) -> Option<()> {
    if members.count < 2 {
        return Some(());
    }
    let mut shifted = *compliance;
    for p in members.numbers() {
        shifted[p][p] *= 1.0 + TELLING_SHIFT;
    }
    let held = members.held(&shifted)?;
    let mut reduced = [1.0; MAX_FINGERS];
    for p in members.numbers() {
        let yielded = 1.0 / mean(&(compliance[p][p] * held[p])) - TELLING_SHIFT;
        reduced[p] = (1.0 - (DISTINCT - yielded).clamp(0.0, DISTINCT)).sqrt();
    }
    for p in members.numbers() {
        for q in members.numbers().filter(|&q| q != p) {
            compliance[p][q] *= reduced[p] * reduced[q];
        }
    }
    Some(())
}
