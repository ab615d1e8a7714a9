//! From a displaced contact point to nodal forces and the felt force, equations (11) to (14) or the
//! consistent form of them, and on to how the touched point gives way (15).

use glam::{DMat3, DVec3};

use crate::body::surface::Body;

/// How a contact inside a triangle becomes a force.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ContactMode {
    /// Three nodes, each as if it were alone (11) to (14): the contact point stays short of the
    /// finger, or passes it.
    Paper,
    /// The force of least elastic energy that moves the contact point by exactly the finger's
    /// displacement. The same as (9) at nodes. A body without a compliance does not know how its
    /// nodes move each other: there it is as in the paper.
    #[default]
    Consistent,
}

impl ContactMode {
    /// Both modes.
    pub const ALL: [Self; 2] = [Self::Paper, Self::Consistent];

    /// Name for people and programs.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Consistent => "consistent",
        }
    }
}

/// Forces of one touch, N.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Touch {
    /// Equivalent forces on the triangle's three nodes (12), (13).
    pub nodal_forces: [DVec3; 3],
    /// Force on the finger (14).
    pub force: DVec3,
}

/// Compliance of a contact point at unit modulus, m/N times Pa: C = sum of a_p a_q L_pq over the
/// triangle's nodes. `None` for a body without a compliance.
///
/// A pinned node gives way as the contact blocks have it, and moves no other.
#[inline]
pub fn contact_compliance(body: &Body, triangle: u32, alpha: [f64; 3]) -> Option<DMat3> {
    let [own, across] = body.triangle_compliance(triangle)?;
    let [a, b, c] = alpha;
    let half = across[0] * (a * b) + across[1] * (b * c) + across[2] * (c * a);
    let sum = own[0] * (0.5 * a * a) + own[1] * (0.5 * b * b) + own[2] * (0.5 * c * c) + half;
    // Stored in single precision, L is symmetric to its rounding only.
    Some(sum + sum.transpose())
}

/// Inverse of a symmetric matrix; `None` unless it is positive definite (Sylvester's criterion).
#[inline]
pub fn inverse_of_definite(matrix: &DMat3) -> Option<DMat3> {
    let [x, y, z] = [matrix.x_axis, matrix.y_axis, matrix.z_axis];
    let (yz, zx, xy) = (y.cross(z), z.cross(x), x.cross(y));
    let determinant = z.dot(xy);
    let is_definite = x.x > 0.0 && xy.z > 0.0 && determinant > 0.0;
    is_definite.then(|| DMat3::from_cols(yz, zx, xy) * (1.0 / determinant))
}

/// Stiffness of a contact point by the consistent form, at unit modulus.
///
/// `None` for a body without a compliance, or should rounding have made this indefinite.
#[inline]
fn consistent_stiffness(body: &Body, triangle: u32, alpha: [f64; 3]) -> Option<DMat3> {
    inverse_of_definite(&contact_compliance(body, triangle, alpha)?)
}

/// Stiffness of the touched place at unit modulus, N/m per Pa: felt force over displacement.
#[inline]
pub fn contact_stiffness(body: &Body, mode: ContactMode, triangle: u32, alpha: [f64; 3]) -> DMat3 {
    if mode == ContactMode::Consistent
        && let Some(stiffness) = consistent_stiffness(body, triangle, alpha)
    {
        return stiffness;
    }
    let nodes = body.triangles[triangle as usize];
    let block = |k: usize| body.contact_blocks[nodes[k] as usize] * alpha[k];
    block(0) + block(1) + block(2)
}

/// Force of the body on a finger that has moved the contact point by `displacement`.
///
/// `alpha` are the area coordinates in `triangle`, `young_modulus` is in Pa. A node whose area
/// coordinate is zero carries nothing, so both triangles of an edge give the same force.
#[inline]
pub fn touch(
    body: &Body,
    mode: ContactMode,
    triangle: u32,
    alpha: [f64; 3],
    displacement: DVec3,
    young_modulus: f64,
) -> Touch {
    if mode == ContactMode::Consistent
        && let Some(stiffness) = consistent_stiffness(body, triangle, alpha)
    {
        let push = stiffness * displacement * young_modulus;
        return Touch {
            nodal_forces: alpha.map(|share| push * share),
            force: -push,
        };
    }
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
