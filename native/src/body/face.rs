//! A triangle of the rest surface and what a walk over it needs: half-edges, corners, fans.

use glam::DVec3;

use crate::body::error::BodyError;

/// Edge `k` of a triangle runs from its corner `k` to its corner `(k + 1) % 3`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct HalfEdge {
    /// Triangle the half-edge belongs to.
    pub triangle: u32,
    /// Number of the edge, 0 to 2.
    pub edge: u8,
}

/// A triangle with what every tick needs of it, in one place in memory.
#[derive(Debug, Clone)]
pub struct Face {
    /// Corner positions, counter-clockwise seen from outside.
    pub corners: [DVec3; 3],
    /// Twice the area times the outward normal.
    pub area_vector: DVec3,
    /// Unit outward normal.
    pub normal: DVec3,
    /// Unit in-plane perpendicular of each edge, pointing into the triangle.
    pub inward: [DVec3; 3],
    /// The half-edge across each edge, on the other side of the free space there.
    pub across: [HalfEdge; 3],
    /// The fan each corner belongs to.
    pub fans: [u32; 3],
    /// Angle by which rounding may turn `normal`, rad, doubled; large for slivers.
    slack: f64,
}

impl Face {
    /// Area coordinates of the orthogonal projection of `p` on the triangle's plane.
    #[inline]
    pub fn area_coordinates(&self, p: DVec3) -> [f64; 3] {
        let [a, b, c] = self.corners;
        let scale = 1.0 / self.area_vector.length_squared();
        let of = |u: DVec3, v: DVec3| self.area_vector.dot((v - u).cross(p - u)) * scale;
        [of(b, c), of(c, a), of(a, b)]
    }

    /// Position of area coordinates; exact at the corners.
    #[inline]
    pub fn at(&self, alpha: [f64; 3]) -> DVec3 {
        self.corners[0] * alpha[0] + self.corners[1] * alpha[1] + self.corners[2] * alpha[2]
    }

    /// Whether rounding cannot hide that both points are on one side of the plane.
    #[inline]
    pub(crate) fn is_clearly_beside(&self, p: DVec3, q: DVec3) -> bool {
        let (u, v) = (p - self.corners[0], q - self.corners[0]);
        let (a, b) = (self.normal.dot(u), self.normal.dot(v));
        let margin = self.slack * (u.abs().element_sum() + v.abs().element_sum());
        (a > margin && b > margin) || (a < -margin && b < -margin)
    }

    /// Positive outside the plane, negative inside, zero exactly on it: the sign is exact.
    #[inline]
    pub fn side(&self, p: DVec3) -> f64 {
        -orientation(self.corners[0], self.corners[1], self.corners[2], p)
    }
}

/// Shewchuk's adaptive orientation test: its sign is that of the exact determinant.
#[inline]
pub(crate) fn orientation(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> f64 {
    let coord = |p: DVec3| robust::Coord3D {
        x: p.x,
        y: p.y,
        z: p.z,
    };
    robust::orient3d(coord(a), coord(b), coord(c), coord(d))
}

/// The triangles around a node on one sheet of the surface.
///
/// A node where the surface touches itself has several fans; they are walked separately.
#[derive(Debug, Clone, Copy)]
pub struct Fan {
    /// The node in the middle.
    pub node: u32,
    pub(crate) first: u32,
    pub(crate) count: u32,
    /// Sum of the face normals weighted with their corner angles.
    pub normal: DVec3,
}

impl Fan {
    #[inline]
    pub(crate) fn of<'a>(&self, fan_corners: &'a [Corner]) -> &'a [Corner] {
        let first = self.first as usize;
        &fan_corners[first..first + self.count as usize]
    }
}

/// One corner of one triangle.
#[derive(Debug, Clone, Copy)]
pub struct Corner {
    /// Triangle number.
    pub triangle: u32,
    /// Number of the corner, 0 to 2.
    pub corner: u8,
}

/// Geometry of each triangle; its neighbours and fans are not known yet.
pub(crate) fn measure_faces(
    nodes: &[DVec3],
    triangles: &[[u32; 3]],
) -> Result<Vec<Face>, BodyError> {
    let unset = HalfEdge {
        triangle: u32::MAX,
        edge: 0,
    };
    triangles
        .iter()
        .enumerate()
        .map(|(t, triangle)| {
            let corners = triangle.map(|n| nodes[n as usize]);
            let area_vector = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let normal = area_vector
                .try_normalize()
                .ok_or_else(|| BodyError(format!("triangle {t} has no area; leave it out")))?;
            let longest = [0, 1, 2]
                .map(|k: usize| corners[k].distance_squared(corners[(k + 1) % 3]))
                .into_iter()
                .fold(0.0, f64::max);
            let inward = [0, 1, 2]
                .map(|k: usize| normal.cross((corners[(k + 1) % 3] - corners[k]).normalize()));
            Ok(Face {
                corners,
                area_vector,
                normal,
                inward,
                across: [unset; 3],
                fans: [u32::MAX; 3],
                // Differences are exact to a rounding, their products to a few (Higham 2002).
                slack: 16.0 * f64::EPSILON * (1.0 + longest / area_vector.length()),
            })
        })
        .collect()
}

/// Nearest point of a triangle by Voronoi regions (Ericson 2005, section 5.1.5).
pub(crate) fn closest_on_face(face: &Face, p: DVec3) -> ([f64; 3], DVec3) {
    let [a, b, c] = face.corners;
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return ([1.0, 0.0, 0.0], a);
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return ([0.0, 1.0, 0.0], b);
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let s = d1 / (d1 - d3);
        return ([1.0 - s, s, 0.0], a + ab * s);
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return ([0.0, 0.0, 1.0], c);
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let s = d2 / (d2 - d6);
        return ([1.0 - s, 0.0, s], a + ac * s);
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && (d4 - d3) >= 0.0 && (d5 - d6) >= 0.0 {
        let s = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return ([0.0, 1.0 - s, s], b + (c - b) * s);
    }
    // Inside by the tests above; rounding may still say a hair less than zero.
    let alpha = face.area_coordinates(p).map(|a| a.max(0.0));
    (alpha, face.at(alpha))
}
