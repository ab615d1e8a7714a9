//! Fixed places in cubic Bezier triangles whose control vectors change with every frame.

use std::num::NonZero;
use std::thread;

/// Control vectors of a patch.
pub const CONTROLS: usize = 10;

/// Control vectors in the order of [`weights`]; the fourth number is only there for the processor,
/// which takes four at once.
pub type Patch = [[f32; 4]; CONTROLS];

/// Fewer places are not worth a thread of their own.
const PLACES_A_THREAD: usize = 1 << 16;

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

    /// Vectors of all places, by all cores. `moved` is as long as the places are, and `patches` as
    /// many as were promised.
    pub fn evaluate(&self, patches: &[Patch], moved: &mut [[f32; 3]]) {
        assert_eq!(moved.len(), self.len(), "a vector for each place");
        let cores = thread::available_parallelism().map_or(1, NonZero::get);
        let share = self.len().div_ceil(cores).max(PLACES_A_THREAD);
        let mut parts = self
            .patch
            .chunks(share)
            .zip(self.alpha.chunks(share))
            .zip(moved.chunks_mut(share));
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

fn in_turn(patches: &[Patch], numbers: &[u32], alphas: &[[f32; 2]], moved: &mut [[f32; 3]]) {
    for ((&number, &alpha), moved) in numbers.iter().zip(alphas).zip(moved) {
        let mut sum = [0.0; 4];
        for (control, weight) in patches[number as usize].iter().zip(weights(alpha)) {
            for (sum, part) in sum.iter_mut().zip(control) {
                *sum += weight * part;
            }
        }
        *moved = [sum[0], sum[1], sum[2]];
    }
}

/// Bernstein polynomials: of the corners; beside them, towards another corner (01, 02, 10, 12, 20,
/// 21); and of the middle.
fn weights([a, b]: [f32; 2]) -> [f32; CONTROLS] {
    let c = 1.0 - a - b;
    let (aa, bb, cc) = (3.0 * a * a, 3.0 * b * b, 3.0 * c * c);
    [
        a * a * a,
        b * b * b,
        c * c * c,
        aa * b,
        aa * c,
        bb * a,
        bb * c,
        cc * a,
        cc * b,
        6.0 * a * b * c,
    ]
}
