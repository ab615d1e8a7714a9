//! Force shading: the surface point whose interpolated normal points away from the device.
//!
//! Every facet with its corner normals n_i spans prisms below it: d = sum alpha_i (x_i + t n_i).
//! The prisms of neighbours share their walls, so the point sum alpha_i x_i moves continuously
//! with the device d where the facets' own nearest points jump from one to the next; for normals
//! that are exact on a sphere it is the radial projection. t is a root of the cubic that says when
//! d lies in the plane of the moved corners (the "Phong projection" of subdivision surfaces).

use glam::DVec3;

use crate::body::face::HalfEdge;
use crate::body::surface::Body;
use crate::proxy::place::SurfacePoint;

/// Triangles tried at most.
const MAX_TRIANGLES: u32 = 48;
/// Newton steps for the cubic; it starts from the last tick's root.
const MAX_NEWTON: u32 = 8;
/// A moved triangle that has shrunk below this share of itself is about to fold.
const LEAST_SHARE: f64 = 0.01;
/// Area coordinates this little outside belong to the triangle.
const OUTSIDE: f64 = 1e-12;

/// The shaded contact point near `start`, at most about `depth` above the device.
///
/// None where there is none: beyond a crease, or so deep that the normals meet.
pub(super) fn shaded(body: &Body, start: u32, device: DVec3, depth: f64) -> Option<SurfacePoint> {
    let mut triangle = start;
    let mut t = -depth;
    for _ in 0..MAX_TRIANGLES {
        let (alpha, root) = in_prism(body, triangle, device, t)?;
        let lowest = (0..3).fold(0, |low, k| if alpha[k] < alpha[low] { k } else { low });
        if alpha[lowest] >= -OUTSIDE {
            let alpha = alpha.map(|a| a.max(0.0));
            let sum: f64 = alpha.iter().sum();
            let alpha = alpha.map(|a| a / sum);
            return (root <= 0.0).then_some(SurfacePoint { triangle, alpha });
        }
        let edge = HalfEdge {
            triangle,
            edge: ((lowest + 1) % 3) as u8,
        };
        if !body.is_soft(edge) {
            return None;
        }
        triangle = body.face(triangle).across[edge.edge as usize].triangle;
        t = root;
    }
    None
}

/// Area coordinates and t of the device in the prism of one triangle.
fn in_prism(body: &Body, triangle: u32, device: DVec3, start: f64) -> Option<([f64; 3], f64)> {
    let face = body.face(triangle);
    let [a, b, c] = face.corners;
    let [na, nb, nc] = *body.corner_normals(triangle);
    let (m1, m2) = (nb - na, nc - na);
    let (e1, e2, arm) = (b - a, c - a, device - a);
    let mut t = start;
    let area_squared = face.area_vector.length_squared();
    for _ in 0..MAX_NEWTON {
        let (side1, side2, rest) = (e1 + m1 * t, e2 + m2 * t, arm - na * t);
        let normal = side1.cross(side2);
        let slope = (m1.cross(side2) + side1.cross(m2)).dot(rest) - normal.dot(na);
        if normal.dot(face.area_vector) < LEAST_SHARE * area_squared || slope >= 0.0 {
            return None;
        }
        let step = normal.dot(rest) / slope;
        t -= step;
        if step.abs() <= 1e-12 * t.abs() {
            break;
        }
    }
    let (side1, side2, rest) = (e1 + m1 * t, e2 + m2 * t, arm - na * t);
    let normal = side1.cross(side2);
    if normal.dot(face.area_vector) < LEAST_SHARE * area_squared {
        return None;
    }
    let scale = 1.0 / normal.length_squared();
    let beta = rest.cross(side2).dot(normal) * scale;
    let gamma = side1.cross(rest).dot(normal) * scale;
    Some(([1.0 - beta - gamma, beta, gamma], t))
}

/// The unit normal at area coordinates, interpolated between the corners.
#[inline]
pub(super) fn normal_at(body: &Body, triangle: u32, alpha: [f64; 3]) -> DVec3 {
    let [a, b, c] = *body.corner_normals(triangle);
    (a * alpha[0] + b * alpha[1] + c * alpha[2]).normalize_or(body.face(triangle).normal)
}
