//! Fixed places in cubic Bezier triangles whose control vectors change with every frame.

use std::num::NonZero;
use std::thread;

use glam::DVec3;

/// Control vectors of a patch.
pub const CONTROLS: usize = 10;

/// Fewer places are not worth a thread of their own.
const PLACES_A_THREAD: usize = 1 << 16;

/// Coefficients of a vector; the fourth number is only there for the processor, which takes four at
/// once.
type Four = [f32; 4];

/// Bernstein polynomials' control vectors times their numbers of ways, by the corner that is near:
/// the corner's own, and those beside it in the order of the corners.
#[derive(Debug, Clone, Copy)]
pub struct Patch {
    near: [[Four; 3]; 3],
    middle: Four,
}

impl Patch {
    /// Of control vectors: of the corners; beside them, towards another corner (01, 02, 10, 12, 20,
    /// 21); and of the middle.
    pub fn new([a, b, c, ab, ac, ba, bc, ca, cb, middle]: &[DVec3; CONTROLS]) -> Self {
        let four = |times: f64, v: &DVec3| (times * v).extend(0.0).to_array().map(|x| x as f32);
        Self {
            near: [
                [four(1.0, a), four(3.0, ab), four(3.0, ac)],
                [four(3.0, ba), four(1.0, b), four(3.0, bc)],
                [four(3.0, ca), four(3.0, cb), four(1.0, c)],
            ],
            middle: four(6.0, middle),
        }
    }

    /// Exactly zero where all control vectors with a weight are.
    #[inline]
    fn at(&self, [a, b]: [f32; 2]) -> [f32; 3] {
        let alpha = [a, b, 1.0 - a - b];
        let mut sum = self.middle.map(|x| alpha[0] * alpha[1] * alpha[2] * x);
        for (near, own) in self.near.iter().zip(alpha) {
            let [one, two, three] = near;
            sum = std::array::from_fn(|k| {
                let beside = alpha[0] * one[k] + alpha[1] * two[k] + alpha[2] * three[k];
                sum[k] + own * own * beside
            });
        }
        let [x, y, z, _] = sum;
        [x, y, z]
    }
}

/// Places by the number of their patch and two of their area coordinates.
#[derive(Debug)]
pub struct CubicPlaces {
    patch: Vec<u32>,
    alpha: Vec<[f32; 2]>,
}

impl CubicPlaces {
    /// Places in `count` patches; None where one names another patch.
    pub fn new(patch: Vec<u32>, alpha: Vec<[f32; 2]>, count: usize) -> Option<Self> {
        let fits = patch.len() == alpha.len() && patch.iter().all(|&one| (one as usize) < count);
        fits.then_some(Self { patch, alpha })
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.patch.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.patch.is_empty()
    }

    /// Vectors of all places, one after the other, by all cores. `moved` has three numbers for each
    /// place, and `patches` are as many as were promised.
    pub fn evaluate(&self, patches: &[Patch], moved: &mut [f32]) {
        assert_eq!(moved.len(), 3 * self.len(), "a vector for each place");
        let cores = thread::available_parallelism().map_or(1, NonZero::get);
        let share = self.len().div_ceil(cores).max(PLACES_A_THREAD);
        let mut parts = self
            .patch
            .chunks(share)
            .zip(self.alpha.chunks(share))
            .zip(moved.chunks_mut(3 * share));
        let own = parts.next();
        thread::scope(|scope| {
            for ((patch, alpha), moved) in parts {
                scope.spawn(|| in_turn(patches, patch, alpha, moved));
            }
            if let Some(((patch, alpha), moved)) = own {
                in_turn(patches, patch, alpha, moved);
            }
        });
    }
}

fn in_turn(patches: &[Patch], numbers: &[u32], alphas: &[[f32; 2]], moved: &mut [f32]) {
    for ((&number, &alpha), moved) in numbers.iter().zip(alphas).zip(moved.chunks_exact_mut(3)) {
        moved.copy_from_slice(&patches[number as usize].at(alpha));
    }
}
