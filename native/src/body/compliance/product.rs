//! A compressed compliance times forces on some nodes.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::body::compliance::compressed::{Compressed, TILE};
use crate::body::compliance::either::some;

impl Compressed {
    /// Near blocks and own blocks node by node; far ones cluster by cluster, in single precision.
    pub(super) fn apply(&self, loads: &[(usize, DVec3)]) -> Vec<DVec3> {
        let leaf = self.rows / 3;
        let mut near = vec![0.0_f32; self.rows * self.parts.tile_counts.len()];
        let mut patterns = vec![[0.0_f32; TILE]; self.first_tile[self.first_tile.len() - 1]];
        let mut loaded: BTreeMap<usize, Vec<[f32; TILE]>> = BTreeMap::new();
        for &(node, force) in loads {
            let place = self.parts.places[node] as usize;
            let (cluster, inside) = (place / leaf, 3 * (place % leaf));
            self.add_near(cluster, inside, force, &mut near);
            let tiles = self.parts.tile_counts[cluster] as usize;
            let load = (loaded.entry(cluster)).or_insert_with(|| vec![[0.0; TILE]; tiles]);
            for (pattern, sum) in load.as_flattened_mut().iter_mut().enumerate() {
                *sum += self.patterns(cluster, inside, pattern).dot(force) as f32;
            }
        }
        for (&cluster, load) in &loaded {
            self.add_far(cluster, load, &mut patterns);
        }
        let mut moved = vec![DVec3::ZERO; self.nodes];
        for &(place, node) in &self.by_place {
            moved[node as usize] = self.moved(place as usize, &near, &patterns);
        }
        for &(node, force) in loads {
            moved[node] += self.block(node, node) * force;
        }
        moved
    }

    fn add_near(&self, cluster: usize, inside: usize, force: DVec3, near: &mut [f32]) {
        let (rows, clusters) = (self.rows, self.parts.tile_counts.len());
        for other in 0..clusters {
            let number = self.parts.near_table[cluster * clusters + other] as usize;
            if number == 0 {
                continue;
            }
            let first = (number - 1) * rows * rows;
            let step = self.parts.near_steps[number - 1];
            let scales: [f32; 3] = some(&self.parts.near_scale, cluster * rows + inside);
            let force: [f32; 3] =
                std::array::from_fn(|axis| step * scales[axis] * force[axis] as f32);
            let moved = &mut near[other * rows..][..rows];
            // Rows of a stored block are of the cluster that counts lower.
            for (row, sum) in moved.iter_mut().enumerate() {
                if other <= cluster {
                    let entries: [f32; 3] = self.parts.near.some(first + row * rows + inside);
                    *sum += entries[0] * force[0] + entries[1] * force[1] + entries[2] * force[2];
                } else {
                    for (axis, force) in force.iter().enumerate() {
                        let [entry] = self.parts.near.some(first + (inside + axis) * rows + row);
                        *sum += entry * force;
                    }
                }
            }
        }
    }

    fn add_far(&self, cluster: usize, load: &[[f32; TILE]], patterns: &mut [[f32; TILE]]) {
        let tiles = patterns.len();
        let first = self.first_tile[cluster];
        for (other, range) in self.first_tile.windows(2).enumerate() {
            let step = self.parts.steps[cluster].min(self.parts.steps[other]);
            for (row, pattern) in (range[0]..).zip(&mut patterns[range[0]..range[1]]) {
                let mut sum = [0.0_f32; TILE];
                let numbers = &self.parts.tile_table[row * tiles + first..][..load.len()];
                for (&number, load) in numbers.iter().zip(load).filter(|(number, _)| **number != 0)
                {
                    // Rows of a stored tile are of the cluster that counts lower.
                    let tile = self.tile(number);
                    if other < cluster {
                        for (sum, line) in sum.iter_mut().zip(&tile) {
                            *sum += total(std::array::from_fn(|k| line[k] * load[k]));
                        }
                    } else {
                        for (line, load) in tile.iter().zip(load) {
                            for (sum, entry) in sum.iter_mut().zip(line) {
                                *sum += entry * load;
                            }
                        }
                    }
                }
                for (pattern, sum) in pattern.iter_mut().zip(sum) {
                    *pattern += step * sum;
                }
            }
        }
    }

    #[inline]
    fn tile(&self, number: i32) -> [[f32; TILE]; TILE] {
        let place = number.unsigned_abs() as usize * TILE * TILE;
        std::array::from_fn(|row| {
            if number > 0 {
                some(&self.parts.narrow, place + row * TILE).map(f32::from)
            } else {
                self.parts.wide.some(place - TILE * TILE + row * TILE)
            }
        })
    }

    /// Displacement of a place among the padded clusters by near blocks and patterns.
    fn moved(&self, place: usize, near: &[f32], patterns: &[[f32; TILE]]) -> DVec3 {
        let (cluster, inside) = (3 * place / self.rows, 3 * place % self.rows);
        let tiles = self.first_tile[cluster]..self.first_tile[cluster + 1];
        let rank = TILE * tiles.len();
        let first = self.rows * TILE * tiles.start + inside * rank;
        // Three rows at once, eight sums each: no addition waits for the one before.
        let mut lanes = [[0.0_f32; TILE]; 3];
        let [x, y, z] = [0, 1, 2].map(|axis| &self.parts.basis[first + axis * rank..][..rank]);
        let rows = (x.chunks_exact(TILE))
            .zip(y.chunks_exact(TILE))
            .zip(z.chunks_exact(TILE));
        for (((x, y), z), pattern) in rows.zip(&patterns[tiles]) {
            for k in 0..TILE {
                lanes[0][k] += x[k] * pattern[k];
                lanes[1][k] += y[k] * pattern[k];
                lanes[2][k] += z[k] * pattern[k];
            }
        }
        let near = &near[3 * place..][..3];
        let scale: [f32; 3] = some(&self.parts.near_scale, 3 * place);
        DVec3::from_array(std::array::from_fn(|axis| {
            f64::from(near[axis] * scale[axis] + total(lanes[axis]))
        }))
    }
}

/// Pairwise: no addition waits for more than two others.
#[inline]
fn total(l: [f32; TILE]) -> f32 {
    ((l[0] + l[4]) + (l[1] + l[5])) + ((l[2] + l[6]) + (l[3] + l[7]))
}
