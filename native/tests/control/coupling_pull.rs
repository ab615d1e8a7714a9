//! The coupling in three dimensions: what it adds to a body's force never draws the finger in.

use glam::{DMat3, DVec3};
use palpate_servo::control::coupling::{Contact, Coupler, Coupling};

/// Softer along one slanted direction than along the others, N/m.
fn slanted() -> DMat3 {
    let soft = DVec3::new(1.0, 0.5, 1.0).normalize();
    let along = DMat3::from_cols(soft * soft.x, soft * soft.y, soft * soft.z);
    DMat3::IDENTITY * 600.0 - along * 500.0
}

#[test]
fn no_motion_makes_the_force_pull() {
    let stiffness = slanted();
    for limit in [f64::INFINITY, 800.0, 200.0] {
        let coupling = Coupling {
            stiffness: limit,
            damping: if limit.is_finite() {
                limit * 0.005
            } else {
                0.0
            },
            passivity_control: true,
        };
        let mut coupler = Coupler::default();
        let mut across = 0.0_f64;
        for tick in 0..4000 {
            let t = f64::from(tick) * 1e-3;
            let displacement = DVec3::new(
                1e-3 * (190.0 * t).sin(),
                1e-3 * (233.0 * t).cos(),
                -2e-3 + 1.8e-3 * (277.0 * t).sin(),
            );
            let contact = Contact {
                stiffness,
                displacement,
                force: -(stiffness * displacement),
            };
            let force = coupler.couple(&contact, &coupling, 1.0, 1e-3).force;
            coupler.sent(force);
            assert!(
                force.dot(displacement) <= 1e-15,
                "{force} over {displacement}"
            );
            across = across.max(force.cross(displacement).length() / displacement.length());
        }
        assert!(across > 0.1, "the motion was no trial");
    }
}
