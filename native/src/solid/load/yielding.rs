//! Springs at places of a linear body, and how it yields under them.

use glam::DMat3;

use super::lower_upper::LowerUpper;
use super::place::Place;
use crate::solid::domains::Nodal;

/// No node.
const NONE: usize = usize::MAX;

/// Springs S at places of a body of the compliance C: of forces h = S (u - C h) by which they hold back a
/// displacement u, 1 + S C.
///
/// By nodes, not places: those have less unknowns where each triangle has three places.
#[derive(Debug, Clone, Default)]
pub struct Yielding {
    springs: Vec<(usize, DMat3)>,
    /// The free nodes that springs meet.
    nodes: Vec<u32>,
    factor: LowerUpper,
}

impl Yielding {
    /// Has springs at some of the places, where `compliance` is between `known` nodes, by rows.
    pub fn set(
        &mut self,
        springs: Vec<(usize, DMat3)>,
        places: &[Place],
        compliance: &[DMat3],
        known: usize,
    ) {
        self.springs = springs;
        let met = self.meet(places, known);
        let between = self.between_nodes(places, &met);
        let size = 3 * self.nodes.len();
        self.factor.fill(size, |columns| {
            // No less than one: nothing may press.
            for (column, own) in columns.chunks_mut((3 * size).max(1)).enumerate() {
                for (row, others) in between.iter().enumerate() {
                    let block = (others.iter())
                        .map(|&(other, spring)| {
                            spring * compliance[met[other] * known + met[column]]
                        })
                        .fold(DMat3::ZERO, |sum, part| sum + part);
                    for (axis, part) in block.to_cols_array_2d().into_iter().enumerate() {
                        let from = axis * size + 3 * row;
                        own[from..from + 3].copy_from_slice(&part);
                    }
                }
            }
            for one in 0..size {
                columns[one * size + one] += 1.0;
            }
        });
    }

    /// `forces` become those by which the springs hold back a displacement that the body alone would make.
    pub fn held_back(&self, places: &[Place], solved: &Nodal, forces: &mut Nodal) {
        forces.fill([0.0; 3]);
        for &(one, spring) in &self.springs {
            places[one].add(spring * places[one].mean(solved), forces);
        }
        let asked = self.nodes.iter().flat_map(|&node| forces[node as usize]);
        let found = self.factor.solved(&asked.collect::<Vec<_>>());
        for (node, held) in self.nodes.iter().zip(found.chunks(3)) {
            forces[*node as usize].copy_from_slice(held);
        }
    }

    /// Which of the known nodes springs meet.
    fn meet(&mut self, places: &[Place], known: usize) -> Vec<usize> {
        self.nodes.clear();
        let (mut is_met, mut met) = (vec![false; known], Vec::new());
        for &(one, _) in &self.springs {
            for (node, at, _) in places[one].moving() {
                if !std::mem::replace(&mut is_met[at], true) {
                    met.push(at);
                    self.nodes.push(node);
                }
            }
        }
        met
    }

    /// Of each node that is met, the springs between it and others.
    fn between_nodes(&self, places: &[Place], met: &[usize]) -> Vec<Vec<(usize, DMat3)>> {
        let mut rows = vec![NONE; met.iter().max().map_or(0, |most| most + 1)];
        for (row, &at) in met.iter().enumerate() {
            rows[at] = row;
        }
        let mut found: Vec<Vec<(usize, DMat3)>> = vec![Vec::new(); met.len()];
        for &(one, spring) in &self.springs {
            for (_, at, share) in places[one].moving() {
                let others = &mut found[rows[at]];
                for (_, other, more) in places[one].moving() {
                    let (other, part) = (rows[other], share * more * spring);
                    match others.iter_mut().find(|known| known.0 == other) {
                        Some(known) => known.1 += part,
                        None => others.push((other, part)),
                    }
                }
            }
        }
        found
    }
}
