//! From a displaced contact point to nodal forces and the felt force, equations (11) to (14),
//! and on to how the touched point gives way (15).

use glam::DVec3;

use crate::surface::Body;

/// Forces of one touch, N.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Touch {
    /// Equivalent forces on the triangle's three nodes (12), (13).
    pub nodal_forces: [DVec3; 3],
    /// Force on the finger (14).
    pub force: DVec3,
}

/// Force of the body on a finger that has moved the contact point by `displacement`.
///
/// `alpha` are the area coordinates in `triangle`, `young_modulus` is in Pa. A node whose area
/// coordinate is zero carries nothing, so both triangles of an edge give the same force.
#[inline]
pub fn touch(
    body: &Body,
    triangle: u32,
    alpha: [f64; 3],
    displacement: DVec3,
    young_modulus: f64,
) -> Touch {
    let nodes = body.triangles[triangle as usize];
    let nodal_forces = [0, 1, 2].map(|k: usize| {
        let block = &body.contact_blocks[nodes[k] as usize];
        *block * displacement * (young_modulus * alpha[k])
    });
    Touch {
        nodal_forces,
        force: -(nodal_forces[0] + nodal_forces[1] + nodal_forces[2]),
    }
}

/// How far the touched point of the surface moves under the forces on its three nodes (15).
///
/// `None` for a body without a compliance. A node whose area coordinate is zero neither carries
/// nor shows anything, so both triangles of an edge give the same displacement.
#[inline]
pub fn surface_displacement(
    body: &Body,
    triangle: u32,
    alpha: [f64; 3],
    nodal_forces: &[DVec3; 3],
    young_modulus: f64,
) -> Option<DVec3> {
    let mut moved = DVec3::ZERO;
    for (seen, &weight) in alpha.iter().enumerate() {
        for (loaded, &force) in nodal_forces.iter().enumerate() {
            if weight != 0.0 && force != DVec3::ZERO {
                moved += body.compliance_block(triangle, seen, loaded)? * force * weight;
            }
        }
    }
    body.has_compliance().then_some(moved / young_modulus)
}
