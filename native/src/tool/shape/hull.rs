//! The convex hull of a few points: its faces, and the signed distance to it.

use std::fmt;

use glam::DVec3;

/// Points that all lie closer to one plane (line) than this share of their extent span no more.
const FLATNESS: f64 = 1e-6;
/// Points of a solid closer to the plane of a side than this share of their extent lie in it.
const THICKNESS: f64 = 1e-9;

/// Why points make no tool.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct HullError(pub String);

impl fmt::Display for HullError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for HullError {}

/// A side of the hull: a convex polygon.
#[derive(Debug, Clone)]
struct Face {
    normal: DVec3,
    /// Height of the plane along the normal.
    offset: f64,
    /// Counter-clockwise seen from outside.
    corners: Vec<DVec3>,
}

/// As many dimensions as the points span.
#[derive(Debug, Clone)]
enum Form {
    Point(DVec3),
    Segment(DVec3, DVec3),
    /// Both sides of a flat polygon, or all sides of a solid.
    Faces(Vec<Face>),
}

/// A convex hull.
#[derive(Debug, Clone)]
pub struct Hull {
    form: Form,
    /// A direction across a hull without volume, towards -z.
    across: DVec3,
    is_solid: bool,
}

impl Hull {
    /// The hull of at least one and at most 64 finite points.
    pub fn new(points: &[DVec3]) -> Self {
        let (first, far) = (points[0], farthest(points, |p| p.distance(points[0])));
        let length = far.distance(first);
        if length == 0.0 {
            return Self::without_volume(Form::Point(first), DVec3::NEG_Z);
        }
        let along = (far - first) / length;
        let off_line = |p: DVec3| (p - first).reject_from_normalized(along).length();
        let aside = farthest(points, off_line);
        if off_line(aside) <= FLATNESS * length {
            let at = |p: DVec3| (p - first).dot(along);
            let low = farthest(points, |p| -at(p));
            let form = Form::Segment(low, farthest(points, at));
            let down = DVec3::NEG_Z.reject_from_normalized(along);
            let across = down.try_normalize().unwrap_or(DVec3::NEG_X);
            return Self::without_volume(form, across);
        }
        let normal = along.cross(aside - first).normalize();
        let off_plane = |p: DVec3| (p - first).dot(normal).abs();
        let is_flat = off_plane(farthest(points, off_plane)) <= FLATNESS * length;
        if is_flat {
            let across = if normal.z > 0.0 { -normal } else { normal };
            let face = |n: DVec3| Face {
                normal: n,
                offset: n.dot(first),
                corners: outline(points, n),
            };
            return Self::without_volume(Form::Faces(vec![face(across), face(-across)]), across);
        }
        Self {
            form: Form::Faces(sides(points, THICKNESS * length)),
            across: DVec3::NEG_Z,
            is_solid: true,
        }
    }

    const fn without_volume(form: Form, across: DVec3) -> Self {
        Self {
            form,
            across,
            is_solid: false,
        }
    }

    /// How deep a point lies inside, m; zero outside and in a hull without volume.
    pub fn depth(&self, point: DVec3) -> f64 {
        match &self.form {
            Form::Faces(faces) if self.is_solid => {
                let height = |face: &Face| face.normal.dot(point) - face.offset;
                (-faces.iter().map(height).fold(f64::NEG_INFINITY, f64::max)).max(0.0)
            }
            _ => 0.0,
        }
    }

    /// Faces, none of a point or a segment.
    #[inline]
    pub fn face_count(&self) -> usize {
        match &self.form {
            Form::Faces(faces) => faces.len(),
            Form::Point(_) | Form::Segment(..) => 0,
        }
    }

    /// Signed distance, negative inside, and the outward unit normal; closer than `clear` the normal
    /// is a face's own.
    #[inline]
    pub fn distance(&self, point: DVec3, clear: f64) -> (f64, DVec3) {
        match &self.form {
            Form::Point(core) => away(point - *core, clear, self.across),
            Form::Segment(a, b) => away(point - on_segment(*a, *b, point), clear, self.across),
            Form::Faces(faces) => self.distance_to(faces, point, clear),
        }
    }

    fn distance_to(&self, faces: &[Face], point: DVec3, clear: f64) -> (f64, DVec3) {
        let (mut height, mut highest) = (f64::NEG_INFINITY, self.across);
        let (mut distance, mut offset) = (f64::INFINITY, DVec3::ZERO);
        for face in faces {
            let above = face.normal.dot(point) - face.offset;
            if above > height {
                (height, highest) = (above, face.normal);
            }
            // No edge of a face is nearer than its plane.
            if above < 0.0 || above * above >= distance {
                continue;
            }
            match face.nearest_on_outline(point) {
                // The closest point of a convex body lies straight below a point of its own face.
                None => return (above, face.normal),
                Some(place) if place.distance_squared(point) < distance => {
                    offset = point - place;
                    distance = offset.length_squared();
                }
                Some(_) => {}
            }
        }
        if height < 0.0 {
            return (height, highest);
        }
        away(offset, clear, highest)
    }
}

/// Length and direction; a direction of its own where there is hardly any length.
#[inline]
fn away(offset: DVec3, clear: f64, fallback: DVec3) -> (f64, DVec3) {
    let distance = offset.length();
    if distance > clear {
        (distance, offset / distance)
    } else {
        (distance, fallback)
    }
}

#[inline]
fn on_segment(a: DVec3, b: DVec3, point: DVec3) -> DVec3 {
    let along = b - a;
    let share = (point - a).dot(along) / along.length_squared();
    a + along * share.clamp(0.0, 1.0)
}

impl Face {
    /// The nearest place of the outline, `None` for a point straight above the face.
    #[inline]
    fn nearest_on_outline(&self, point: DVec3) -> Option<DVec3> {
        let mut nearest: Option<(f64, DVec3)> = None;
        let mut before = self.corners[self.corners.len() - 1];
        for &corner in &self.corners {
            // Beyond an edge: the closest place may be on it.
            if (corner - before).cross(point - before).dot(self.normal) < 0.0 {
                let place = on_segment(before, corner, point);
                let distance = place.distance_squared(point);
                if nearest.is_none_or(|(least, _)| distance < least) {
                    nearest = Some((distance, place));
                }
            }
            before = corner;
        }
        nearest.map(|(_, place)| place)
    }
}

fn farthest(points: &[DVec3], measure: impl Fn(DVec3) -> f64) -> DVec3 {
    let of = |p: &&DVec3| measure(**p);
    *(points.iter())
        .max_by(|a, b| of(a).total_cmp(&of(b)))
        .expect("there is a point")
}

/// Every plane through three points that has all others on one side, with its polygon.
fn sides(points: &[DVec3], thickness: f64) -> Vec<Face> {
    let mut found: Vec<(u64, f64, DVec3)> = Vec::new();
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate().skip(i + 1) {
            for &c in &points[j + 1..] {
                let normal = (b - a).cross(c - a);
                // Three points in a line have no plane: others of the same face have.
                let longest = (b - a).length_squared().max((c - a).length_squared());
                let area = normal.length();
                if area <= FLATNESS * longest {
                    continue;
                }
                for normal in [normal / area, -normal / area] {
                    let height = |p: &DVec3| (*p - a).dot(normal);
                    if points.iter().all(|p| height(p) <= thickness) {
                        let in_it = (points.iter().enumerate())
                            .filter(|(_, p)| height(p) >= -thickness)
                            .fold(0_u64, |mask, (k, _)| mask | 1 << k);
                        found.push((in_it, area, normal));
                    }
                }
            }
        }
    }
    // Of planes through the same points one: with most points in it, from those farthest apart.
    found.sort_by(|(p, area, _), (q, other, _)| {
        (q.count_ones().cmp(&p.count_ones())).then(other.total_cmp(area))
    });
    let mut kept: Vec<(u64, DVec3)> = Vec::new();
    for (in_it, _, normal) in found {
        if !(kept.iter()).any(|&(other, n)| other & in_it == in_it && n.dot(normal) > 0.0) {
            kept.push((in_it, normal));
        }
    }
    (kept.into_iter())
        .map(|(in_it, normal)| {
            let members: Vec<DVec3> = (points.iter().enumerate())
                .filter(|(k, _)| in_it >> k & 1 == 1)
                .map(|(_, &p)| p)
                .collect();
            Face {
                normal,
                offset: (members.iter()).fold(f64::NEG_INFINITY, |h, p| h.max(p.dot(normal))),
                corners: outline(&members, normal),
            }
        })
        .collect()
}

/// The convex outline of points in a plane, counter-clockwise seen against its normal.
fn outline(points: &[DVec3], normal: DVec3) -> Vec<DVec3> {
    let u = normal.any_orthonormal_vector();
    let v = normal.cross(u);
    let mut order: Vec<DVec3> = points.to_vec();
    let at = |p: DVec3| (p.dot(u), p.dot(v));
    order.sort_by(|&p, &q| {
        let ((a, b), (c, d)) = (at(p), at(q));
        a.total_cmp(&c).then(b.total_cmp(&d))
    });
    // Monotone chain (Andrew 1979): below from left to right, above from right to left.
    let chain = |order: &mut dyn Iterator<Item = DVec3>| {
        let mut chain: Vec<DVec3> = Vec::new();
        for p in order {
            while let [.., a, b] = chain[..] {
                if (b - a).cross(p - b).dot(normal) > 0.0 {
                    break;
                }
                chain.pop();
            }
            chain.push(p);
        }
        chain.pop();
        chain
    };
    let mut corners = chain(&mut order.iter().copied());
    corners.extend(chain(&mut order.iter().rev().copied()));
    corners
}
