//! Whole ticks with a scripted device: what goes wrong gives zero force, a name, and a ramp.

use std::sync::{Arc, Mutex};

use crate::scripted::{ABOVE, DT, OPTIONS, PRESSED, Scripted, Table, probe, settings, settings_of};
use glam::{DMat3, DVec3};
use palpate_servo::control::coupling::Coupling;
use palpate_servo::control::safety::Limits;
use palpate_servo::device::reason;
use palpate_servo::device::{DeviceFrame, Fault, Probe, Reading};
use palpate_servo::proxy::Feel;
use palpate_servo::servo::settings::FingerSettings;
use palpate_servo::servo::settings::{Options, Settings};
use palpate_servo::servo::snapshot::State;
use palpate_servo::servo::thread::Running;

#[test]
fn numbers_of_the_probe_that_are_none_give_no_force() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for axis in 0..3 {
            let mut position = PRESSED;
            position[axis] = bad;
            let reading = Reading::At(probe(position));
            Table::pressing().silences(reading, State::Fault, Some(Fault::Nan));
        }
        let speed = Reading::At(Probe {
            speed: bad,
            ..probe(PRESSED)
        });
        Table::pressing().silences(speed, State::Fault, Some(Fault::Nan));
    }
}

#[test]
fn a_largest_force_of_the_device_that_is_none_gives_no_force() {
    for max_force in [f64::NAN, -1.0, f64::NEG_INFINITY] {
        let reading = Reading::At(Probe {
            max_force,
            ..probe(PRESSED)
        });
        Table::pressing().silences(reading, State::Fault, Some(Fault::Nan));
    }
}

#[test]
fn settings_that_are_no_numbers_give_no_force() {
    let coupling = Coupling {
        stiffness: 500.0,
        damping: 1.0,
        passivity_control: true,
    };
    let moduli = [f64::NAN, f64::INFINITY, 0.0, -1.0].map(|young_modulus| Settings {
        young_modulus,
        ..settings_of(FingerSettings {
            coupling,
            ..FingerSettings::default()
        })
    });
    let frames = [f64::NAN, f64::INFINITY].map(|bad| {
        settings_of(FingerSettings {
            frame: DeviceFrame {
                rotation: DMat3::from_diagonal(DVec3::new(1.0, bad, 1.0)),
                ..DeviceFrame::default()
            },
            ..FingerSettings::default()
        })
    });
    for bad in moduli.into_iter().chain(frames) {
        let mut table = Table::pressing();
        table.settings.write(bad);
        // The scripted device knows no frame: what a device would make of it.
        let shot = table.tick(Reading::At(probe(bad.fingers[0].frame.to_body(PRESSED))));
        assert_eq!((shot.state, shot.fault), (State::Fault, Some(Fault::Nan)));
        table.is_silent(&shot);
        table.settings.write(settings());
        assert_eq!(table.ramps(), "after nan");
    }
}

#[test]
fn friction_that_is_no_number_gives_no_force_or_the_bodys_own() {
    for bad in [f64::NAN, f64::INFINITY] {
        let mut table = Table::pressing();
        table.settings.write(Settings {
            feel: Feel {
                static_friction: bad,
                dynamic_friction: bad,
                ..Feel::default()
            },
            ..settings()
        });
        for _ in 0..20 {
            let shot = table.press();
            assert!(shot.output_force.is_finite());
            assert!(shot.output_force.length() <= 3.0);
        }
    }
}

#[test]
fn a_coupling_that_is_no_number_gives_no_force_or_the_bodys_own() {
    for bad in [f64::NAN, f64::INFINITY, -1.0, 0.0] {
        for (stiffness, damping) in [(bad, 0.0), (500.0, bad), (bad, bad)] {
            let mut table = Table::pressing();
            table.settings.write(settings_of(FingerSettings {
                coupling: Coupling {
                    stiffness,
                    damping,
                    passivity_control: true,
                },
                ..FingerSettings::default()
            }));
            for deeper in 0..20 {
                let position = PRESSED - DVec3::Z * 1e-4 * f64::from(deeper);
                let shot = table.tick(Reading::At(probe(position)));
                assert!(shot.output_force.is_finite());
                assert!(shot.output_force.length() <= 3.0 * (1.0 + 1e-12));
            }
        }
    }
}

#[test]
fn limits_that_are_no_numbers_give_no_force() {
    let limits = |edit: fn(&mut Limits)| {
        let mut options = OPTIONS;
        edit(&mut options.limits);
        options
    };
    let speed = Options {
        max_speed: f64::NAN,
        ..OPTIONS
    };
    // A rate of zero makes the time between ticks infinite.
    let rate = Options {
        rate_hz: 0,
        ..OPTIONS
    };
    for options in [
        limits(|l| l.max_force = f64::NAN),
        limits(|l| l.max_slew = f64::NAN),
        limits(|l| l.ramp_seconds = f64::NAN),
        limits(|l| l.max_force = -1.0),
        speed,
        rate,
    ] {
        let mut table = Table::new(crate::bodies::cube(), options);
        table.tick(Reading::At(probe(ABOVE)));
        for _ in 0..10 {
            let shot = table.press();
            assert_eq!(
                (shot.state, shot.fault),
                (State::Fault, Some(Fault::Nan)),
                "{options:?}"
            );
            table.is_silent(&shot);
        }
    }
}

#[test]
fn contact_blocks_that_are_no_numbers_are_refused_and_too_large_ones_give_no_force() {
    let cube = crate::bodies::cube();
    let with = |value: f64| {
        let blocks = vec![DMat3::from_diagonal(DVec3::splat(value)); cube.nodes.len()];
        palpate_servo::body::surface::Body::new(cube.nodes.clone(), cube.triangles.clone(), blocks)
    };
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(with(bad).is_err());
    }
    let huge = Arc::new(with(1e308).expect("finite"));
    let mut table = Table::new(huge, OPTIONS);
    table.tick(Reading::At(probe(ABOVE)));
    let shot = table.press();
    assert_eq!((shot.state, shot.fault), (State::Fault, Some(Fault::Nan)));
    table.is_silent(&shot);
}

#[test]
fn what_the_device_reports_gives_no_force() {
    for fault in [
        Fault::Stale,
        Fault::Unplugged,
        Fault::Device,
        Fault::Protocol,
    ] {
        Table::pressing().silences(Reading::Fault(fault), State::Fault, Some(fault));
    }
    Table::pressing().silences(Reading::Waiting("why"), State::Waiting, None);
    Table::pressing().silences(
        Reading::Passive(probe(PRESSED), "why"),
        State::Waiting,
        None,
    );
}

#[test]
fn the_button_gives_no_force() {
    let held = Reading::At(Probe {
        buttons: 2,
        ..probe(PRESSED)
    });
    let mut table = Table::pressing();
    let shot = table.tick(held);
    assert_eq!((shot.reason, shot.buttons), (reason::BUTTON, 2));
    table.silences(held, State::Disabled, None);
}

#[test]
fn switching_off_gives_no_force() {
    let mut table = Table::pressing();
    table.settings.write(Settings {
        enabled: false,
        ..settings()
    });
    let shot = table.press();
    assert_eq!((shot.state, shot.reason), (State::Disabled, "switched off"));
    table.is_silent(&shot);
    table.settings.write(settings());
    assert_eq!(table.ramps(), reason::SWITCHED_ON);
}

#[test]
fn the_force_ramps_after_the_start_even_if_the_device_is_pressed_at_once() {
    let mut table = Table::new(crate::bodies::cube(), OPTIONS);
    let mut first = probe(ABOVE);
    first.restart = true;
    // In contact with the second tick, 2 mm deep: the ramp has hardly begun.
    let shot = table.tick(Reading::At(first));
    assert_eq!((shot.state, shot.reason), (State::Ramping, reason::STARTED));
    let shot = table.press();
    assert_eq!((shot.state, shot.limited), (State::Ramping, "ramp"));
    let gain = shot.output_force.length() / shot.contact_force.length();
    assert!((gain - 0.02).abs() < 1e-9);
}

#[test]
fn leaving_the_body_gives_no_force_in_the_same_tick() {
    let mut table = Table::pressing();
    let shot = table.tick(Reading::At(probe(ABOVE)));
    assert_eq!((shot.state, shot.output_force), (State::Free, DVec3::ZERO));
    assert_eq!(table.sent(), (DVec3::ZERO, true));
}

#[test]
fn the_clamp_and_the_devices_own_limit_are_kept_and_told() {
    let mut table = Table::pressing();
    let weak = Probe {
        max_force: 0.2,
        ..probe(PRESSED)
    };
    let shot = table.tick(Reading::At(weak));
    assert!((shot.output_force.length() - 0.2).abs() < 1e-12);
    assert_eq!((shot.state, shot.limited), (State::Touching, "clamp"));
    let only_measures = Probe {
        max_force: 0.0,
        ..probe(PRESSED)
    };
    let shot = table.tick(Reading::At(only_measures));
    assert_eq!(shot.output_force, DVec3::ZERO);

    let mut options = OPTIONS;
    options.limits.max_force = 0.3;
    let mut table = Table::new(crate::bodies::cube(), options);
    table.tick(Reading::At(probe(ABOVE)));
    for _ in 0..200 {
        let shot = table.press();
        assert!(shot.output_force.length() <= 0.3 * (1.0 + 1e-12));
    }
    assert!((table.press().output_force.length() - 0.3).abs() < 1e-12);
}

#[test]
fn a_force_that_grows_or_turns_suddenly_is_slewed_and_one_that_ends_is_not() {
    let mut options = OPTIONS;
    options.limits.max_slew = 20.0;
    let mut table = Table::pressing_with(options);
    let mut last = table.press().output_force;
    let mut deeper = PRESSED;
    deeper.z -= 0.004;
    let mut slewed = 0;
    for _ in 0..100 {
        let shot = table.tick(Reading::At(probe(deeper)));
        assert!(shot.output_force.distance(last) <= 20.0 * DT + 1e-12);
        slewed += u32::from(shot.limited == "slew");
        last = shot.output_force;
    }
    assert!(slewed > 10, "{slewed}");
    let shot = table.tick(Reading::At(probe(deeper)));
    assert_eq!((shot.output_force, shot.limited), (shot.contact_force, ""));
    let shot = table.tick(Reading::At(probe(ABOVE)));
    assert_eq!(shot.output_force, DVec3::ZERO);
}

#[test]
fn another_device_frame_sets_the_probe_down_anew() {
    let mut table = Table::pressing();
    table.settings.write(settings_of(FingerSettings {
        frame: DeviceFrame {
            epoch: 1,
            ..DeviceFrame::default()
        },
        ..FingerSettings::default()
    }));
    let shot = table.press();
    assert_eq!((shot.state, shot.output_force), (State::Free, DVec3::ZERO));
    assert_eq!(table.press().reason, reason::INSIDE);
    table.presses();
}

#[test]
fn a_servo_that_fails_inside_leaves_the_device_limp_and_says_so() {
    let sent = Arc::<Mutex<Vec<(DVec3, bool)>>>::default();
    let device = Scripted {
        sent: sent.clone(),
        panics: true,
        ..Scripted::above()
    };
    let running = Running::start(
        crate::bodies::cube(),
        vec![Box::new(device)],
        OPTIONS,
        settings(),
        10,
        0,
    )
    .unwrap();
    while running.paced().is_running() {
        std::thread::yield_now();
    }
    let shot = running.published().first().snapshot;
    assert_eq!(
        (shot.state, shot.fault),
        (State::Stopped, Some(Fault::Internal))
    );
    assert_eq!(sent.lock().unwrap().last(), Some(&(DVec3::ZERO, false)));
}

#[test]
fn a_servo_that_was_asked_to_stop_says_so() {
    let device = Scripted::above();
    let sent = device.sent.clone();
    let running = Running::start(
        crate::bodies::cube(),
        vec![Box::new(device)],
        OPTIONS,
        settings(),
        10,
        0,
    )
    .unwrap();
    running.paced().stop();
    let shot = running.published().first().snapshot;
    assert_eq!((shot.state, shot.reason), (State::Stopped, reason::ASKED));
    assert_eq!(sent.lock().unwrap().last(), Some(&(DVec3::ZERO, false)));
}
