//! Snapshots of a tick for other threads: named state, positions, forces and counters.

use glam::{DMat3, DVec3};

use crate::contact::cones::MAX_FINGERS;
use crate::contact::ground::MOST_BODIES;
pub use crate::control::state::State;
use crate::device::reason;
use crate::device::{Fault, LinkReport};
use crate::rest::placement::Placement;

/// One finger in one tick, whole: all fields belong together. Places, directions and forces are those
/// that the hand has, in the world where the body moves; forces on nodes are in the body's axes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Snapshot {
    /// Counts from 1; 0 before the first tick.
    pub tick: u64,
    /// Since the start, s.
    pub time: f64,
    /// Position of the finger, m.
    pub probe: DVec3,
    /// Rotation from its tool's axes to the hand's.
    pub orientation: DMat3,
    /// Contact point that makes the force, m: the god object, shaded or held back by friction.
    pub proxy: DVec3,
    /// It presses on the body.
    pub touching: bool,
    /// Triangle and area coordinates while touching with a point.
    pub hold: Option<(u32, [f64; 3])>,
    /// Whether friction holds the contact point where it is.
    pub sticking: bool,
    /// Node numbers of that triangle.
    pub triangle: [u32; 3],
    /// (12), (13): with them the body gives way as far as the finger has come, N.
    pub nodal_forces: [DVec3; 3],
    /// (14) before coupling and safety, N.
    pub contact_force: DVec3,
    /// On a tool about its reference point, N m, before safety; none on a point.
    pub torque: DVec3,
    /// Position of the touched point of the surface, m; known while touching, if the body has a
    /// compliance.
    pub surface_point: Option<DVec3>,
    /// Sent to the device, N.
    pub output_force: DVec3,
    /// Named state.
    pub state: State,
    /// The fault while `state` is [`State::Fault`].
    pub fault: Option<Fault>,
    /// Reason why it waits, ramps, is disabled or stopped, or empty.
    pub reason: &'static str,
    /// Limiter that shortens the force, one of [`LIMITERS`](crate::control::safety::LIMITERS), or empty.
    pub limited: &'static str,
    /// A bit a button.
    pub buttons: u8,
    /// Counts the exchanges of the body: to which one the triangles belong.
    pub body: u32,
}

/// A finger's snapshot with its counters of the same tick.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct FingerReport {
    /// The tick.
    pub snapshot: Snapshot,
    /// The link.
    pub link: LinkReport,
    /// Times each of [`Fault::ALL`] began.
    pub faults: [u64; Fault::ALL.len()],
    /// Most features the proxy visited in one tick.
    pub most_steps: u32,
    /// Sweeps corrected by the sign of the distance.
    pub rescues: u64,
}

/// One tick of all fingers.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Published {
    /// Reports by finger; beyond `count` nothing.
    pub reports: [FingerReport; MAX_FINGERS],
    /// Fingers in use.
    pub count: usize,
    /// Samples not recorded because nobody emptied the ring.
    pub samples_lost: u64,
    /// Factor by which forces are other than a linear body's.
    pub firmness: f64,
    /// Elastic energy that the linear contact holds so deep, at unit modulus, J/Pa.
    pub held: f64,
    /// Where the body is after the tick; one that is held stays.
    pub placement: Placement,
    /// Where the others are that it presses, and how many of these there are.
    pub others: [Placement; MOST_BODIES - 1],
    /// Beyond, nothing.
    pub other_count: usize,
}

impl Published {
    /// Reports of so many fingers before the first tick.
    pub fn before_the_start(count: usize) -> Self {
        let mut published = Self {
            count,
            firmness: 1.0,
            ..Self::default()
        };
        for report in &mut published.reports[..count] {
            report.snapshot.reason = reason::NOT_STARTED;
        }
        published
    }

    /// Reports of the fingers in use.
    pub fn fingers(&self) -> &[FingerReport] {
        &self.reports[..self.count]
    }

    /// Report of finger 0, which is always there.
    pub fn first(&self) -> &FingerReport {
        &self.reports[0]
    }
}

/// One finger's tick in the recording.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[repr(C)]
pub struct Sample {
    /// Counts from 1.
    pub tick: u64,
    /// Since the start, s.
    pub time: f64,
    /// m.
    pub probe: [f64; 3],
    /// m.
    pub proxy: [f64; 3],
    /// Position of the touched point of the surface, m; not a number while free or unknown.
    pub surface: [f64; 3],
    /// (14), N.
    pub force: [f64; 3],
    /// After safety, N.
    pub output: [f64; 3],
    /// [`State`] as a number.
    pub state: u32,
    /// From 0 on.
    pub finger: u32,
}

impl Sample {
    /// The sample of a finger's tick.
    pub fn of(shot: &Snapshot, finger: u32) -> Self {
        Self {
            tick: shot.tick,
            time: shot.time,
            probe: shot.probe.to_array(),
            proxy: shot.proxy.to_array(),
            surface: shot.surface_point.unwrap_or(DVec3::NAN).to_array(),
            force: shot.contact_force.to_array(),
            output: shot.output_force.to_array(),
            state: shot.state as u32,
            finger,
        }
    }
}
