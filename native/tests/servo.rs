//! Whole ticks with a scripted device: what goes wrong gives zero force, a name, and a ramp.

mod bodies;

use std::sync::{Arc, Mutex};

use glam::DVec3;
use palpate_servo::coupling::Coupling;
use palpate_servo::device::{Device, DeviceFrame, Fault, LinkReport, Probe, Reading};
use palpate_servo::proxy::Feel;
use palpate_servo::safety::Limits;
use palpate_servo::servo::{Options, Servo, Settings};
use palpate_servo::snapshot::{Published, Snapshot, State};
use palpate_servo::thread::Running;
use rtrb::{Consumer, RingBuffer};
use triple_buffer::{Input, Output, triple_buffer};

const ABOVE: DVec3 = DVec3::new(0.02, 0.03, 0.055);
const PRESSED: DVec3 = DVec3::new(0.02, 0.03, 0.047);
const DT: f64 = 1e-3;

#[derive(Clone)]
struct Scripted {
    reading: Reading,
    sent: Arc<Mutex<Vec<(DVec3, bool)>>>,
    panics: bool,
}

impl Device for Scripted {
    fn read(&mut self, _now: f64, _dt: f64, _frame: &DeviceFrame) -> Reading {
        assert!(!self.panics, "as the test wants it");
        self.reading
    }

    fn write(&mut self, force: DVec3, enable: bool, _frame: &DeviceFrame) {
        self.sent.lock().unwrap().push((force, enable));
    }

    fn park(&mut self) {
        self.sent.lock().unwrap().push((DVec3::ZERO, false));
    }

    fn report(&self) -> LinkReport {
        LinkReport::default()
    }
}

fn probe(position: DVec3) -> Probe {
    Probe {
        position,
        speed: 0.0,
        restart: false,
        buttons: 0,
        max_force: 3.0,
    }
}

const OPTIONS: Options = Options {
    rate_hz: 1000,
    limits: Limits {
        max_force: 3.0,
        max_slew: 1e6,
        ramp_seconds: 0.1,
    },
    max_speed: 2.0,
};

fn settings() -> Settings {
    Settings {
        young_modulus: 1e4,
        enabled: true,
        frame: DeviceFrame::default(),
        feel: Feel::default(),
        coupling: Coupling::default(),
    }
}

struct Table {
    servo: Servo<Scripted>,
    settings: Input<Settings>,
    snapshots: Output<Published>,
    _samples: Consumer<palpate_servo::snapshot::Sample>,
    ticks: u32,
}

impl Table {
    /// A servo that presses with its full force.
    fn pressing() -> Self {
        let (settings_in, settings_out) = triple_buffer(&settings());
        let (snapshots_in, snapshots) = triple_buffer(&Published::default());
        let (samples_in, samples) = RingBuffer::new(10);
        let device = Scripted {
            reading: Reading::At(probe(ABOVE)),
            sent: Arc::default(),
            panics: false,
        };
        let body = bodies::cube();
        let servo = Servo::new(
            body,
            device,
            OPTIONS,
            settings_out,
            snapshots_in,
            samples_in,
        );
        let mut table = Self {
            servo,
            settings: settings_in,
            snapshots,
            _samples: samples,
            ticks: 0,
        };
        assert_eq!(table.tick(Reading::At(probe(ABOVE))).state, State::Free);
        for _ in 0..200 {
            table.tick(Reading::At(probe(PRESSED)));
        }
        let shot = table.tick(Reading::At(probe(PRESSED)));
        assert_eq!(shot.state, State::Touching);
        assert_eq!(shot.output_force, shot.contact_force);
        assert!(shot.output_force.length() > 0.5);
        table
    }

    fn tick(&mut self, reading: Reading) -> Snapshot {
        self.servo.device.reading = reading;
        self.ticks += 1;
        self.servo.tick(f64::from(self.ticks) * DT);
        self.snapshots.read().snapshot
    }

    fn sent(&self) -> (DVec3, bool) {
        *self.servo.device.sent.lock().unwrap().last().unwrap()
    }

    /// After this reading there is no force at once, and then a ramp from nothing.
    fn silences(&mut self, reading: Reading, state: State, fault: Option<Fault>) {
        for _ in 0..3 {
            let shot = self.tick(reading);
            assert_eq!((shot.state, shot.fault), (state, fault));
            assert_eq!(shot.output_force, DVec3::ZERO);
            assert_eq!(self.sent(), (DVec3::ZERO, false));
        }
        self.ramps();
        if let Some(fault) = fault {
            let counted = self.snapshots.read().faults;
            assert_eq!(counted[fault as usize], 1, "an episode counts once");
        }
    }

    fn ramps(&mut self) {
        let mut last = 0.0;
        for tick in 1..=100 {
            let shot = self.tick(Reading::At(probe(PRESSED)));
            assert_eq!(shot.state, State::Touching);
            let gain = shot.output_force.length() / shot.contact_force.length();
            assert!((gain - f64::from(tick) * 0.01).abs() < 1e-9);
            assert!(gain > last);
            assert_eq!(self.sent(), (shot.output_force, true));
            last = gain;
        }
    }
}

#[test]
fn positions_that_are_not_numbers_give_no_force() {
    for bad in [f64::NAN, f64::INFINITY] {
        let reading = Reading::At(probe(DVec3::new(0.0, bad, 0.0)));
        Table::pressing().silences(reading, State::Fault, Some(Fault::Nan));
    }
}

#[test]
fn a_modulus_that_is_not_a_number_gives_no_force() {
    let mut table = Table::pressing();
    table.settings.write(Settings {
        young_modulus: f64::NAN,
        ..settings()
    });
    let shot = table.tick(Reading::At(probe(PRESSED)));
    assert_eq!((shot.state, shot.fault), (State::Fault, Some(Fault::Nan)));
    assert_eq!(table.sent(), (DVec3::ZERO, false));
    table.settings.write(settings());
    table.ramps();
}

#[test]
fn a_device_that_is_too_fast_gets_no_force() {
    let fast = Probe {
        speed: 2.1,
        ..probe(PRESSED)
    };
    Table::pressing().silences(Reading::At(fast), State::Fault, Some(Fault::TooFast));
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
    let held = Probe {
        buttons: 2,
        ..probe(PRESSED)
    };
    Table::pressing().silences(Reading::At(held), State::Disabled, None);
}

#[test]
fn switching_off_gives_no_force() {
    let mut table = Table::pressing();
    table.settings.write(Settings {
        enabled: false,
        ..settings()
    });
    let shot = table.tick(Reading::At(probe(PRESSED)));
    assert_eq!((shot.state, shot.reason), (State::Disabled, "switched off"));
    assert_eq!(table.sent(), (DVec3::ZERO, false));
    table.settings.write(settings());
    table.ramps();
}

#[test]
fn leaving_the_body_gives_no_force_in_the_same_tick() {
    let mut table = Table::pressing();
    let shot = table.tick(Reading::At(probe(ABOVE)));
    assert_eq!((shot.state, shot.output_force), (State::Free, DVec3::ZERO));
    assert_eq!(table.sent(), (DVec3::ZERO, true));
}

#[test]
fn the_devices_own_limit_is_kept() {
    let mut table = Table::pressing();
    let weak = Probe {
        max_force: 0.2,
        ..probe(PRESSED)
    };
    let shot = table.tick(Reading::At(weak));
    assert!((shot.output_force.length() - 0.2).abs() < 1e-12);
}

#[test]
fn another_device_frame_sets_the_probe_down_anew() {
    let mut table = Table::pressing();
    table.settings.write(Settings {
        frame: DeviceFrame {
            epoch: 1,
            ..DeviceFrame::default()
        },
        ..settings()
    });
    let shot = table.tick(Reading::At(probe(PRESSED)));
    assert_eq!((shot.state, shot.output_force), (State::Free, DVec3::ZERO));
}

#[test]
fn a_servo_that_fails_inside_leaves_the_device_limp_and_says_so() {
    let sent = Arc::<Mutex<Vec<(DVec3, bool)>>>::default();
    let device = Scripted {
        reading: Reading::At(probe(ABOVE)),
        sent: sent.clone(),
        panics: true,
    };
    let running = Running::start(bodies::cube(), device, OPTIONS, settings(), 10, 0).unwrap();
    while running.paced().is_running() {
        std::thread::yield_now();
    }
    let shot = running.published().snapshot;
    assert_eq!(
        (shot.state, shot.fault),
        (State::Stopped, Some(Fault::Internal))
    );
    assert_eq!(sent.lock().unwrap().last(), Some(&(DVec3::ZERO, false)));
}
