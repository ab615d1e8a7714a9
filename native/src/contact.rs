//! From a displaced contact point to nodal forces and the felt force, equations (11) to (14).

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
