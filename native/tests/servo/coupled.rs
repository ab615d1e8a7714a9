//! The coupling inside whole ticks: for devices with motors alone, and what is seen is what is felt.

use crate::scripted::{ABOVE, PRESSED, Table, probe, settings_of};
use glam::DVec3;
use palpate_servo::control::coupling::Coupling;
use palpate_servo::device::{DeviceFrame, Probe, Reading};
use palpate_servo::servo::settings::FingerSettings;
use palpate_servo::servo::snapshot::Snapshot;

const SOFT: Coupling = Coupling {
    stiffness: 50.0,
    damping: 0.0,
    passivity_control: false,
};

fn pressed_with(coupling: Coupling, scale: f64, max_force: f64) -> Snapshot {
    let mut table = Table::pressing();
    table.settings.write(settings_of(FingerSettings {
        coupling,
        frame: DeviceFrame {
            scale,
            ..DeviceFrame::default()
        },
        ..FingerSettings::default()
    }));
    let reading = Reading::At(Probe {
        max_force,
        ..probe(PRESSED)
    });
    (0..20).map(|_| table.tick(reading)).last().unwrap()
}

#[test]
fn a_motor_feels_no_more_than_the_limit_and_the_surface_shown_belongs_to_it() {
    let shot = pressed_with(SOFT, 1.0, 3.0);
    let depth = shot.probe.distance(shot.proxy);
    assert!(shot.contact_force.length() > 100.0 * depth);
    assert!(shot.output_force.length() <= 50.0 * depth * (1.0 + 1e-9));
    assert!(shot.output_force.length() > 0.2 * 50.0 * depth);
    let nodal: DVec3 = shot.nodal_forces.iter().sum();
    assert!((nodal + shot.output_force).length() < 1e-9);
}

#[test]
fn a_pointer_feels_the_body_itself() {
    let shot = pressed_with(SOFT, 1.0, f64::INFINITY);
    let nodal: DVec3 = shot.nodal_forces.iter().sum();
    assert!((nodal + shot.contact_force).length() < 1e-12);
    assert_eq!(shot.output_force, shot.contact_force);
}

#[test]
fn motion_that_is_scaled_up_scales_the_limit_down() {
    let shot = pressed_with(SOFT, 4.0, 3.0);
    let depth = shot.probe.distance(shot.proxy);
    assert!(shot.output_force.length() <= 50.0 / 4.0 * depth * (1.0 + 1e-9));
}

#[test]
fn damping_ends_with_the_touch() {
    let mut table = Table::pressing();
    table.settings.write(settings_of(FingerSettings {
        coupling: Coupling::for_devices(1000),
        ..FingerSettings::default()
    }));
    let step = DVec3::Z * -2e-4;
    let mut most = 0.0_f64;
    for tick in 0..10 {
        let shot = table.tick(Reading::At(probe(PRESSED + step * f64::from(tick))));
        most = most.max(shot.output_force.length() / shot.contact_force.length());
    }
    assert!(most > 1.05, "{most}");
    let shot = table.tick(Reading::At(probe(ABOVE)));
    assert_eq!(shot.output_force, DVec3::ZERO);
}
