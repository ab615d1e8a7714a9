//! Friction under a tool.

use crate::on_cube::{MODULUS, TOP, at, force, on_cube, sphere};
use palpate_servo::engine::lone::LoneTool;
use palpate_servo::tool::coefficients::Friction;
use palpate_servo::tool::collider::NotANumber;

pub fn rubbing(sticking: f64, slipping: f64) -> Friction {
    Friction { sticking, slipping }
}

/// Force aside over push, of the point where that is most.
fn steepest(contact: &LoneTool) -> f64 {
    let pressed = contact.pressed().iter().filter(|slot| slot.push > 0.0);
    pressed.fold(0.0, |most, slot| {
        let push = slot.force.dot(slot.normal);
        let aside = (slot.force - slot.normal * push).length();
        assert!(push > 0.0, "{slot:?}");
        f64::max(most, aside / push)
    })
}

#[test]
fn friction_holds_up_to_its_limit_and_less_once_it_slips() {
    let mut contact = on_cube(sphere(0.01), 3);
    contact.set_friction(rubbing(0.6, 0.3));
    contact.restart(&at(0.025, 0.025, TOP + 0.012));
    for tick in 0..=40 {
        force(
            &mut contact,
            &at(0.025, 0.025, TOP + 0.012 - 1e-4 * f64::from(tick)),
        );
    }
    let mut drags = Vec::new();
    for tick in 0..400 {
        let x = 0.025 + 2e-5 * f64::from(tick);
        drags.push(-force(&mut contact, &at(x, 0.025, TOP + 0.008)).x);
        assert!(steepest(&contact) <= 0.6 * (1.0 + 1e-12));
    }
    let most = drags.iter().fold(0.0, |most: f64, &drag| most.max(drag));
    assert!(
        drags[20] > 5.0 * drags[1].abs() && drags[399] < 0.8 * most,
        "{drags:?}"
    );
    assert!(
        steepest(&contact) <= 0.3 * (1.0 + 1e-12) || contact.pressed().iter().any(|s| !s.slips)
    );
    // Without friction nothing of it is left.
    contact.set_friction(Friction::default());
    for _ in 0..20 {
        force(&mut contact, &at(0.033, 0.025, TOP + 0.008));
    }
    assert!(steepest(&contact) < 1e-12);
}

#[test]
fn friction_that_is_none_makes_no_force() {
    let mut contact = on_cube(sphere(0.01), 3);
    for (sticking, slipping) in [(f64::NAN, 0.1), (0.2, f64::NAN), (0.1, 0.2), (0.3, -0.1)] {
        contact.set_friction(rubbing(sticking, slipping));
        let pose = at(0.025, 0.025, TOP + 0.012);
        assert_eq!(contact.follow(&pose, MODULUS), Err(NotANumber));
    }
}

#[test]
fn points_that_stick_count_as_stiffness_aside() {
    let mut contact = on_cube(sphere(0.01), 3);
    contact.set_friction(rubbing(5.0, 5.0));
    contact.restart(&at(0.025, 0.025, TOP + 0.012));
    for tick in 0..=60 {
        let height = 0.012 - 1e-4 * f64::from(tick.min(40));
        force(&mut contact, &at(0.025, 0.025, TOP + height));
    }
    let stiffness = contact.felt().stiffness;
    let before = contact.felt().force;
    let step = 1e-5;
    for _ in 0..20 {
        force(&mut contact, &at(0.025 + step, 0.025, TOP + 0.008));
    }
    let measured = (before.x - contact.felt().force.x) / step;
    // This body gives way alike on all sides, which none does of itself: aside it is stiffer here.
    let ratio = stiffness.x_axis.x / measured;
    assert!((0.9..1.5).contains(&ratio), "{stiffness} {measured}");
}
