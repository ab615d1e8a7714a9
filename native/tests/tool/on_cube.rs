//! A tool on the cube.

use std::sync::Arc;

use glam::{DMat3, DVec3};
use palpate_servo::body::compliance::{Compliance, Dense, Either};
use palpate_servo::body::surface::Body;
use palpate_servo::engine::lone::LoneTool;
use palpate_servo::tool::near_field::{NearField, NodeField, PointField};
use palpate_servo::tool::points::{Point, ToolSurface};
use palpate_servo::tool::shape::{Pose, Tool};

pub const MODULUS: f64 = 1e4;
pub const TOP: f64 = 0.05;
/// Where paths begin and end, above where they press: clear of the body, however turned.
pub const LIFT: f64 = 0.01;

pub fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose {
        position: DVec3::new(x, y, z),
        rotation: DMat3::IDENTITY,
    }
}

/// A lattice of `parts` parts an edge on every triangle of the body; shared places once.
pub fn surface(body: &Arc<Body>, parts: u32) -> Arc<ToolSurface> {
    let mut points: Vec<Point> = Vec::new();
    let mut faces: Vec<Vec<DVec3>> = Vec::new();
    for (t, &nodes) in body.triangles.iter().enumerate() {
        let face = body.face(t as u32);
        for i in 0..=parts {
            for j in 0..=parts - i {
                let alpha = [i, j, parts - i - j].map(|k| f64::from(k) / f64::from(parts));
                let position = face.at(alpha);
                let same = |p: &Point| p.position.distance(position) < 1e-9;
                if let Some(known) = points.iter().position(same) {
                    faces[known].push(face.normal);
                } else {
                    faces.push(vec![face.normal]);
                    points.push(Point {
                        position,
                        normal: face.normal,
                        nodes,
                        alpha,
                        area: face.area_vector.length() / 2.0,
                    });
                }
            }
        }
    }
    for (point, faces) in points.iter_mut().zip(&faces) {
        point.normal = faces.iter().sum::<DVec3>().normalize();
    }
    let near = own_parts(body, &points);
    Arc::new(ToolSurface::new(body.clone(), points, Some(near)).expect("sound"))
}

/// No half-space, but something of its own for each point, so that they are more than the nodes.
pub fn own_parts(body: &Body, points: &[Point]) -> NearField {
    let node = NodeField {
        normal: DVec3::Z,
        edge: 0.0125,
        softness: 1.0,
        ..NodeField::default()
    };
    let point = PointField {
        share: 0.0,
        softness: 1.0,
        own: DMat3::from_diagonal(DVec3::splat(150.0)),
    };
    NearField {
        nodes: vec![node; body.nodes.len()],
        points: vec![point; points.len()],
        lifts: Vec::new(),
        believed: [0.6, 1.0],
        short: [2.2, 4.4],
        poisson_ratio: 0.3,
    }
}

/// The cube, pinned below, giving way about as rubber does: less the farther away.
pub fn rubber_cube() -> Arc<Body> {
    rubber_cube_at(|node| node)
}

/// The same elsewhere: by a rigid move.
pub fn rubber_cube_at(moved: impl Fn(DVec3) -> DVec3) -> Arc<Body> {
    let cube = crate::bodies::cube();
    let free: Vec<u32> = (0..cube.nodes.len() as u32)
        .filter(|&node| cube.nodes[node as usize].z > 1e-9)
        .collect();
    let between = |a: u32, b: u32| {
        let apart = cube.nodes[a as usize].distance_squared(cube.nodes[b as usize]);
        0.3 / (apart + 0.006_f64.powi(2)).sqrt()
    };
    let mut table = Vec::new();
    for &loaded in &free {
        for axis in DVec3::AXES {
            let column = |&moved: &u32| (axis * between(moved, loaded)).to_array();
            table.extend(free.iter().flat_map(column));
        }
    }
    let compliance = Dense::new(free.len(), Either::Long(table.into())).expect("n x 3 x 3n");
    let own = DMat3::from_diagonal(DVec3::splat(1.0 / between(0, 0)));
    let blocks = vec![own; cube.nodes.len()];
    let nodes = cube.nodes.iter().map(|&node| moved(node)).collect();
    let body = Body::new(nodes, cube.triangles.clone(), blocks).expect("sound");
    let compliance = Arc::new(Compliance::Dense(compliance));
    Arc::new((body.with_whole_compliance(compliance, &free)).expect("it fits"))
}

pub fn sphere(radius: f64) -> Tool {
    Tool::new(&[DVec3::ZERO], radius).expect("sound")
}

pub fn plate(half: f64, rounding: f64) -> Tool {
    let corner = |k: i32| {
        let side = |bit: i32| f64::from(k >> bit & 1) * 2.0 - 1.0;
        DVec3::new(
            side(0) * half,
            side(1) * half,
            rounding + half * f64::from(k >> 2),
        )
    };
    Tool::new(&[0, 1, 2, 3, 4, 5, 6, 7].map(corner), rounding).expect("sound")
}

pub fn on_cube(tool: Tool, parts: u32) -> LoneTool {
    LoneTool::new(surface(&rubber_cube(), parts), tool)
}

pub fn force(contact: &mut LoneTool, pose: &Pose) -> DVec3 {
    let felt = contact.follow(pose, MODULUS).expect("numbers");
    felt.force
}
