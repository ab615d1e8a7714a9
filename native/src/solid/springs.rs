//! Springs between nodes and their places at rest, beside the strains of a body.

use super::domains::Nodal;

/// The energy u.S u / 2, alike along the three axes, of a sparse symmetric S by rows.
#[derive(Debug, Clone)]
pub struct Springs {
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Springs {
    /// S of entries, those of row k from `starts[k]` to `starts[k + 1]`.
    pub fn new(starts: Vec<usize>, columns: Vec<u32>, values: Vec<f64>) -> Self {
        Self {
            starts,
            columns,
            values,
        }
    }

    /// Adds S u to forces.
    pub fn add_forces(&self, moved: &Nodal, forces: &mut Nodal) {
        for (row, force) in forces.iter_mut().enumerate() {
            for at in self.starts[row]..self.starts[row + 1] {
                let (value, from) = (self.values[at], &moved[self.columns[at] as usize]);
                for axis in 0..3 {
                    force[axis] += value * from[axis];
                }
            }
        }
    }

    /// u.S u / 2.
    pub fn energy(&self, moved: &Nodal) -> f64 {
        let mut twice = 0.0;
        for (row, own) in moved.iter().enumerate() {
            for at in self.starts[row]..self.starts[row + 1] {
                let from = &moved[self.columns[at] as usize];
                let product = own[0] * from[0] + own[1] * from[1] + own[2] * from[2];
                twice += self.values[at] * product;
            }
        }
        0.5 * twice
    }
}
