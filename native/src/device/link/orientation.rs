//! Orientation of the stylus of a device on the link: ORIENTATION messages, each with its STATE.

use glam::{DMat3, DVec3};

use crate::device::course::Step;
use crate::device::link::messages::DeviceOrientation;
use crate::device::speedometer::Speedometer;

/// An orientation whose next one is lost holds for this long, s: as long as a position.
const HOLD_SECONDS: f64 = 0.02;
/// Points that turn with the stylus have their speed looked at like the device's place, m: any turn
/// moves one of them by 70 % or more of what it moves a point so far from the axis.
const LEVERS: [DVec3; 2] = [DVec3::new(0.05, 0.0, 0.0), DVec3::new(0.0, 0.0, 0.05)];

/// The newest orientation and the host's time of its STATE, s.
#[derive(Debug, Clone, Copy)]
struct Turned {
    rotation: DMat3,
    at: f64,
}

/// Counts of ORIENTATION messages.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct OrientationReport {
    /// Came with their STATE.
    pub paired: u64,
    /// Their STATE did not come, or was not used.
    pub unpaired: u64,
    /// No unit quaternion.
    pub refused: u64,
    /// Missing: STATE without, of a session that has had one.
    pub lost: u64,
}

/// The orientation of one session.
#[derive(Debug, Default)]
pub struct Orientations {
    /// Told, and waiting for its STATE.
    told: Option<(u16, DMat3)>,
    newest: Option<Turned>,
    levers: [Speedometer; 2],
    /// Counts of all sessions.
    pub report: OrientationReport,
}

impl Orientations {
    /// An ORIENTATION came.
    pub fn tell(&mut self, orientation: DeviceOrientation) {
        self.dismiss();
        match orientation.rotation() {
            Some(q) => self.told = Some((orientation.sequence, DMat3::from_quat(q))),
            None => self.report.refused += 1,
        }
    }

    /// The STATE that came is not used, nor is what was told of it.
    pub fn dismiss(&mut self) {
        self.report.unpaired += u64::from(self.told.take().is_some());
    }

    /// A STATE is used that came at `now` (s) and was made at `time_us` by the device's clock. The
    /// step of points that turn with the stylus, 50 mm from the tip; none without an orientation.
    pub fn pair(&mut self, sequence: u16, time_us: u32, now: f64) -> Step {
        let Some((_, rotation)) = self.told.take_if(|(told, _)| *told == sequence) else {
            self.dismiss();
            self.report.lost += u64::from(self.is_known());
            return Step::default();
        };
        self.report.paired += 1;
        self.newest = Some(Turned { rotation, at: now });
        let [x, z] = &mut self.levers;
        x.step(rotation * LEVERS[0], time_us, now)
            .or(z.step(rotation * LEVERS[1], time_us, now))
    }

    /// Whether this session has had an orientation.
    pub fn is_known(&self) -> bool {
        self.newest.is_some()
    }

    /// Whether the device told its orientation once and does so no more.
    pub fn is_stale(&self, now: f64) -> bool {
        self.newest
            .is_some_and(|newest| now - newest.at > HOLD_SECONDS)
    }

    /// Rotation from the stylus' axes to the device's; none until it is known.
    pub fn rotation(&self) -> DMat3 {
        self.newest
            .map_or(DMat3::IDENTITY, |newest| newest.rotation)
    }

    /// In silence: what was told before it belongs to no STATE.
    pub fn interrupt(&mut self) {
        self.dismiss();
        for lever in &mut self.levers {
            lever.interrupt();
        }
    }

    /// Another session: the device may be one that tells no orientation. What it has told of the STATE
    /// to come stays.
    pub fn forget(&mut self) {
        self.newest = None;
        for lever in &mut self.levers {
            lever.reset();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UPRIGHT: [i16; 4] = [32_767, 0, 0, 0];
    /// A quarter turn about z.
    const QUARTER: [i16; 4] = [23_170, 0, 0, 23_170];

    fn told(orientations: &mut Orientations, sequence: u16, quaternion: [i16; 4]) {
        orientations.tell(DeviceOrientation {
            sequence,
            quaternion,
        });
    }

    fn counts(orientations: &Orientations) -> [u64; 4] {
        let OrientationReport {
            paired,
            unpaired,
            refused,
            lost,
        } = orientations.report;
        [paired, unpaired, refused, lost]
    }

    #[test]
    fn only_the_state_of_the_same_number_turns_the_stylus() {
        let mut orientations = Orientations::default();
        told(&mut orientations, 7, QUARTER);
        assert!(!orientations.is_known(), "its STATE is to come");
        orientations.pair(8, 0, 0.0);
        assert_eq!(orientations.rotation(), DMat3::IDENTITY);
        orientations.pair(7, 0, 0.0);
        assert!(!orientations.is_known(), "it was of the STATE before");
        told(&mut orientations, 8, UPRIGHT);
        told(&mut orientations, 9, QUARTER);
        orientations.pair(9, 0, 0.0);
        assert!((orientations.rotation() * DVec3::X).distance(DVec3::Y) < 1e-12);
        told(&mut orientations, 10, [0; 4]);
        orientations.pair(10, 1000, 0.001);
        assert!((orientations.rotation() * DVec3::X).distance(DVec3::Y) < 1e-12);
        assert_eq!(counts(&orientations), [1, 2, 1, 1]);
    }

    #[test]
    fn the_last_one_holds_for_twenty_milliseconds() {
        let mut orientations = Orientations::default();
        assert!(!orientations.is_stale(1e9), "a device that tells none");
        told(&mut orientations, 0, QUARTER);
        orientations.pair(0, 0, 5.0);
        orientations.pair(1, 1000, 5.01);
        assert!(!orientations.is_stale(5.0199) && orientations.is_stale(5.0201));
        orientations.forget();
        assert!(!orientations.is_stale(6.0) && !orientations.is_known());
    }

    #[test]
    fn a_turn_is_measured_50_mm_from_the_tip() {
        // 10 rad/s about each axis; one STATE in three is without.
        for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
            let mut orientations = Orientations::default();
            for ms in 0..200_u16 {
                let q = glam::DQuat::from_axis_angle(axis, 0.01 * f64::from(ms));
                if ms % 3 > 0 {
                    let steps = [q.w, q.x, q.y, q.z].map(|c| (c * 32_767.0).round() as i16);
                    told(&mut orientations, ms, steps);
                }
                let step = orientations.pair(ms, 1000 * u32::from(ms), 1e-3 * f64::from(ms));
                let speed = step.speed;
                let expected = if ms % 3 > 0 && ms > 1 { 0.5 } else { 0.0 };
                assert!((speed - expected).abs() < 0.01, "{ms} {speed}");
            }
            assert_eq!(counts(&orientations), [133, 0, 0, 66]);
        }
    }

    #[test]
    fn after_silence_nothing_told_before_is_used() {
        let mut orientations = Orientations::default();
        told(&mut orientations, 0, UPRIGHT);
        orientations.pair(0, 0, 0.0);
        told(&mut orientations, 1, UPRIGHT);
        orientations.interrupt();
        orientations.pair(1, 1_000_000, 1.0);
        assert!(orientations.is_known() && orientations.is_stale(1.0));
        told(&mut orientations, 2, QUARTER);
        let step = orientations.pair(2, 1_001_000, 1.001);
        assert!(step.speed == 0.0 && step.has_strayed, "turned out of sight");
        assert_eq!(counts(&orientations), [2, 1, 0, 1]);
    }
}
