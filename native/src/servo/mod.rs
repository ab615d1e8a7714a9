//! One tick: read, proxy, contact, toll, safety, write, publish. No allocation, no lock.

mod child_thread;
pub mod exchange;
pub mod finger;
mod firm;
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

use rtrb::Producer;
use triple_buffer::{Input, Output};

use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::ground::{Ground, MOST_TOOLS};
use crate::contact::touch::ContactMode;
use crate::control::lending::Lending;
use crate::control::toll::{Given, Toll};
use crate::creep::shown::Remembered;
use crate::creep::step::Step;
use crate::device::Fault;
use crate::engine::Engine;
use crate::pile::laid::{Laid, Lying};
use crate::rest::borne::Borne;
use crate::rest::frame::Frame;
use crate::servo::exchange::bodies::Holder;
use crate::servo::exchange::rings::Taker;
use crate::servo::finger::{Finger, Followed, Touch};
use crate::servo::recorder::Tape;
use crate::servo::settings::{Moment, Options, Settings};
use crate::servo::snapshot::{Published, Sample, Snapshot};
use crate::servo::stages::{Stage, Stages};

/// The loop's body and memory.
pub struct Servo {
    bodies: Holder,
    /// The body as one that nobody holds, if it is one.
    prop: Taker<Laid>,
    /// Those that touch it, at least one.
    pub fingers: Vec<Finger>,
    options: Options,
    settings: Output<Settings>,
    snapshots: Input<Published>,
    samples: Producer<Sample>,
    /// Where ticks go while they are recorded.
    pub tape: Option<Tape>,
    engine: Engine,
    remembered: Input<Remembered>,
    remembers_nothing: bool,
    borne: Input<Borne>,
    nothing_bears: bool,
    toll: Toll<MAX_FINGERS>,
    lending: Lending,
    /// What a linear body would hold that is pressed in as far as this one in the last tick, J/Pa.
    pressed: f64,
    /// What could be given back after the last tick beside what fingers hold, J.
    stored: f64,
    tick: u64,
    /// Time of the last tick, s.
    ticked_at: Option<f64>,
    samples_lost: u64,
    stages: Arc<Stages>,
}

impl Servo {
    /// Times of the tick's parts, for other threads to read.
    pub fn stages(&self) -> Arc<Stages> {
        self.stages.clone()
    }

    /// Does one tick at `now`, s since the start.
    pub fn tick(&mut self, now: f64) {
        let mut since = Instant::now();
        // The body before the settings that belong to it. The exchange keeps it: the end of this
        // tick never frees it.
        let (body, number, is_other) = self.bodies.newest();
        let body = Arc::clone(body);
        let is_laid = self.prop.exchange();
        let frame = self.frame(&body);
        let (mut settings, options) = (*self.settings.read(), self.options);
        if !frame.is_held() {
            // The paper has no body that anything moves.
            settings.feel.mode = ContactMode::Consistent;
        }
        let dt = 1.0 / f64::from(options.rate_hz);
        let is_among = self.lying(&body).is_some_and(Lying::is_among);
        let creep = if is_among {
            // As it gives way in the end: others would have to remember, too.
            Step::default()
        } else {
            creep_of(&settings, &body, dt)
        };
        let relaxed = settings.young_modulus;
        settings.young_modulus *= creep.firmness();
        let firm = self.firm(&settings, dt);
        settings.young_modulus *= firm.map_or(1.0, |firm| firm.share);
        self.tick += 1;
        let moment = Moment {
            tick: self.tick,
            now,
            dt,
            creep,
            firmness: firm,
            gap: self.ticked_at.replace(now).map_or(0.0, |last| now - last),
            body: &body,
            body_number: number,
            body_replaced: is_other || is_laid,
            is_among,
            frame,
            settings: &settings,
            options: &options,
        };
        let own = &settings.fingers;
        let readings = each(&mut self.fingers, |k, finger| {
            Some(finger.read(&moment, &own[k]))
        });
        self.stages.end_of(Stage::Read, &mut since);

        let followed = each(&mut self.fingers, |k, finger| {
            Some(finger.follow(&moment, &own[k], readings[k].as_ref()?))
        });
        self.stages.end_of(Stage::Proxy, &mut since);

        let touches = self.feel(&moment, &followed);
        let touches = self.pay(&moment, &touches);
        self.stages.end_of(Stage::Contact, &mut since);

        let shots = each(&mut self.fingers, |k, finger| {
            Some(finger.send(followed[k].as_ref()?, touches[k].as_ref()?))
        });
        (self.toll)
            .sent(&shots.map(|shot| Some(shot.filter(|s| s.state.may_push())?.output_force)));
        self.stages.end_of(Stage::Write, &mut since);
        self.show_memory(moment.tick, relaxed);
        self.show_borne(moment.tick, moment.frame.is_held(), settings.young_modulus);
        self.publish(&shots, &self.frame(&body), &moment);
    }

    /// The contact of each finger with the body.
    fn feel(&mut self, moment: &Moment<'_>, followed: &Each<Followed<'_>>) -> Each<Touch> {
        let settings = moment.settings;
        // The paper couples fingers on nodes alone (10); in its mode each feels as if it were alone.
        let moves = !moment.frame.is_held();
        let is_beside = self.fingers.len() > 1 || moves;
        let creeps = !moment.creep.is_none();
        let is_consistent = settings.feel.mode == ContactMode::Consistent;
        let are_coupled = (is_beside || creeps) && is_consistent;
        let acts = followed.iter().flatten().any(Followed::acts);
        let mut presses = [None; MAX_FINGERS];
        if are_coupled && (acts || creeps || moves || self.fingers.iter().any(Finger::is_moved)) {
            presses = each(&mut self.fingers, |k, finger| {
                finger.press(followed[k].as_ref()?)
            });
        }
        let mut led = [const { None }; MOST_TOOLS];
        for ((led, finger), followed) in led.iter_mut().zip(&mut self.fingers).zip(followed) {
            *led = (followed.as_ref()).and_then(|followed| finger.lead(followed, is_beside));
        }
        let mut prop = match self.prop.held.as_deref_mut().filter(|_| moves) {
            Some(Lying::Among(among)) => {
                among.tick(&mut led, settings.young_modulus, moment.dt);
                return each(&mut self.fingers, |k, finger| {
                    Some(finger.feel(followed[k].as_ref()?, None))
                });
            }
            Some(Lying::Alone(prop)) => Some(prop),
            None => None,
        };
        let ground = Ground {
            body: moment.body,
            number: moment.body_number,
            young_modulus: settings.young_modulus,
            mobility: prop
                .as_ref()
                .map(|prop| prop.mobility(settings.young_modulus, moment.dt)),
            creep: moment.creep,
        };
        if let Some(prop) = &mut prop {
            prop.lead(&mut led);
        }
        let answers = (self.engine).tick(&[ground], &presses, &mut led);
        if let Some(prop) = prop {
            prop.move_on(&self.engine.motion(0));
        }
        each(&mut self.fingers, |k, finger| {
            let answer = answers.as_ref().map(|answers| &answers[k]);
            Some(finger.feel(followed[k].as_ref()?, answer))
        })
    }

    /// The contact of each finger with what it pays for sliding.
    fn pay(&mut self, moment: &Moment<'_>, touches: &Each<Touch>) -> Each<Touch> {
        let prop = (self.prop.held.as_ref()).filter(|_| !moment.frame.is_held());
        let beside = prop.map(|lying| (lying.held(), lying.raised()));
        let (held, raised) = beside.unwrap_or_default();
        let mut pressed = touches.map(|touch| touch.map_or_else(Default::default, |t| t.pressed));
        let mut given = self.hold(moment, &mut pressed, held, raised);
        if moment.body_replaced {
            (self.toll, given) = (Toll::default(), Given::default());
        }
        let brakes = self.toll.take(&pressed, &given, moment.dt);
        each(&mut self.fingers, |k, _| {
            Some(touches[k]?.braked(brakes[k]))
        })
    }

    fn publish(&mut self, shots: &Each<Snapshot>, frame: &Frame, moment: &Moment<'_>) {
        self.show_others(frame.is_held());
        let published = self.snapshots.input_buffer_mut();
        published.count = self.fingers.len();
        published.placement = frame.placement();
        published.firmness = moment.firmness.map_or(1.0, |firm| firm.share);
        published.held = self.pressed;
        let young_modulus = moment.settings.young_modulus;
        for (number, shot) in shots.iter().flatten().enumerate() {
            published.reports[number] = *self.fingers[number].tell(shot, frame, young_modulus);
            let sample = Sample::of(shot, number as u32);
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

    /// The frame of a body where it is now: one that nobody holds, if it is the one that was laid down.
    fn frame(&self, body: &Body) -> Frame {
        (self.lying(body)).map_or_else(Frame::default, |lying| Frame::of(lying.placement()))
    }

    /// The body as one that nobody holds, if it is the one that was laid down.
    fn lying(&self, body: &Body) -> Option<&Lying> {
        (self.prop.held.as_deref()).filter(|lying| lying.is(body))
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

/// How a body gives way with time in a tick of `dt` s: one that does not keep its whole compliance does
/// not, for nobody knows how it moves where it was touched before. Nor does the paper's.
fn creep_of(settings: &Settings, body: &Body, dt: f64) -> Step {
    if body.is_whole() && settings.feel.mode == ContactMode::Consistent {
        settings.creep.step(dt)
    } else {
        Step::default()
    }
}

/// A value of each finger that there is, by number.
type Each<T> = [Option<T>; MAX_FINGERS];

/// A stage of the tick: its value of each finger.
fn each<T>(
    fingers: &mut [Finger],
    mut stage: impl FnMut(usize, &mut Finger) -> Option<T>,
) -> Each<T> {
    std::array::from_fn(|k| stage(k, fingers.get_mut(k)?))
}
