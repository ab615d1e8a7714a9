//! Several fingers on one body: each feels the others through it, equation (10) and its extension
//! to places on triangles. Readable reference: `core/several_contacts.py`; `docs/contact.md`.
//!
//! Contact point p moves by the forces on all, u_p = sum_q C_pq F_q / E with
//! C_pq = sum_ab a_pa a_qb L_ab over the nodes of both triangles. A finger may only push: its force
//! stays in a cone about the direction of its push. The forces are those of least energy under these
//! cones. Everything here is at unit modulus, of fixed size and bounded.

use glam::{DMat3, DVec3};

use crate::contact::{ContactMode, contact_compliance, contact_stiffness, inverse_of_definite};
use crate::coupling::series_compliance;
use crate::proxy::Hold;
use crate::small_matrix::{MOST_ROWS, SmallMatrix};
use crate::surface::Body;

/// Fingers on one body at most.
pub const MAX_FINGERS: usize = MOST_ROWS / 3;
/// A finger that the others hold in place still finds this share of the compliance it finds alone.
const DISTINCT: f64 = 0.02;
/// Added to C before looking for what is missing: far less than `DISTINCT`, far more than what
/// rounding and compression leave of a zero.
const TELLING_SHIFT: f64 = 1e-3;
/// A cone is never narrower than this tangent of its half angle.
const NARROWEST_CONE: f64 = 1.0;
/// Sweeps in one tick; they go on from there in the next.
const MOST_SWEEPS: usize = 40;
/// Sweeps end when no force changes by more than this share of the largest.
const CONVERGED: f64 = 1e-9;
/// What a finger knows of the others is renewed by at most this share in a tick.
const NEWS: f64 = 0.5;
/// Present by less, a finger does not act on the others.
const LEAST_PRESENCE: f64 = 1e-3;

/// A finger on the body, or so near that the others may carry the surface to it.
#[derive(Debug, Clone, Copy)]
pub struct Press {
    /// Where on the surface.
    pub hold: Hold,
    /// It touches; otherwise only what the others do there is asked for.
    pub touches: bool,
    /// 1 while it touches, 0 where it is too far to be mixed up with another.
    pub nearness: f64,
    /// How far it asks the contact point to move from rest, m.
    pub displacement: DVec3,
    /// The part of that which it adds to what the others do, m.
    pub push: DVec3,
    /// Of all that its device may see, over Young's modulus; infinite for no such limit.
    pub most_stiffness: f64,
    /// From 0 to 1 after it was lifted by a fault: how much it acts on the others.
    pub presence: f64,
}

/// What becomes of a press; times Young's modulus for N and N/m.
#[derive(Debug, Clone, Copy, Default)]
pub struct Answer {
    /// On the body, as the device and the other fingers feel it.
    pub force: DVec3,
    /// On the body, were there nothing but the body between it and this finger.
    pub contact_force: DVec3,
    /// How far the others move the contact point, m.
    pub carried: DVec3,
    /// Of the contact point while the others hold theirs: the most that any device sees.
    pub stiffness: DMat3,
    /// That stiffness in series with what keeps the device from seeing it whole.
    pub seen_stiffness: DMat3,
    /// How much of what is new about the others a finger may believe in this tick.
    pub news: f64,
}

/// L between the nodes of two triangles, kept until one of them changes.
#[derive(Debug, Clone, Copy)]
struct Cross {
    triangles: [u32; 2],
    body: u32,
    blocks: [[DMat3; 3]; 3],
}

type Blocks = [[DMat3; MAX_FINGERS]; MAX_FINGERS];

/// The solver and what it remembers from tick to tick.
#[derive(Debug, Clone)]
pub struct Several {
    cross: [[Cross; MAX_FINGERS]; MAX_FINGERS],
    forces: [DVec3; MAX_FINGERS],
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
    /// Forces of all fingers that touch, and how far they move the surface at all that are there.
    ///
    /// `number` counts the bodies that were exchanged. `None` for a body that does not keep its
    /// whole compliance, or one of which rounding has made nonsense.
    pub fn solve(
        &mut self,
        body: &Body,
        number: u32,
        mode: ContactMode,
        presses: &[Option<Press>; MAX_FINGERS],
    ) -> Option<[Answer; MAX_FINGERS]> {
        let mut compliance = self.coupled_compliance(body, number, mode, presses)?;
        let news = tell_apart(&mut compliance, presses)?;
        let touching = presses.map(|press| press.filter(|p| p.touches));
        let held = Layout::of(&touching).inverse(&compliance)?;
        let mut answers = [Answer::default(); MAX_FINGERS];
        let mut series = compliance;
        let mut given = [0.0; MAX_FINGERS];
        for (p, press) in numbered(&touching) {
            let stiffness = held[p];
            let spring = series_compliance(&stiffness, press.most_stiffness);
            let fading = mean(&compliance[p][p]) * (1.0 / press.presence.max(LEAST_PRESENCE) - 1.0);
            given[p] = spring + fading;
            series[p][p] += DMat3::IDENTITY * given[p];
            let share = (DMat3::IDENTITY + stiffness * spring).inverse();
            (answers[p].stiffness, answers[p].seen_stiffness) = (stiffness, share * stiffness);
        }
        self.forces = solve_contacts(&series, &touching, &self.forces)?;
        for (p, _) in numbered(presses) {
            let others = numbered(&touching).filter(|&(q, _)| q != p);
            answers[p].carried = others.map(|(q, _)| compliance[p][q] * self.forces[q]).sum();
            answers[p].news = NEWS * news[p];
        }
        for (p, _) in numbered(&touching) {
            let own = inverse_of_definite(&compliance[p][p])?;
            answers[p].force = self.forces[p];
            answers[p].contact_force = self.forces[p] + own * self.forces[p] * given[p];
        }
        Some(answers)
    }

    /// Nobody touches: what was remembered of the forces is over.
    pub fn release(&mut self) {
        self.forces = [DVec3::ZERO; MAX_FINGERS];
    }

    /// C_pq of all fingers that are there.
    fn coupled_compliance(
        &mut self,
        body: &Body,
        number: u32,
        mode: ContactMode,
        presses: &[Option<Press>; MAX_FINGERS],
    ) -> Option<Blocks> {
        let mut compliance = [[DMat3::ZERO; MAX_FINGERS]; MAX_FINGERS];
        for (p, press) in numbered(presses) {
            compliance[p][p] = own_compliance(body, mode, &press.hold)?;
            for (q, other) in numbered(presses).take_while(|&(q, _)| q < p) {
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

/// Those that are there, by number.
fn numbered<T: Copy>(some: &[Option<T>; MAX_FINGERS]) -> impl Iterator<Item = (usize, T)> + '_ {
    some.iter()
        .enumerate()
        .filter_map(|(number, one)| one.map(|one| (number, one)))
}

fn mean(matrix: &DMat3) -> f64 {
    (matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z) / 3.0
}

/// Of one contact point alone, as its mode has it.
fn own_compliance(body: &Body, mode: ContactMode, hold: &Hold) -> Option<DMat3> {
    let whole = contact_compliance(body, hold.triangle, hold.alpha)?;
    match mode {
        ContactMode::Consistent => Some(whole),
        ContactMode::Paper => {
            let stiffness = contact_stiffness(body, mode, hold.triangle, hold.alpha);
            inverse_of_definite(&stiffness)
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

/// Gives contacts that the surface can hardly tell apart what is missing of `DISTINCT`, as a
/// compliance of their own; tells of each how far it is from being held by the others, up to 1.
///
/// What contact p yields while all others are held is the inverse of the block pp of C^-1.
fn tell_apart(
    compliance: &mut Blocks,
    presses: &[Option<Press>; MAX_FINGERS],
) -> Option<[f64; MAX_FINGERS]> {
    let mut shifted = *compliance;
    let mut own = [0.0; MAX_FINGERS];
    for (p, press) in numbered(presses) {
        own[p] = mean(&compliance[p][p]);
        // What has not come near yet counts as soft: it holds nobody.
        let distance = 1.0 / press.nearness.max(f64::MIN_POSITIVE) - 1.0;
        shifted[p][p] += DMat3::IDENTITY * (own[p] * (TELLING_SHIFT + distance.min(1e6)));
    }
    let held = Layout::of(presses).inverse(&shifted)?;
    let count = numbered(presses).count();
    let mut free = [0.0; MAX_FINGERS];
    for (p, press) in numbered(presses) {
        let yielded = 1.0 / mean(&held[p]) - TELLING_SHIFT * own[p];
        let missing = if count > 1 {
            (DISTINCT * own[p] - yielded).max(0.0)
        } else {
            0.0
        };
        if press.touches {
            compliance[p][p] += DMat3::IDENTITY * missing;
        }
        free[p] = ((yielded + missing) / own[p]).clamp(DISTINCT, 1.0);
    }
    Some(free)
}

/// Where the blocks of the fingers that are there stand in one matrix.
struct Layout {
    fingers: [usize; MAX_FINGERS],
    count: usize,
}

impl Layout {
    fn of(presses: &[Option<Press>; MAX_FINGERS]) -> Self {
        let mut layout = Self {
            fingers: [0; MAX_FINGERS],
            count: 0,
        };
        for (p, _) in numbered(presses) {
            layout.fingers[layout.count] = p;
            layout.count += 1;
        }
        layout
    }

    fn fingers(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.fingers[..self.count].iter().copied().enumerate()
    }

    fn matrix(&self, blocks: &Blocks) -> SmallMatrix {
        let mut matrix = SmallMatrix::zero(3 * self.count);
        for (row, p) in self.fingers() {
            for (column, q) in self.fingers() {
                matrix.put(3 * row, 3 * column, &blocks[p][q]);
            }
        }
        matrix
    }

    /// The diagonal blocks of the inverse.
    fn inverse(&self, blocks: &Blocks) -> Option<[DMat3; MAX_FINGERS]> {
        let inverse = self.matrix(blocks).factored()?.inverse();
        let mut found = [DMat3::ZERO; MAX_FINGERS];
        for (place, p) in self.fingers() {
            found[p] = inverse.block(3 * place, 3 * place);
        }
        Some(found)
    }

    /// Forces that give each its displacement.
    fn solution(
        &self,
        blocks: &Blocks,
        presses: &[Option<Press>; MAX_FINGERS],
    ) -> Option<[DVec3; MAX_FINGERS]> {
        let mut column = [0.0; MOST_ROWS];
        for ((place, _), (_, press)) in self.fingers().zip(numbered(presses)) {
            column[3 * place..3 * place + 3].copy_from_slice(&press.displacement.to_array());
        }
        self.matrix(blocks).factored()?.solve(&mut column);
        let mut forces = [DVec3::ZERO; MAX_FINGERS];
        for (place, p) in self.fingers() {
            forces[p] = DVec3::from_slice(&column[3 * place..]);
        }
        Some(forces)
    }
}

/// The cone that a finger's force stays in.
#[derive(Debug, Clone, Copy, Default)]
struct Cone {
    /// Unit vector of its push, zero without one.
    axis: DVec3,
    /// Tangent of the half angle.
    width: f64,
}

impl Cone {
    /// Twice as wide as the force of a finger alone needs: alone none is ever limited.
    fn about(push: DVec3, own: &DMat3) -> Option<Self> {
        let axis = push.normalize_or_zero();
        let alone = inverse_of_definite(own)? * axis;
        let along = alone.dot(axis);
        let across = (alone - axis * along).length();
        let ratio = if along > 0.0 { across / along } else { 0.0 };
        Some(Self {
            axis,
            width: NARROWEST_CONE.max(2.0 * ratio),
        })
    }

    /// How far along and how far across its axis a force is.
    fn split(&self, force: DVec3) -> (f64, DVec3) {
        let along = force.dot(self.axis);
        (along, force - self.axis * along)
    }

    fn holds(&self, force: DVec3) -> bool {
        let (along, across) = self.split(force);
        self.axis != DVec3::ZERO && across.length() <= self.width * along
    }

    /// The force nearest to `force` in the cone.
    fn nearest(&self, force: DVec3) -> DVec3 {
        let (along, sideways) = self.split(force);
        let across = sideways.length();
        if self.axis == DVec3::ZERO || along <= -self.width * across {
            return DVec3::ZERO;
        }
        if across <= self.width * along {
            return force;
        }
        let length = (along + self.width * across) / (1.0 + self.width * self.width);
        self.axis * length + sideways * (self.width * length / across)
    }
}

/// Forces of fingers that may only push. Sweeps begin with the forces of the tick before.
fn solve_contacts(
    compliance: &Blocks,
    presses: &[Option<Press>; MAX_FINGERS],
    before: &[DVec3; MAX_FINGERS],
) -> Option<[DVec3; MAX_FINGERS]> {
    let mut cones = [Cone::default(); MAX_FINGERS];
    for (p, press) in numbered(presses) {
        cones[p] = Cone::about(press.push, &compliance[p][p])?;
    }
    let direct = Layout::of(presses).solution(compliance, presses)?;
    if numbered(presses).all(|(p, _)| cones[p].holds(direct[p])) {
        return Some(direct);
    }
    swept(compliance, presses, &cones, before)
}

/// Projected block Gauss-Seidel. No step raises the energy, so that any sweep may be the last.
fn swept(
    compliance: &Blocks,
    presses: &[Option<Press>; MAX_FINGERS],
    cones: &[Cone; MAX_FINGERS],
    before: &[DVec3; MAX_FINGERS],
) -> Option<[DVec3; MAX_FINGERS]> {
    let mut forces = [DVec3::ZERO; MAX_FINGERS];
    let mut inverses = [DMat3::ZERO; MAX_FINGERS];
    for (p, _) in numbered(presses) {
        forces[p] = cones[p].nearest(before[p]);
        inverses[p] = inverse_of_definite(&compliance[p][p])?;
    }
    for _ in 0..MOST_SWEEPS {
        let (mut change, mut largest) = (0.0_f64, 0.0_f64);
        for (p, press) in numbered(presses) {
            let moved = numbered(presses).map(|(q, _)| compliance[p][q] * forces[q]);
            let rest = press.displacement - moved.sum::<DVec3>();
            let wanted = forces[p] + inverses[p] * rest;
            let next = if cones[p].holds(wanted) {
                wanted
            } else {
                // Down the gradient, by a step that its largest curvature allows.
                let step = 1.0 / (3.0 * mean(&compliance[p][p]));
                cones[p].nearest(forces[p] + rest * step)
            };
            change = change.max(next.distance(forces[p]));
            largest = largest.max(next.length());
            forces[p] = next;
        }
        if change <= CONVERGED * largest {
            break;
        }
    }
    Some(forces)
}
