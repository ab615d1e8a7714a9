//! The compressed compliance, as `core/compliance/compression` makes it: uniform block low rank.

use glam::{DMat3, DVec3};

use crate::body::compliance::either::Either;
use crate::body::compliance::error::{ComplianceError, refuse};
use crate::body::compliance::table::Table;

/// Numbers in a tile's row and column.
pub(super) const TILE: usize = 8;

/// The arrays of a compressed compliance, as `core/compliance/compression` names and lays them out.
#[derive(Debug)]
pub struct CompressedParts {
    /// Place of each node among the padded clusters.
    pub places: Vec<u32>,
    /// L_ii, row by row.
    pub own_blocks: Table<f64>,
    /// A factor for each row of each padded cluster.
    pub near_scale: Table<f32>,
    /// Number of the near block between two clusters, from 1 on; 0 for far ones.
    pub near_table: Vec<u32>,
    /// Step of each near block.
    pub near_steps: Table<f32>,
    /// Near blocks in steps, rows of the lower cluster.
    pub near: Either<i16, f32>,
    /// Tiles of each cluster's basis.
    pub tile_counts: Vec<u32>,
    /// Bases, one after the other, a row for each row of a padded cluster.
    pub basis: Table<f32>,
    /// Step of each cluster's couplings.
    pub steps: Table<f32>,
    /// Numbers of tiles by place: 0 none, from 1 on narrow, from -1 down wide.
    pub tile_table: Vec<i32>,
    /// Tiles of 8 bits.
    pub narrow: Table<i8>,
    /// Tiles of more.
    pub wide: Either<i16, i32>,
}

/// Uniform block low rank: near blocks whole, far ones between the bases of two clusters.
#[derive(Debug)]
pub struct Compressed {
    pub(super) parts: CompressedParts,
    pub(super) nodes: usize,
    /// Rows of a padded cluster.
    pub(super) rows: usize,
    /// First tile of each cluster, and the number of all.
    pub(super) first_tile: Vec<usize>,
    /// Places in ascending order, each with its node: so memory is read from front to back.
    pub(super) by_place: Vec<(u32, u32)>,
}

impl Compressed {
    /// Checks that the parts belong together: every place that is read later lies inside.
    ///
    /// # Errors
    /// [`ComplianceError`] with the part that does not fit.
    pub fn new(parts: CompressedParts) -> Result<Self, ComplianceError> {
        let nodes = parts.places.len();
        let clusters = parts.tile_counts.len();
        if clusters == 0 || parts.near_scale.len() % (3 * clusters) != 0 {
            return refuse(format!(
                "near_scale has {} numbers for {clusters} clusters; it must have as many for each",
                parts.near_scale.len()
            ));
        }
        let rows = parts.near_scale.len() / clusters;
        let mut first_tile = vec![0; clusters + 1];
        for (cluster, &count) in parts.tile_counts.iter().enumerate() {
            first_tile[cluster + 1] = first_tile[cluster] + count as usize;
        }
        let tiles = first_tile[clusters];
        let Some(tile_pairs) = tiles.checked_mul(tiles) else {
            return refuse(
                "tile_counts add up to more tiles than can be numbered; make the body again".into(),
            );
        };
        let near_blocks = parts.near_steps.len();
        let narrow = parts.narrow.len() / (TILE * TILE);
        let wide = parts.wide.len() / (TILE * TILE);
        for (name, found, expected) in [
            ("own_blocks", parts.own_blocks.len(), 9 * nodes),
            ("near_table", parts.near_table.len(), clusters * clusters),
            ("near", parts.near.len(), near_blocks * rows * rows),
            ("basis", parts.basis.len(), rows * TILE * tiles),
            ("steps", parts.steps.len(), clusters),
            ("tile_table", parts.tile_table.len(), tile_pairs),
            ("narrow", parts.narrow.len(), narrow.max(1) * TILE * TILE),
            ("wide", parts.wide.len(), wide * TILE * TILE),
        ] {
            if found != expected {
                return refuse(format!("{name} has {found} numbers, not {expected}"));
            }
        }
        let beyond = |name: &str| {
            refuse(format!(
                "{name} points beyond what there is; make the body again"
            ))
        };
        if (parts.places.iter()).any(|&place| 3 * place as usize >= rows * clusters) {
            return beyond("places");
        }
        if (parts.near_table.iter()).any(|&number| number as usize > near_blocks) {
            return beyond("near_table");
        }
        let is_tile = |number: i32| {
            let place = number.unsigned_abs() as usize;
            if number < 0 {
                place <= wide
            } else {
                place < narrow
            }
        };
        if !parts.tile_table.iter().all(|&number| is_tile(number)) {
            return beyond("tile_table");
        }
        if (0..clusters).any(|c| parts.near_table[c * clusters + c] == 0) {
            return refuse(
                "near_table leaves out a cluster as its own neighbour; make the body again".into(),
            );
        }
        let mut by_place: Vec<(u32, u32)> = parts.places.iter().copied().zip(0..).collect();
        by_place.sort_unstable();
        Ok(Self {
            parts,
            nodes,
            rows,
            first_tile,
            by_place,
        })
    }

    #[inline]
    pub(super) fn block(&self, i: usize, j: usize) -> DMat3 {
        if i == j {
            let own = |k: usize| self.parts.own_blocks[9 * i + k];
            return DMat3::from_cols(
                DVec3::new(own(0), own(3), own(6)),
                DVec3::new(own(1), own(4), own(7)),
                DVec3::new(own(2), own(5), own(8)),
            );
        }
        // One of both is computed and the other one turned, as blocks are stored once.
        let places = &self.parts.places;
        if places[i] > places[j] {
            return self
                .upper(places[j] as usize, places[i] as usize)
                .transpose();
        }
        self.upper(places[i] as usize, places[j] as usize)
    }

    fn upper(&self, i: usize, j: usize) -> DMat3 {
        let leaf = self.rows / 3;
        let (row, column) = (i / leaf, j / leaf);
        let (a, b) = (3 * (i % leaf), 3 * (j % leaf));
        let near = self.parts.near_table[row * self.parts.tile_counts.len() + column] as usize;
        if near == 0 {
            self.far(row, a, column, b)
        } else {
            self.near(near - 1, row, a, column, b)
        }
    }

    fn near(&self, number: usize, row: usize, a: usize, column: usize, b: usize) -> DMat3 {
        let step = f64::from(self.parts.near_steps[number]);
        let scale = |cluster: usize, inside: usize| {
            f64::from(self.parts.near_scale[cluster * self.rows + inside])
        };
        let entry = |r: usize, c: usize| {
            let place = (number * self.rows + a + r) * self.rows + b + c;
            scale(row, a + r) * scale(column, b + c) * (step * self.parts.near.at(place))
        };
        DMat3::from_cols_array_2d(&[0, 1, 2].map(|c| [0, 1, 2].map(|r| entry(r, c))))
    }

    /// B_r M B_c^T for three rows each, tile by tile of M.
    fn far(&self, row: usize, a: usize, column: usize, b: usize) -> DMat3 {
        let tiles = self.first_tile[self.first_tile.len() - 1];
        let mut sum = DMat3::ZERO;
        for s in 0..self.parts.tile_counts[row] as usize {
            let line = (self.first_tile[row] + s) * tiles + self.first_tile[column];
            // M B_c^T for the eight rows of this line of tiles.
            let mut moved = [DVec3::ZERO; TILE];
            for t in 0..self.parts.tile_counts[column] as usize {
                let number = self.parts.tile_table[line + t];
                if number == 0 {
                    continue;
                }
                let patterns: [DVec3; TILE] =
                    std::array::from_fn(|k| self.patterns(column, b, t * TILE + k));
                for (m, line) in moved.iter_mut().enumerate() {
                    for (k, pattern) in patterns.iter().enumerate() {
                        *line += *pattern * self.coupling(number, m * TILE + k);
                    }
                }
            }
            for (m, line) in moved.iter().enumerate() {
                let pattern = self.patterns(row, a, s * TILE + m);
                sum.x_axis += pattern * line.x;
                sum.y_axis += pattern * line.y;
                sum.z_axis += pattern * line.z;
            }
        }
        let step = |cluster: usize| f64::from(self.parts.steps[cluster]);
        sum * step(row).min(step(column))
    }

    /// Three rows of one pattern of a cluster's basis.
    #[inline]
    pub(super) fn patterns(&self, cluster: usize, inside: usize, pattern: usize) -> DVec3 {
        let rank = TILE * self.parts.tile_counts[cluster] as usize;
        let first = self.rows * TILE * self.first_tile[cluster] + inside * rank + pattern;
        let entry = |r: usize| f64::from(self.parts.basis[first + r * rank]);
        DVec3::new(entry(0), entry(1), entry(2))
    }

    #[inline]
    fn coupling(&self, number: i32, entry: usize) -> f64 {
        let place = number.unsigned_abs() as usize;
        if number > 0 {
            f64::from(self.parts.narrow[place * TILE * TILE + entry])
        } else {
            self.parts.wide.at((place - 1) * TILE * TILE + entry)
        }
    }
}
