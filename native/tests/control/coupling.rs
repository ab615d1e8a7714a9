//! The coupling: what the device may see of a body, nothing where nothing is due, and no energy.

use crate::bodies::Dice;
use glam::{DMat3, DVec3};
use palpate_servo::contact::touch::{ContactMode, contact_stiffness, touch};
use palpate_servo::control::coupling::{Contact, Coupled, Coupler, Coupling, series_compliance};

const DT: f64 = 1e-3;
const LIMITED: Coupling = Coupling {
    stiffness: 800.0,
    damping: 0.0,
    passivity_control: false,
};

/// Q diag(eigenvalues) Q^T for a random rotation.
fn symmetric(dice: &mut Dice, eigenvalues: DVec3) -> DMat3 {
    turned(dice, eigenvalues).0
}

/// The same, and its third eigenvector.
fn turned(dice: &mut Dice, eigenvalues: DVec3) -> (DMat3, DVec3) {
    let axis = dice.direction();
    let turn = DMat3::from_axis_angle(axis, dice.within(0.0, 3.0));
    let matrix = turn * DMat3::from_diagonal(eigenvalues) * turn.transpose();
    (matrix, turn.z_axis)
}

fn contact(stiffness: DMat3, displacement: DVec3) -> Contact {
    Contact {
        stiffness,
        displacement,
        force: -(stiffness * displacement),
    }
}

fn once(contact: &Contact, coupling: &Coupling, scale: f64) -> Coupled {
    Coupler::default().couple(contact, coupling, scale, DT)
}

#[test]
fn without_a_limit_the_force_is_the_bodys_to_the_bit() {
    let mut dice = Dice::new(1);
    for _ in 0..1000 {
        let stiffness = symmetric(&mut dice, DVec3::new(50.0, 3e3, 7e5));
        let touched = contact(stiffness, dice.direction() * 0.004);
        let coupled = once(&touched, &Coupling::default(), 1.0);
        assert_eq!(coupled.force, touched.force);
        assert_eq!(coupled.body_displacement, touched.displacement);
    }
}

#[test]
fn a_body_softer_than_the_limit_is_felt_as_it_is() {
    let mut dice = Dice::new(2);
    for _ in 0..1000 {
        let stiffness = symmetric(&mut dice, DVec3::new(50.0, 300.0, 799.0));
        let touched = contact(stiffness, dice.direction() * 0.004);
        assert_eq!(once(&touched, &LIMITED, 1.0).force, touched.force);
    }
}

#[test]
fn nothing_is_stiffer_than_the_limit_and_the_stiffest_direction_reaches_it() {
    let mut dice = Dice::new(3);
    for _ in 0..1000 {
        let largest = dice.within(801.0, 1e7);
        let others = DVec3::new(
            dice.within(1.0, largest),
            dice.within(1.0, largest),
            largest,
        );
        let (stiffness, stiffest) = turned(&mut dice, others);
        let compliance = series_compliance(&stiffness, 800.0);
        // (K^-1 + c I)^-1, by another way than the product's.
        let seen = (stiffness.inverse() + DMat3::IDENTITY * compliance).inverse();
        for _ in 0..20 {
            let u = dice.direction() * 0.002;
            let coupled = once(&contact(stiffness, u), &LIMITED, 1.0);
            assert!(coupled.force.distance(-(seen * u)) < 1e-6 * coupled.force.length());
            assert!(coupled.force.length() <= 800.0 * u.length() * (1.0 + 1e-6));
        }
        let most = once(&contact(stiffness, stiffest * 0.002), &LIMITED, 1.0);
        assert!((most.force.length() / 1.6 - 1.0).abs() < 1e-6, "{most:?}");
    }
}

#[test]
fn on_a_rigid_body_the_spring_alone_is_left() {
    let rigid = DMat3::from_diagonal(DVec3::splat(1e12));
    let u = DVec3::new(0.001, -0.002, 0.0005);
    let coupled = once(&contact(rigid, u), &LIMITED, 1.0);
    assert!(coupled.force.distance(u * -800.0) < 1e-6);
    assert!(coupled.body_displacement.length() < 1e-8);
}

#[test]
fn a_scaled_device_sees_no_more_than_the_limit() {
    let stiff = DMat3::from_diagonal(DVec3::splat(5e3));
    for scale in [0.1, 1.0, 4.0] {
        // A millimetre of the device.
        let coupled = once(&contact(stiff, DVec3::X * 1e-3 * scale), &LIMITED, scale);
        let seen = coupled.force.length() / 1e-3;
        assert!(
            (seen - (5e3 * scale).min(800.0)).abs() < 1e-6,
            "{scale}: {seen}"
        );
    }
}

#[test]
fn the_stiffness_is_the_one_of_the_touch() {
    let body = crate::bodies::elastic_cube();
    let mut dice = Dice::new(4);
    for mode in ContactMode::ALL {
        for triangle in 0..body.triangles.len() as u32 {
            let (a, b) = (dice.unit(), dice.unit());
            let alpha = [a * b, a * (1.0 - b), 1.0 - a];
            let u = dice.direction() * 0.003;
            let felt = touch(&body, mode, triangle, alpha, u, 1e4).force;
            let stiffness = contact_stiffness(&body, mode, triangle, alpha) * 1e4;
            assert!((-(stiffness * u)).distance(felt) < 1e-12);
        }
    }
}

#[test]
fn damping_is_the_velocitys_share_and_vanishes_at_rest() {
    let coupling = Coupling {
        damping: 4.0,
        ..LIMITED
    };
    let mut coupler = Coupler::default();
    let stiffness = DMat3::from_diagonal(DVec3::splat(400.0));
    let mut force = 0.0;
    for tick in 1..=100 {
        let u = DVec3::X * (1e-4 * f64::from(tick));
        force = coupler
            .couple(&contact(stiffness, u), &coupling, 1.0, DT)
            .force
            .x;
    }
    // 400 N/m at 10 mm, and 400 / 800 of 4 N s/m at 0.1 m/s.
    assert!((force + 4.0 + 0.2).abs() < 1e-9, "{force}");
    for _ in 0..100 {
        let rest = contact(stiffness, DVec3::X * 0.01);
        force = coupler.couple(&rest, &coupling, 1.0, DT).force.x;
    }
    assert!((force + 4.0).abs() < 1e-12, "{force}");
}

#[test]
fn there_is_no_force_at_first_touch_and_at_release_and_never_a_pull() {
    let coupling = Coupling::for_devices(1000);
    let stiffness = DMat3::from_diagonal(DVec3::splat(700.0));
    for speed in [0.01, 0.1, 1.0, 10.0] {
        let mut coupler = Coupler::default();
        for depth in [1e-9, 2.5e-3, 5e-3, 4e-3, 3e-3, 1e-9] {
            let u = DVec3::Z * (-depth * speed);
            let touched = contact(stiffness, u);
            let coupled = coupler.couple(&touched, &coupling, 1.0, DT);
            coupler.sent(coupled.force);
            assert!(coupled.force.z >= 0.0, "pulls at {speed} m/s, {depth}");
            assert!(coupled.force.length() <= 3.01 * touched.force.length());
        }
        coupler.release();
        let again = contact(stiffness, DVec3::Z * -1e-9);
        let coupled = coupler.couple(&again, &coupling, 1.0, DT);
        assert!(coupled.force.length() < 1e-5);
    }
}

/// Presses in and out sinusoidally; the largest difference that passivity control makes.
fn difference_by_control(stiffness: f64, speed: f64, damping: f64, encoder_step: f64) -> f64 {
    let [mut with, mut without] = [Coupler::default(); 2];
    let place = DMat3::from_diagonal(DVec3::splat(stiffness));
    let depth = 0.005;
    let ticks = (std::f64::consts::TAU * depth / 2.0 / speed / DT).round() as u32;
    let mut most = 0.0_f64;
    for tick in 1..ticks {
        let phase = f64::from(tick) / f64::from(ticks) * std::f64::consts::TAU;
        let mut u = 0.5 * depth * (1.0 - phase.cos());
        if encoder_step > 0.0 {
            u = (u / encoder_step).round() * encoder_step;
        }
        if u == 0.0 {
            continue;
        }
        let touched = contact(place, DVec3::Y * u);
        let base = Coupling {
            damping,
            ..Coupling::for_devices(1000)
        };
        let [a, b] = [(&mut with, true), (&mut without, false)].map(|(coupler, control)| {
            let coupling = Coupling {
                passivity_control: control,
                ..base
            };
            let force = coupler.couple(&touched, &coupling, 1.0, DT).force;
            coupler.sent(force);
            force
        });
        most = most.max(a.distance(b));
    }
    most
}

#[test]
fn passivity_control_leaves_slow_presses_alone_and_brakes_fast_ones() {
    let damping = Coupling::for_devices(1000).damping;
    for encoder_step in [0.0, 1e-6, 20e-6] {
        assert_eq!(difference_by_control(300.0, 0.02, 0.0, encoder_step), 0.0);
    }
    assert_eq!(difference_by_control(300.0, 0.1, damping, 0.0), 0.0);
    assert!(difference_by_control(1000.0, 0.3, 0.0, 0.0) > 0.1);
}

#[test]
fn at_rest_passivity_control_is_silent_between_two_encoder_steps() {
    let coupling = Coupling {
        damping: 0.0,
        ..Coupling::for_devices(1000)
    };
    let place = DMat3::from_diagonal(DVec3::splat(700.0));
    let mut coupler = Coupler::default();
    for tick in 0..1000 {
        // Slowly in, and there a step to and fro.
        let step = if tick < 500 || tick % 50 < 25 {
            0.0
        } else {
            20e-6
        };
        let depth = 5e-6 * f64::from((tick + 1).min(400));
        let touched = contact(place, DVec3::X * (depth + step));
        let coupled = coupler.couple(&touched, &coupling, 1.0, DT);
        coupler.sent(coupled.force);
        assert_eq!(coupled.force, touched.force, "tick {tick}");
    }
}

#[test]
fn a_new_touch_knows_nothing_of_the_last_one() {
    let coupling = Coupling::for_devices(1000);
    let place = DMat3::from_diagonal(DVec3::splat(700.0));
    let mut used = Coupler::default();
    for tick in 1..20 {
        let touched = contact(place, DVec3::X * (1e-3 * f64::from(tick)));
        let coupled = used.couple(&touched, &coupling, 1.0, DT);
        used.sent(coupled.force);
    }
    used.release();
    let touched = contact(place, DVec3::X * 2e-3);
    assert_eq!(
        used.couple(&touched, &coupling, 1.0, DT),
        once(&touched, &coupling, 1.0)
    );
}
