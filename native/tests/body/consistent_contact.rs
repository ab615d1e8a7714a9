//! Consistent contact: the contact point moves by exactly the finger's displacement, alike on both
//! sides of an edge, and as (9) at nodes.

use crate::bodies::Dice;
use glam::DVec3;
use palpate_servo::body::surface::Body;
use palpate_servo::contact::touch::{ContactMode, contact_stiffness, surface_displacement, touch};

use ContactMode::{Consistent, Paper};

fn is_free(body: &Body, triangle: u32) -> bool {
    let lowest = |node: u32| body.nodes[node as usize].z < 1e-9;
    !body.triangles[triangle as usize].into_iter().any(lowest)
}

fn inside(dice: &mut Dice) -> [f64; 3] {
    let (a, b) = (dice.unit(), dice.unit());
    [a.min(b), (a - b).abs(), 1.0 - a.max(b)]
}

#[test]
fn the_contact_point_goes_where_the_finger_is_and_in_the_paper_it_does_not() {
    let body = crate::bodies::elastic_cube();
    let mut dice = Dice::new(5);
    let mut short_of = 0;
    for triangle in (0..body.triangles.len() as u32).filter(|&t| is_free(&body, t)) {
        let (alpha, u) = (inside(&mut dice), dice.direction() * 1e-3);
        let moved = |mode| {
            let forces = touch(&body, mode, triangle, alpha, u, 1e4).nodal_forces;
            surface_displacement(&body, triangle, alpha, &forces, 1e4).expect("it knows")
        };
        assert!(moved(Consistent).distance(u) < 1e-15, "{triangle}");
        short_of += u32::from(moved(Paper).distance(u) > 1e-5);
    }
    assert!(short_of > 100, "{short_of}");
}

#[test]
fn no_other_forces_on_the_nodes_that_do_so_take_less_energy() {
    let body = crate::bodies::elastic_cube();
    let mut dice = Dice::new(6);
    for triangle in (0..body.triangles.len() as u32).filter(|&t| is_free(&body, t)) {
        let (alpha, u) = (inside(&mut dice), dice.direction() * 1e-3);
        let forces = touch(&body, Consistent, triangle, alpha, u, 1.0).nodal_forces;
        let energy = |forces: &[DVec3; 3]| -> f64 {
            let corner = |k: usize| {
                let at = [0, 1, 2].map(|l| f64::from(u8::from(k == l)));
                surface_displacement(&body, triangle, at, forces, 1.0).expect("it knows")
            };
            [0, 1, 2]
                .map(|k| 0.5 * forces[k].dot(corner(k)))
                .iter()
                .sum()
        };
        // A change of the forces that leaves the contact point where it is.
        let extra = [0, 1, 2].map(|_| dice.direction() * 1e-4 * forces[0].length());
        let moved = surface_displacement(&body, triangle, alpha, &extra, 1.0).expect("it knows");
        let back = touch(&body, Consistent, triangle, alpha, moved, 1.0).nodal_forces;
        let other = [0, 1, 2].map(|k| forces[k] + extra[k] - back[k]);
        assert!(energy(&other) > energy(&forces), "{triangle}");
    }
}

#[test]
fn both_triangles_of_an_edge_feel_the_same_and_a_node_as_if_alone() {
    let body = crate::bodies::elastic_cube();
    let mut dice = Dice::new(7);
    for triangle in 0..body.triangles.len() as u32 {
        let u = dice.direction() * 1e-3;
        for edge in 0..3 {
            let across = body.face(triangle).across[edge];
            let part = dice.unit();
            let (mut here, mut there) = ([0.0; 3], [0.0; 3]);
            (here[edge], here[(edge + 1) % 3]) = (1.0 - part, part);
            let other = across.edge as usize;
            (there[other], there[(other + 1) % 3]) = (part, 1.0 - part);
            let one = touch(&body, Consistent, triangle, here, u, 1e4).force;
            let two = touch(&body, Consistent, across.triangle, there, u, 1e4).force;
            assert!(one.distance(two) <= 1e-13 * one.length());
        }
        for corner in 0..3 {
            let at = [0, 1, 2].map(|k| f64::from(u8::from(k == corner)));
            let [one, two] = ContactMode::ALL.map(|mode| touch(&body, mode, triangle, at, u, 1e4));
            assert!(one.force.distance(two.force) <= 1e-12 * one.force.length());
        }
    }
}

#[test]
fn the_stiffness_is_symmetric_and_positive_also_at_pinned_nodes() {
    let body = crate::bodies::elastic_cube();
    let mut dice = Dice::new(8);
    for triangle in 0..body.triangles.len() as u32 {
        let stiffness = contact_stiffness(&body, Consistent, triangle, inside(&mut dice));
        let skew = stiffness - stiffness.transpose();
        assert!(skew.abs_diff_eq(glam::DMat3::ZERO, 1e-15));
        for _ in 0..10 {
            let way = dice.direction();
            assert!(way.dot(stiffness * way) > 0.0);
        }
    }
}

#[test]
fn without_a_compliance_both_modes_are_the_papers() {
    let body = crate::bodies::cube();
    let alpha = [0.2, 0.3, 0.5];
    let [one, two] = ContactMode::ALL.map(|mode| touch(&body, mode, 3, alpha, DVec3::ONE, 1e4));
    assert_eq!(one, two);
}
