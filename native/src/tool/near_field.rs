//! What a force at one place of a surface moves another place by, below the fineness of the mesh.
//!
//! C(x, y) = H(x - y) + sum_ab alpha_a(x) alpha_b(y) (L_ab - T_ab), where H is a half-space and T_ab
//! what stands for it in the finite elements. Nothing of it is kept pair by pair: under a tool there
//! are a few thousand pairs, on the body hundreds of millions. Readable reference:
//! `core/contact/near_field/compliance_beneath.py`, `core/contact/near_field/regular_field.py`.

use std::f64::consts::PI;

use glam::{DMat3, DVec3};

/// Points whose normals have a smaller product than the first are not of one surface, from the
/// second on they are wholly.
const SAME_SURFACE: [f64; 2] = [-0.5, 0.0];

/// Moduli that differ by the first factor are of one material, by the second of two.
const ONE_MATERIAL: [f64; 2] = [4.0, 40.0];

/// How a surface gives way beyond what a half-space does, at one of its nodes.
#[derive(Debug, Clone, Copy, Default)]
pub struct NodeField {
    /// Unit outward normal.
    pub normal: DVec3,
    /// Length in which distances from there are told, m: that of the edges there, or somewhat more.
    pub edge: f64,
    /// 1 over the factor of Young's modulus around the node.
    pub softness: f64,
    /// What finite elements add to the coupling of pushes with displacements aside, times the
    /// distance squared, m^3/N at 1 Pa; negative where they fall short.
    pub excess: f64,
    /// How far the node gives way beyond a half-space under its own force, m/N at 1 Pa; on thin parts
    /// without what the place across from it does.
    pub regular: DMat3,
    /// How that changes per metre as the force moves away, for each axis.
    pub slope: [DMat3; 3],
    /// Corners of the triangle across the body from it.
    pub far_nodes: [u32; 3],
    /// What each counts of how the place across moves; nothing where the body is thick.
    pub far_weights: [f64; 3],
}

/// What there is to know at one contact point.
#[derive(Debug, Clone, Copy, Default)]
pub struct PointField {
    /// From 0, where plain finite elements stay, to 1.
    pub share: f64,
    /// 1 over the factor of Young's modulus there.
    pub softness: f64,
    /// What is to be added to how the finite elements let the point give way to its own force.
    pub own: DMat3,
}

/// The near field of a body, for the contact points of a tool.
#[derive(Debug, Clone)]
pub struct NearField {
    /// For each node of the surface.
    pub nodes: Vec<NodeField>,
    /// For each contact point.
    pub points: Vec<PointField>,
    /// Ways of all points, of one after the other: a force along one moves all along it, by their
    /// products, in root of m/N at 1 Pa. `core/rest/definite.py` tells what for.
    pub lifts: Vec<DVec3>,
    /// Distances in edges: within the first finite elements are not believed, from the second on
    /// they are wholly.
    pub believed: [f64; 2],
    /// Distances in edges: up to the first finite elements have the nodes' excess, from the second
    /// on none.
    pub short: [f64; 2],
    /// Of the body.
    pub poisson_ratio: f64,
}

impl NearField {
    /// Whether all numbers can be reckoned with.
    pub(super) fn is_sound(&self) -> bool {
        let node = |f: &NodeField| {
            f.normal.is_finite()
                && (f.edge > 0.0 && f.edge.is_finite())
                && f.softness.is_finite()
                && f.excess.is_finite()
                && f.regular.is_finite()
                && f.slope.iter().all(DMat3::is_finite)
                && f.far_nodes
                    .iter()
                    .all(|&node| (node as usize) < self.nodes.len())
                && f.far_weights.iter().all(|weight| weight.is_finite())
        };
        let point =
            |f: &PointField| f.share.is_finite() && f.softness.is_finite() && f.own.is_finite();
        self.nodes.iter().all(node)
            && self.points.iter().all(point)
            && self.lifts.iter().all(|way| way.is_finite())
            && 0.0 <= self.believed[0]
            && self.believed[0] < self.believed[1]
            && self.believed[1].is_finite()
            && self.short[0] < self.short[1]
            && self.short.iter().all(|limit| limit.is_finite())
            && (-1.0..=0.5).contains(&self.poisson_ratio)
    }

    /// How much two points are of one surface that is known, 0 to 1.
    #[inline]
    pub(super) fn share(&self, p: u32, q: u32, normals: [DVec3; 2]) -> f64 {
        let [low, high] = SAME_SURFACE;
        let alike = ((normals[0].dot(normals[1]) - low) / (high - low)).clamp(0.0, 1.0);
        let [one, other] = [p, q].map(|k| &self.points[k as usize]);
        one.share * other.share * alike * of_one_material(one.softness, other.softness)
    }

    /// What is added between two points, or to one and its own force, that energy is nowhere negative.
    #[inline]
    pub(super) fn lifted(&self, p: u32, q: u32) -> DMat3 {
        let ways = self.lifts.len() / self.points.len();
        let of = |point: u32| &self.lifts[point as usize * ways..][..ways];
        let mut block = DMat3::ZERO;
        for (&seen, &loaded) in of(p).iter().zip(of(q)) {
            block += DMat3::from_cols(seen * loaded.x, seen * loaded.y, seen * loaded.z);
        }
        block
    }

    /// H between two points: displacement of the first per force on the other.
    #[inline]
    pub(super) fn between_points(
        &self,
        p: u32,
        q: u32,
        offset: DVec3,
        normals: [DVec3; 2],
    ) -> DMat3 {
        let softness = [p, q].map(|k| self.points[k as usize].softness);
        self.half_space(offset, normals, softness, 0.0)
    }

    /// `L_ab - T_ab`: what the body does beyond a half-space; `resolved` tells `L` of two nodes.
    #[inline]
    pub(super) fn beyond(
        &self,
        a: u32,
        b: u32,
        offset: DVec3,
        resolved: impl Fn(u32, u32) -> DMat3,
    ) -> DMat3 {
        let [here, there] = [a, b].map(|node| &self.nodes[node as usize]);
        let apart = offset.length() / (0.5 * (here.edge + there.edge));
        let [never, wholly] = self.believed;
        let doubt = ((wholly - apart) / (wholly - never)).clamp(0.0, 1.0);
        let mut blocks = DMat3::ZERO;
        if doubt < 1.0 {
            let normals = [here.normal, there.normal];
            let softness = [here.softness, there.softness];
            let [within, nowhere] = self.short;
            let fading = ((nowhere - apart) / (nowhere - within)).clamp(0.0, 1.0);
            let excess = 0.5 * (here.excess + there.excess) * fading;
            let resembled = self.half_space(offset, normals, softness, excess);
            blocks += (resolved(a, b) - resembled) * (1.0 - doubt);
        }
        if doubt > 0.0 {
            // From a to b is against the offset.
            let sloped = |f: &NodeField, way: DVec3| {
                f.regular + f.slope[0] * way.x + f.slope[1] * way.y + f.slope[2] * way.z
            };
            let across = |f: &NodeField, loaded: u32| {
                let mut moved = DMat3::ZERO;
                for (&node, &weight) in f.far_nodes.iter().zip(&f.far_weights) {
                    if weight != 0.0 {
                        moved += resolved(node, loaded) * weight;
                    }
                }
                moved
            };
            let from_a = sloped(here, -offset) + across(here, b);
            let from_b = sloped(there, offset) + across(there, a);
            blocks += (from_a + from_b.transpose()) * (0.5 * doubt);
        }
        blocks
    }

    /// Boussinesq's and Cerruti's displacement at `offset` from the force, m/N at 1 Pa, with what is
    /// added to its coupling, times the distance squared.
    #[inline]
    fn half_space(
        &self,
        offset: DVec3,
        normals: [DVec3; 2],
        softness: [f64; 2],
        excess: f64,
    ) -> DMat3 {
        let sum = normals[0] + normals[1];
        let normal = sum / sum.length().max(0.5);
        let nu = self.poisson_ratio;
        let inverse = offset.length_recip();
        let along = offset * inverse;
        let scale = (1.0 + nu) / PI * inverse * (softness[0] * softness[1]).sqrt();
        let coupling = 0.5 - nu + excess * inverse * inverse / scale;
        let column = |axis: usize| {
            let (e, n) = (along[axis], normal[axis]);
            let mut column = along * (nu * e + coupling * n) - normal * (coupling * e);
            column[axis] += 1.0 - nu;
            column
        };
        DMat3::from_cols(column(0), column(1), column(2)) * scale
    }
}

/// How much two points are of one material, 0 to 1: across a bone's border in flesh there is no half-space.
#[inline]
fn of_one_material(one: f64, other: f64) -> f64 {
    if one == other {
        return 1.0;
    }
    let [alike, apart] = ONE_MATERIAL.map(f64::ln);
    ((apart - (one / other).ln().abs()) / (apart - alike)).clamp(0.0, 1.0)
}
