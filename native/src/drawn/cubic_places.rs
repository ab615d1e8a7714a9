//! Fixed places in cubic Bezier triangles whose control vectors change with every frame.

use std::num::NonZero;
use std::thread;

use glam::{DVec3, Mat4, Vec4};

/// Control vectors of a patch.
pub const CONTROLS: usize = 10;

/// A block has no more places: fewer are not worth a thread of their own, and what is written of so
/// many stays near the processor.
const PLACES_A_BLOCK: usize = 1 << 16;

/// Places of one patch that are computed at once.
const AT_ONCE: usize = 4;

/// Bernstein polynomials' control vectors times their numbers of ways, by the corner that is near:
/// the corner's own, and those beside it in the order of the corners. The fourth number of each is
/// zero.
#[derive(Debug, Clone, Copy)]
pub struct Patch {
    near: [[Vec4; 3]; 3],
    middle: Vec4,
}

impl Patch {
    /// Of control vectors: of the corners; beside them, towards another corner (01, 02, 10, 12, 20,
    /// 21); and of the middle.
    pub fn new([a, b, c, ab, ac, ba, bc, ca, cb, middle]: &[DVec3; CONTROLS]) -> Self {
        let four = |times: f64, v: &DVec3| (times * v).as_vec3().extend(0.0);
        Self {
            near: [
                [four(1.0, a), four(3.0, ab), four(3.0, ac)],
                [four(3.0, ba), four(1.0, b), four(3.0, bc)],
                [four(3.0, ca), four(3.0, cb), four(1.0, c)],
            ],
            middle: four(6.0, middle),
        }
    }

    /// Vectors of places by two of their area coordinates; exactly zero where all control vectors
    /// with a weight are.
    #[inline]
    fn at(&self, alphas: &[[f32; 2]; AT_ONCE]) -> [Vec4; AT_ONCE] {
        let (a, b) = (
            Vec4::from_array(alphas.map(|[a, _]| a)),
            Vec4::from_array(alphas.map(|[_, b]| b)),
        );
        let c = Vec4::ONE - a - b;
        let along = |axis: usize| {
            let mut sum = a * b * c * self.middle[axis];
            for ([one, two, three], own) in self.near.iter().zip([a, b, c]) {
                sum += own * own * (a * one[axis] + b * two[axis] + c * three[axis]);
            }
            sum
        };
        let found = Mat4::from_cols(along(0), along(1), along(2), Vec4::ZERO).transpose();
        [found.x_axis, found.y_axis, found.z_axis, found.w_axis]
    }
}

/// Places by the number of their patch and two of their area coordinates.
#[derive(Debug)]
pub struct CubicPlaces {
    blocks: Vec<Block>,
    count: usize,
}

/// Places that follow each other, ordered by their patches.
#[derive(Debug)]
struct Block {
    /// Patches, and how many places each has.
    runs: Vec<(u32, u32)>,
    /// Numbers of the places within the block.
    places: Vec<u32>,
    alphas: Vec<[f32; 2]>,
}

impl CubicPlaces {
    /// Places in `count` patches; None where one names another patch.
    pub fn new(patch: &[u32], alpha: &[[f32; 2]], count: usize) -> Option<Self> {
        let fits = patch.len() == alpha.len() && patch.iter().all(|&one| (one as usize) < count);
        let parts = patch
            .chunks(PLACES_A_BLOCK)
            .zip(alpha.chunks(PLACES_A_BLOCK));
        fits.then(|| Self {
            blocks: parts
                .map(|(patch, alpha)| Block::new(patch, alpha))
                .collect(),
            count: patch.len(),
        })
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Vectors of all places, one after the other, by all cores. `moved` has three numbers for each
    /// place, and `patches` are as many as were promised.
    pub fn evaluate(&self, patches: &[Patch], moved: &mut [f32]) {
        assert_eq!(moved.len(), 3 * self.len(), "a vector for each place");
        let cores = thread::available_parallelism().map_or(1, NonZero::get);
        let share = self.blocks.len().div_ceil(cores).max(1);
        let mut parts = self
            .blocks
            .chunks(share)
            .zip(moved.chunks_mut(3 * PLACES_A_BLOCK * share));
        let own = parts.next();
        thread::scope(|scope| {
            for (blocks, moved) in parts {
                scope.spawn(|| in_turn(patches, blocks, moved));
            }
            if let Some((blocks, moved)) = own {
                in_turn(patches, blocks, moved);
            }
        });
    }
}

fn in_turn(patches: &[Patch], blocks: &[Block], moved: &mut [f32]) {
    for (block, moved) in blocks.iter().zip(moved.chunks_mut(3 * PLACES_A_BLOCK)) {
        block.evaluate(patches, moved);
    }
}

impl Block {
    fn new(patch: &[u32], alpha: &[[f32; 2]]) -> Self {
        let mut places: Vec<u32> = (0..patch.len() as u32).collect();
        places.sort_by_key(|&place| patch[place as usize]);
        Self {
            runs: places
                .chunk_by(|&one, &next| patch[one as usize] == patch[next as usize])
                .map(|run| (patch[run[0] as usize], run.len() as u32))
                .collect(),
            alphas: places.iter().map(|&place| alpha[place as usize]).collect(),
            places,
        }
    }

    fn evaluate(&self, patches: &[Patch], moved: &mut [f32]) {
        let (mut places, mut alphas) = (&self.places[..], &self.alphas[..]);
        for &(patch, count) in &self.runs {
            let patch = &patches[patch as usize];
            let (own_places, own_alphas);
            (own_places, places) = places.split_at(count as usize);
            (own_alphas, alphas) = alphas.split_at(count as usize);
            let (fours, of_fours) = (
                own_alphas.chunks_exact(AT_ONCE),
                own_places.chunks_exact(AT_ONCE),
            );
            let (last, of_last) = (fours.remainder(), of_fours.remainder());
            for (alphas, places) in fours.zip(of_fours) {
                let alphas = std::array::from_fn(|k| alphas[k]);
                put(moved, places, &patch.at(&alphas));
            }
            if !last.is_empty() {
                let alphas = std::array::from_fn(|k| last.get(k).copied().unwrap_or_default());
                put(moved, of_last, &patch.at(&alphas));
            }
        }
    }
}

/// Writes vectors of places by their numbers.
#[inline]
fn put(moved: &mut [f32], places: &[u32], vectors: &[Vec4; AT_ONCE]) {
    for (&place, vector) in places.iter().zip(vectors) {
        let first = 3 * place as usize;
        moved[first..first + 3].copy_from_slice(&vector.to_array()[..3]);
    }
}
