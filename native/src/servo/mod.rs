//! One tick: read, proxy, contact, safety, write, publish. No allocation, no lock.

mod child_thread;
pub mod exchange;
pub mod finger;
pub mod paced;
pub mod pressed_patch;
pub mod recorder;
pub mod settings;
pub mod snapshot;
pub mod stages;
pub mod thread;
pub mod tip;

use std::sync::Arc;
use std::time::Instant;

use glam::DVec3;
use rtrb::Producer;
use triple_buffer::{Input, Output};

use crate::body::surface::Body;
use crate::contact::cones::{MAX_FINGERS, Vectors};
use crate::contact::touch::ContactMode;
use crate::device::{Device, Fault};
use crate::engine::Engine;
use crate::engine::joint::Ground;
use crate::servo::exchange::{Holder, exchange};
use crate::servo::finger::Finger;
use crate::servo::recorder::Tape;
use crate::servo::settings::{Moment, Options, Settings};
use crate::servo::snapshot::{Published, Sample};
use crate::servo::stages::{Stage, Stages};

/// The loop's body and memory.
pub struct Servo {
    /// The body to touch, and those that come.
    pub bodies: Holder,
    /// Those that touch it, at least one.
    pub fingers: Vec<Finger>,
    options: Options,
    settings: Output<Settings>,
    snapshots: Input<Published>,
    samples: Producer<Sample>,
    /// Where ticks go while they are recorded.
    pub tape: Option<Tape>,
    engine: Engine,
    tick: u64,
    /// Time of the last tick, s.
    ticked_at: Option<f64>,
    samples_lost: u64,
    stages: Arc<Stages>,
}

impl Servo {
    /// A servo at rest, with as many fingers as devices: one to [`MAX_FINGERS`].
    pub fn new(
        body: Arc<Body>,
        devices: Vec<Box<dyn Device>>,
        options: Options,
        mut settings: Output<Settings>,
        snapshots: Input<Published>,
        samples: Producer<Sample>,
    ) -> Self {
        assert!((1..=MAX_FINGERS).contains(&devices.len()));
        let own = settings.read().fingers;
        let fingers = devices.into_iter().zip(&own);
        Self {
            bodies: exchange(body).1,
            fingers: fingers.map(|(d, own)| Finger::new(d, own)).collect(),
            options,
            settings,
            snapshots,
            samples,
            tape: None,
            engine: Engine::default(),
            tick: 0,
            ticked_at: None,
            samples_lost: 0,
            stages: Arc::default(),
        }
    }

    /// Times of the tick's parts, for other threads to read.
    pub fn stages(&self) -> Arc<Stages> {
        self.stages.clone()
    }

    /// Does one tick at `now`, s since the start.
    pub fn tick(&mut self, now: f64) {
        let mut since = Instant::now();
        // The body before the settings that belong to it. The exchange keeps it: the end of this
        // tick never frees it.
        let (body, number, body_replaced) = self.bodies.newest();
        let body = Arc::clone(body);
        let settings = *self.settings.read();
        self.tick += 1;
        let moment = Moment {
            tick: self.tick,
            now,
            dt: 1.0 / f64::from(self.options.rate_hz),
            gap: self.ticked_at.replace(now).map_or(0.0, |last| now - last),
            body: number,
            body_replaced,
        };
        for (finger, own) in self.fingers.iter_mut().zip(&settings.fingers) {
            finger.read(&moment, own);
        }
        self.stages.end_of(Stage::Read, &mut since);

        for (finger, own) in self.fingers.iter_mut().zip(&settings.fingers) {
            finger.follow(&body, &moment, &settings, own, &self.options);
        }
        self.stages.end_of(Stage::Proxy, &mut since);

        let wanted = self.feel(&body, &moment, &settings);
        self.stages.end_of(Stage::Contact, &mut since);

        let mut limits = self.options.limits;
        limits.max_force = settings.max_force.unwrap_or(limits.max_force);
        let fingers = self.fingers.iter_mut().zip(&settings.fingers);
        for ((finger, own), wanted) in fingers.zip(wanted) {
            finger.send(wanted, &limits, own, moment.dt);
        }
        self.stages.end_of(Stage::Write, &mut since);
        self.publish(settings.young_modulus);
    }

    /// What the body makes each finger feel; what is to go to the motors, N.
    fn feel(&mut self, body: &Body, moment: &Moment, settings: &Settings) -> Vectors {
        let own = &settings.fingers;
        // The paper couples fingers on nodes alone (10); in its mode each feels as if it were alone.
        let are_several = self.fingers.len() > 1;
        let are_coupled = are_several && settings.feel.mode == ContactMode::Consistent;
        let reckons = |finger: &Finger| finger.acts() || finger.is_moved();
        let mut presses = [None; MAX_FINGERS];
        if are_coupled && self.fingers.iter().any(reckons) {
            for ((press, finger), own) in presses.iter_mut().zip(&mut self.fingers).zip(own) {
                *press = finger.press(body, settings, own, moment.dt);
            }
        }
        let mut led = [const { None }; MAX_FINGERS];
        for (led, finger) in led.iter_mut().zip(&mut self.fingers) {
            *led = finger.lead(&settings.feel, are_several);
        }
        let ground = Ground {
            body,
            number: moment.body,
            young_modulus: settings.young_modulus,
            dt: moment.dt,
        };
        let answers = self.engine.tick(&ground, &presses, &mut led);
        let mut wanted = [DVec3::ZERO; MAX_FINGERS];
        for (p, finger) in self.fingers.iter_mut().enumerate() {
            wanted[p] = if finger.has_tool() {
                finger.feel_tool(&own[p], moment.dt)
            } else if let Some(answers) = &answers {
                finger.feel(body, settings, &own[p], &answers[p], moment.dt)
            } else {
                finger.forget_others();
                finger.feel_alone(body, settings, &own[p], moment.dt)
            };
        }
        wanted
    }

    fn publish(&mut self, young_modulus: f64) {
        let published = self.snapshots.input_buffer_mut();
        published.count = self.fingers.len();
        for (number, finger) in self.fingers.iter_mut().enumerate() {
            published.reports[number] = *finger.tell(young_modulus);
            let sample = finger.sample(number as u32);
            if self.samples.push(sample).is_err() {
                self.samples_lost += 1;
            }
            if let Some(tape) = &mut self.tape {
                tape.put(sample);
            }
        }
        published.samples_lost = self.samples_lost;
        self.snapshots.publish();
    }

    /// Leaves all devices limp and says so.
    pub fn park(&mut self, fault: Option<Fault>) {
        let published = self.snapshots.input_buffer_mut();
        published.count = self.fingers.len();
        published.samples_lost = self.samples_lost;
        for (report, finger) in published.reports.iter_mut().zip(&mut self.fingers) {
            *report = *finger.park(fault);
        }
        self.snapshots.publish();
    }
}
