//! Descent from triangle to triangle to the surface point nearest to a point close by.

use glam::DVec3;

use crate::body::face::closest_on_face;
use crate::body::surface::Body;
use crate::proxy::place::SurfacePoint;

/// Triangles entered at most; a descent that ends here is where it came to.
const MAX_TRIANGLES: u32 = 64;

/// From `hold` downhill to the locally nearest surface point to `goal`, without leaving the sheet.
pub(super) fn descend(body: &Body, hold: SurfacePoint, goal: DVec3) -> SurfacePoint {
    let mut triangle = hold.triangle;
    let (mut alpha, mut point) = closest_on_face(body.face(triangle), goal);
    for _ in 0..MAX_TRIANGLES {
        let mut best = point.distance_squared(goal);
        let mut onward = None;
        let mut look = |t: u32| {
            let (alpha, point) = closest_on_face(body.face(t), goal);
            let squared = point.distance_squared(goal);
            if squared < best {
                (best, onward) = (squared, Some((t, alpha, point)));
            }
        };
        let face = body.face(triangle);
        match alpha.map(|a| a == 0.0) {
            [false, false, false] => {}
            [true, false, false] => look(face.across[1].triangle),
            [false, true, false] => look(face.across[2].triangle),
            [false, false, true] => look(face.across[0].triangle),
            on_border => {
                let corner = on_border.iter().position(|z| !z).unwrap_or(0);
                for c in body.fan(face.fans[corner]).1 {
                    look(c.triangle);
                }
            }
        }
        match onward {
            Some(found) => (triangle, alpha, point) = found,
            None => break,
        }
    }
    SurfacePoint { triangle, alpha }
}
