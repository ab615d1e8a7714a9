//! A servo with a scripted device, ticked by hand in a time of its own.
#![allow(dead_code)] // Each test file takes what it needs.

use std::sync::{Arc, Mutex};

use glam::{DMat3, DVec3};
use palpate_servo::body::surface::Body;
use palpate_servo::control::safety::Limits;
use palpate_servo::device::{Device, DeviceFrame, Fault, Probe, Reading};
use palpate_servo::pile::laid::Laid;
use palpate_servo::servo::Servo;
use palpate_servo::servo::exchange::bodies::Hand;
use palpate_servo::servo::exchange::rings::Giver;
use palpate_servo::servo::settings::FingerSettings;
use palpate_servo::servo::settings::{Options, Settings};
use palpate_servo::servo::snapshot::{Published, Sample, Snapshot, State};
use palpate_servo::servo::tip::Tip;
use rtrb::Consumer;
use triple_buffer::{Input, Output};

pub const ABOVE: DVec3 = DVec3::new(0.02, 0.03, 0.055);
pub const PRESSED: DVec3 = DVec3::new(0.02, 0.03, 0.047);
pub const DT: f64 = 1e-3;

#[derive(Clone)]
pub struct Scripted {
    pub reading: Arc<Mutex<Reading>>,
    pub sent: Arc<Mutex<Vec<(DVec3, bool)>>>,
    pub panics: bool,
}

impl Scripted {
    pub fn above() -> Self {
        Self {
            reading: Arc::new(Mutex::new(Reading::At(probe(ABOVE)))),
            sent: Arc::default(),
            panics: false,
        }
    }
}

impl Device for Scripted {
    fn read(&mut self, _now: f64, _dt: f64, _frame: &DeviceFrame) -> Reading {
        assert!(!self.panics, "as the test wants it");
        *self.reading.lock().unwrap()
    }

    fn write(&mut self, force: DVec3, enable: bool, _frame: &DeviceFrame) {
        self.sent.lock().unwrap().push((force, enable));
    }

    fn park(&mut self) {
        self.sent.lock().unwrap().push((DVec3::ZERO, false));
    }
}

pub fn probe(position: DVec3) -> Probe {
    Probe {
        position,
        orientation: DMat3::IDENTITY,
        speed: 0.0,
        restart: false,
        buttons: 0,
        max_force: 3.0,
    }
}

pub const OPTIONS: Options = Options {
    rate_hz: 1000,
    limits: Limits {
        max_force: 3.0,
        max_slew: 1e6,
        ramp_seconds: 0.1,
    },
    max_speed: 2.0,
};

pub fn settings() -> Settings {
    Settings::new(1e4)
}

/// The same with another frame or coupling of finger 0.
pub fn settings_of(own: FingerSettings) -> Settings {
    let mut settings = settings();
    settings.fingers[0] = own;
    settings
}

pub struct Table {
    pub servo: Servo,
    pub body: Arc<Body>,
    pub devices: Vec<Scripted>,
    pub hand: Hand,
    pub prop: Giver<Laid>,
    pub tips: Vec<Giver<Tip>>,
    pub settings: Input<Settings>,
    pub samples: Consumer<Sample>,
    pub now: f64,
    pub snapshots: Output<Published>,
}

impl Table {
    /// A servo above a body.
    pub fn new(body: Arc<Body>, options: Options) -> Self {
        Self::with_fingers(body, options, 1)
    }

    /// The same with some fingers.
    pub fn with_fingers(body: Arc<Body>, options: Options, count: usize) -> Self {
        let devices: Vec<Scripted> = (0..count).map(|_| Scripted::above()).collect();
        let boxed = devices.iter().cloned();
        let boxed = boxed.map(|d| -> Box<dyn Device> { Box::new(d) }).collect();
        let (servo, ends) = Servo::new(body.clone(), boxed, options, &settings(), 10);
        Self {
            servo,
            body,
            devices,
            hand: ends.bodies,
            prop: ends.prop,
            tips: ends.tips,
            settings: ends.settings,
            samples: ends.samples,
            now: 0.0,
            snapshots: ends.snapshots,
        }
    }

    /// A servo that presses with its full force.
    pub fn pressing() -> Self {
        Self::pressing_with(OPTIONS)
    }

    pub fn pressing_with(options: Options) -> Self {
        let mut table = Self::new(super::bodies::cube(), options);
        table.presses();
        table
    }

    /// Goes above, then in, until the full force is there.
    pub fn presses(&mut self) {
        self.tick(Reading::At(probe(ABOVE)));
        for _ in 0..400 {
            self.press();
        }
        let shot = self.press();
        assert_eq!((shot.state, shot.limited), (State::Touching, ""));
        assert_eq!(shot.output_force, shot.contact_force);
        assert!(shot.output_force.length() > 0.5);
    }

    pub fn press(&mut self) -> Snapshot {
        self.tick(Reading::At(probe(PRESSED)))
    }

    pub fn tick(&mut self, reading: Reading) -> Snapshot {
        self.tick_after(DT, reading)
    }

    /// A tick so many seconds after the last one.
    pub fn tick_after(&mut self, seconds: f64, reading: Reading) -> Snapshot {
        self.tick_all(seconds, &[reading]).first().snapshot
    }

    /// A tick with a reading for each of the first fingers.
    pub fn tick_all(&mut self, seconds: f64, readings: &[Reading]) -> Published {
        for (device, reading) in self.devices.iter().zip(readings) {
            *device.reading.lock().unwrap() = *reading;
        }
        self.now += seconds;
        self.servo.tick(self.now);
        self.published()
    }

    pub fn published(&mut self) -> Published {
        *self.snapshots.read()
    }

    pub fn counted(&mut self, fault: Fault) -> u64 {
        self.published().first().faults[fault as usize]
    }

    pub fn sent(&self) -> (DVec3, bool) {
        *self.devices[0].sent.lock().unwrap().last().unwrap()
    }

    /// After this reading there is no force at once, and then a ramp from nothing.
    pub fn silences(&mut self, reading: Reading, state: State, fault: Option<Fault>) {
        for _ in 0..3 {
            let shot = self.tick(reading);
            assert_eq!((shot.state, shot.fault), (state, fault));
            self.is_silent(&shot);
        }
        self.ramps();
        if let Some(fault) = fault {
            assert_eq!(self.counted(fault), 1, "an episode counts once");
        }
    }

    pub fn is_silent(&self, shot: &Snapshot) {
        assert_eq!(shot.output_force, DVec3::ZERO);
        assert_eq!(shot.limited, "");
        assert_eq!(self.sent(), (DVec3::ZERO, false));
    }

    /// From here on the force grows evenly from nothing to the whole within 0.1 s; the reason.
    pub fn ramps(&mut self) -> &'static str {
        let mut last = 0.0;
        let mut reason = "";
        for tick in 1..=100 {
            let shot = self.press();
            assert_eq!(shot.state, State::Ramping);
            assert!(shot.hold.is_some());
            let gain = shot.output_force.length() / shot.contact_force.length();
            assert!(
                (gain - f64::from(tick) * 0.01).abs() < 1e-9,
                "{tick}: {gain}"
            );
            assert!(gain > last);
            assert_eq!(self.sent(), (shot.output_force, true));
            assert!(tick == 100 || shot.limited == "ramp");
            (last, reason) = (gain, shot.reason);
        }
        let shot = self.press();
        assert_eq!(
            (shot.state, shot.reason, shot.limited),
            (State::Touching, "", "")
        );
        assert_eq!(shot.output_force, shot.contact_force);
        reason
    }
}
