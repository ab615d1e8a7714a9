//! Products of which the matrix of a system is made.

use crate::algebra::wide::{plus_product, widely};
use crate::pile::between::Three;

widely! {
    /// What moves some slots by three forces, as a contact that they carry by their shares sees it: of
    /// each force the parts along its three directions.
    pub(super) fn seen_by(shares: &[(usize, f64)], moved: &[Three], along: &Three) -> Three {
        let (mut sum, mut parts) = ([0.0; 12], [0.0; 12]);
        for &(slot, share) in shares {
            let moved = &moved[slot];
            for k in 0..12 {
                sum[k] = plus_product::<FUSED>(sum[k], share, moved[k]);
            }
        }
        for way in 0..3 {
            for l in 0..4 {
                let of = |axis: usize| (sum[4 * way + axis], along[4 * axis + l]);
                let [(x, by_x), (y, by_y), (z, by_z)] = [of(0), of(1), of(2)];
                let by_two = plus_product::<FUSED>(x * by_x, y, by_y);
                parts[4 * way + l] = plus_product::<FUSED>(by_two, z, by_z);
            }
        }
        parts
    }
}

widely! {
    /// Adds six rows, each so many times, to one as far as it reaches.
    pub(super) fn add_six(rows: &[f64], count: usize, times: &[f64; 6], to: &mut [f64]) {
        let [a, b, c, d, e, f] = [0, 1, 2, 3, 4, 5].map(|k: usize| &rows[k * count..][..to.len()]);
        for i in 0..to.len() {
            let by_shift = plus_product::<FUSED>(times[0] * a[i], times[1], b[i]);
            let by_shift = plus_product::<FUSED>(by_shift, times[2], c[i]);
            let by_turn = plus_product::<FUSED>(times[3] * d[i], times[4], e[i]);
            let by_turn = plus_product::<FUSED>(by_turn, times[5], f[i]);
            to[i] += by_shift + by_turn;
        }
    }
}
