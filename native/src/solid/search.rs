//! How far to go along a direction that leads downhill.

/// A parabola at least this far ahead of the end of a step takes the whole step: the energy is no
/// parabola, and a step that is nearly right is cheaper taken than looked at again.
const WHOLE_FROM: f64 = 0.8;
const SHORTEST_STEP: f64 = 0.05;
/// What a step must bring of what its slope promises.
const SUFFICIENT: f64 = 1e-4;
/// Of a step that brought too little the next try is so much at least, and at most.
const NEXT_TRY: (f64, f64) = (0.1, 0.5);

/// Share of a step at which the parabola through these values is lowest, 0.05 to 1. `slope` is the
/// derivative at the start along the whole step, zero or less.
pub fn step_length(start: f64, slope: f64, end: f64) -> f64 {
    let curvature = 2.0 * (end - start - slope);
    if -slope >= WHOLE_FROM * curvature {
        return 1.0;
    }
    (-slope / (WHOLE_FROM * curvature)).max(SHORTEST_STEP)
}

/// Share of a step, at most 1, whose work on its own stiffness is that of the linear shape.
///
/// `work` is F K^-1 F, `descent` g H g. Where steps of sense are smaller by far this bounds those of a
/// body whose gradients grow with the cube of what is wrong.
pub fn bound(work: f64, descent: f64) -> f64 {
    if descent <= work {
        1.0
    } else {
        (work / descent).sqrt()
    }
}

/// Whether a share of a step with this slope brings enough.
pub fn is_enough(start: f64, slope: f64, share: f64, end: f64) -> bool {
    end <= start + SUFFICIENT * share * slope
}

/// The share to try after one that brought too little.
pub fn shorter(start: f64, slope: f64, share: f64, end: f64) -> f64 {
    let (least, most) = NEXT_TRY;
    let curvature = 2.0 * (end - start - share * slope);
    let lowest = -share * slope / curvature;
    // What is no number is shortened by as much as may be.
    share
        * if lowest >= least {
            lowest.min(most)
        } else {
            least
        }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_end_where_the_parabola_is_lowest_and_a_little_beyond() {
        for (start, slope, end, share) in [
            (0.0, -2.0, -1.0, 1.0),  // its lowest point is the end
            (0.0, -2.0, -2.0, 1.0),  // no bend: falls on
            (0.0, -2.0, -3.0, 1.0),  // bent the other way
            (0.0, -2.0, 0.0, 0.625), // lowest half way
            (0.0, -2.0, 1e9, 0.05),
            (3.0, 0.0, 3.0, 1.0), // has arrived
        ] {
            assert!((step_length(start, slope, end) - share).abs() < 1e-12);
        }
    }

    #[test]
    fn a_share_that_brings_too_little_is_shortened_within_bounds() {
        assert!(!is_enough(0.0, -1.0, 1.0, 0.0) && is_enough(0.0, -1.0, 1.0, -0.5));
        assert!((shorter(0.0, -1.0, 1.0, 0.5) - 1.0 / 3.0).abs() < 1e-12);
        assert_eq!(shorter(0.0, -1.0, 1.0, f64::NAN), 0.1);
        assert_eq!(shorter(0.0, -1.0, 1.0, 1e9), 0.1);
        assert_eq!(shorter(0.0, -1.0, 1.0, -0.9), 0.5);
    }
}
