//! Gradients of nodal values in domains (tetrahedra, or where their strains are smoothed), four domains
//! at a time.

use super::four::{Four, Matrix, ZERO};

/// Vectors of all nodes.
pub type Nodal = [[f64; 3]];

/// Domains, each with the nodes on which its gradient depends.
#[derive(Debug, Clone)]
pub struct Domains {
    /// Where the entries of each four domains begin, and where the last ones end.
    starts: Vec<usize>,
    /// A node of each of the four; a domain with fewer nodes than those beside it has node 0 without
    /// effect.
    nodes: Vec<[u32; 4]>,
    /// Gradients of these nodes' values, 1/m.
    slopes: Vec<[Four; 3]>,
    /// The domain at each place of each four; the number of domains where there is none.
    order: Vec<[usize; 4]>,
}

impl Domains {
    /// Domains whose nodes and gradients are in `nodes` and `slopes`, the entries of domain d from
    /// `starts[d]` to `starts[d + 1]`.
    pub fn new(starts: &[usize], nodes: &[u32], slopes: &[[f64; 3]]) -> Self {
        let count = starts.len() - 1;
        let size = |domain: usize| starts[domain + 1] - starts[domain];
        // Those of a size together: little is wasted on places without a node.
        let mut sorted: Vec<usize> = (0..count).collect();
        sorted.sort_by_key(|&domain| size(domain));
        let mut found = Self {
            starts: vec![0],
            nodes: Vec::new(),
            slopes: Vec::new(),
            order: Vec::new(),
        };
        for four in sorted.chunks(4) {
            let mut places = [count; 4];
            places[..four.len()].copy_from_slice(four);
            for entry in 0..four.iter().map(|&domain| size(domain)).max().unwrap_or(0) {
                let (mut node, mut slope) = ([0; 4], [ZERO; 3]);
                for (lane, &domain) in four.iter().enumerate() {
                    if entry < size(domain) {
                        let at = starts[domain] + entry;
                        node[lane] = nodes[at];
                        for (slope, value) in slope.iter_mut().zip(slopes[at]) {
                            slope.0[lane] = value;
                        }
                    }
                }
                found.nodes.push(node);
                found.slopes.push(slope);
            }
            found.starts.push(found.nodes.len());
            found.order.push(places);
        }
        found
    }

    /// How many fours there are.
    pub fn fours(&self) -> usize {
        self.order.len()
    }

    /// Numbers of domains in the order of the fours; nothing where there is no domain.
    pub fn in_fours(&self, values: &[f64]) -> Vec<Four> {
        let of = |domain: usize| values.get(domain).copied().unwrap_or(0.0);
        let four = |places: &[usize; 4]| Four(places.map(of));
        self.order.iter().map(four).collect()
    }

    /// du/dX in four domains.
    #[inline(always)]
    pub fn gradient(&self, four: usize, values: &Nodal) -> Matrix {
        let range = self.starts[four]..self.starts[four + 1];
        let mut found = [[ZERO; 3]; 3];
        let (nodes, slopes) = (&self.nodes[range.clone()], &self.slopes[range]);
        for (node, slope) in nodes.iter().zip(slopes) {
            let a = &values[node[0] as usize];
            let b = &values[node[1] as usize];
            let c = &values[node[2] as usize];
            let d = &values[node[3] as usize];
            for axis in 0..3 {
                let value = Four([a[axis], b[axis], c[axis], d[axis]]);
                found[axis][0] += value * slope[0];
                found[axis][1] += value * slope[1];
                found[axis][2] += value * slope[2];
            }
        }
        found
    }

    /// Adds the nodal forces of stresses in four domains that are times their volumes: the transpose.
    #[inline(always)]
    pub fn add_forces(&self, four: usize, stress: &Matrix, forces: &mut Nodal) {
        let range = self.starts[four]..self.starts[four + 1];
        let (nodes, slopes) = (&self.nodes[range.clone()], &self.slopes[range]);
        for (node, slope) in nodes.iter().zip(slopes) {
            let x = stress[0][0] * slope[0] + stress[0][1] * slope[1] + stress[0][2] * slope[2];
            let y = stress[1][0] * slope[0] + stress[1][1] * slope[1] + stress[1][2] * slope[2];
            let z = stress[2][0] * slope[0] + stress[2][1] * slope[1] + stress[2][2] * slope[2];
            for lane in 0..4 {
                let force = &mut forces[node[lane] as usize];
                force[0] += x.0[lane];
                force[1] += y.0[lane];
                force[2] += z.0[lane];
            }
        }
    }
}
