//! Neighbours of triangles: half-edges paired across the free side, and fans around nodes.

use glam::DVec3;

use crate::body::error::BodyError;
use crate::body::face::{Corner, Face, Fan, HalfEdge};

/// All half-edges with the numbers of their nodes, the lower one first; those of one edge together.
pub(crate) fn edges_by_nodes(triangles: &[[u32; 3]]) -> Vec<((u32, u32), HalfEdge)> {
    let mut edges: Vec<((u32, u32), HalfEdge)> = (triangles.iter().enumerate())
        .flat_map(|(t, triangle)| {
            [0, 1, 2].map(|k: u8| {
                let (a, b) = edge_nodes(triangle, k);
                let half_edge = HalfEdge {
                    triangle: t as u32,
                    edge: k,
                };
                ((a.min(b), a.max(b)), half_edge)
            })
        })
        .collect();
    edges.sort_unstable_by_key(|&(nodes, h)| (nodes, h.triangle, h.edge));
    edges
}

pub(crate) fn edge_nodes(triangle: &[u32; 3], edge: u8) -> (u32, u32) {
    let k = edge as usize;
    (triangle[k], triangle[(k + 1) % 3])
}

/// Pairs the half-edges of every edge and returns the sum of normals along each.
///
/// Where more than two triangles meet, each is joined to the first one met when turning about the
/// edge from its outer side: the two then bound the same free space.
pub(crate) fn join_edges(
    triangles: &[[u32; 3]],
    faces: &mut [Face],
    edges: &[((u32, u32), HalfEdge)],
) -> Result<Vec<[DVec3; 3]>, BodyError> {
    let mut normals = vec![[DVec3::ZERO; 3]; faces.len()];
    for edge in edges.chunk_by(|a, b| a.0 == b.0) {
        let (low, high) = edge[0].0;
        let half_edges = edge.iter().map(|(_, h)| h);
        let forward = |h: &HalfEdge| edge_nodes(&triangles[h.triangle as usize], h.edge).0 == low;
        let mut opposite: Vec<HalfEdge> = half_edges
            .clone()
            .filter(|h| !forward(h))
            .copied()
            .collect();
        if low == high || opposite.len() * 2 != edge.len() {
            return Err(BodyError(format!(
                "the surface is not closed or not oriented at the edge between nodes {low} and {high}; \
                 two triangles must share each edge, in opposite directions"
            )));
        }
        for half_edge in half_edges.clone().filter(|h| forward(h)) {
            let face = &faces[half_edge.triangle as usize];
            let (x, y) = (face.inward[half_edge.edge as usize], face.normal);
            let turn = |h: &HalfEdge| {
                let w = faces[h.triangle as usize].inward[h.edge as usize];
                let angle = w.dot(y).atan2(w.dot(x));
                if angle < 0.0 {
                    angle + std::f64::consts::TAU
                } else {
                    angle
                }
            };
            let nearest = (0..opposite.len())
                .min_by(|&i, &j| turn(&opposite[i]).total_cmp(&turn(&opposite[j])))
                .expect("as many opposite half-edges as forward ones");
            let partner = opposite.swap_remove(nearest);
            faces[half_edge.triangle as usize].across[half_edge.edge as usize] = partner;
            faces[partner.triangle as usize].across[partner.edge as usize] = *half_edge;
        }
        let sum = half_edges
            .clone()
            .map(|h| faces[h.triangle as usize].normal)
            .sum();
        for h in half_edges {
            normals[h.triangle as usize][h.edge as usize] = sum;
        }
    }
    Ok(normals)
}

/// Walks around every corner over the joined edges.
pub(crate) fn gather_fans(triangles: &[[u32; 3]], faces: &mut [Face]) -> (Vec<Fan>, Vec<Corner>) {
    let mut fans = Vec::new();
    let mut fan_corners = Vec::with_capacity(3 * faces.len());
    for start in 0..faces.len() {
        for (start_corner, &node) in triangles[start].iter().enumerate() {
            if faces[start].fans[start_corner] != u32::MAX {
                continue;
            }
            let number = fans.len() as u32;
            let first = fan_corners.len() as u32;
            let mut normal = DVec3::ZERO;
            let (mut t, mut c) = (start, start_corner);
            while faces[t].fans[c] == u32::MAX {
                let face = &mut faces[t];
                face.fans[c] = number;
                let to_next = face.corners[(c + 1) % 3] - face.corners[c];
                let to_last = face.corners[(c + 2) % 3] - face.corners[c];
                normal += face.normal * to_next.angle_between(to_last);
                fan_corners.push(Corner {
                    triangle: t as u32,
                    corner: c as u8,
                });
                let next = face.across[(c + 2) % 3];
                (t, c) = (next.triangle as usize, next.edge as usize);
            }
            fans.push(Fan {
                node,
                first,
                count: fan_corners.len() as u32 - first,
                normal,
            });
        }
    }
    (fans, fan_corners)
}
