//! Geometry of the symmetric five-bar arm: two motors, two upper arms, two forearms, one handle.
//!
//! Motor 1 stands at the origin, motor 2 at (spacing, 0); angles count from the x axis towards y.
//! With elbows A and B and the handle P on the left of the way from A to B:
//! `|P - A| = |P - B| = distal`, whose differentials give the Jacobian. See G. Campion, Q. Wang and
//! V. Hayward, The Pantograph Mk-II: a haptic instrument, IROS 2005.

use glam::DVec2;

/// Below this sine between the forearms the handle can hardly be held.
const LEAST_SINE: f64 = 0.1;

/// Lengths, m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pantograph {
    /// Motor to elbow.
    pub proximal: f64,
    /// Elbow to handle.
    pub distal: f64,
    /// Motor 1 to motor 2.
    pub spacing: f64,
}

/// The handle for two motor angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Handle, m.
    pub position: DVec2,
    /// Columns of the Jacobian: motion of the handle with each motor's angle, m/rad.
    pub columns: [DVec2; 2],
    /// Sine of the angle between the forearms: 0 in a singular pose, where the handle can move
    /// although both motors are held.
    pub sine: f64,
}

impl Pantograph {
    /// The pose for motor angles in rad; None where the forearms cannot meet, or lie on a line so
    /// exactly that there is no Jacobian.
    pub fn pose(&self, angles: [f64; 2]) -> Option<Pose> {
        let [first, second] = angles.map(DVec2::from_angle);
        let a = first * self.proximal;
        let b = DVec2::new(self.spacing, 0.0) + second * self.proximal;
        let way = b - a;
        let half = 0.5 * way.length();
        let height = (self.distal * self.distal - half * half).sqrt();
        let position = 0.5 * (a + b) + way.perp() * (0.5 * height / half);
        let (u, v) = (position - a, position - b);
        let area = u.perp_dot(v);
        let pose = Pose {
            position,
            columns: [
                v.perp() * (-self.proximal * u.dot(first.perp()) / area),
                u.perp() * (self.proximal * v.dot(second.perp()) / area),
            ],
            sine: area.abs() / (self.distal * self.distal),
        };
        let [j, k] = pose.columns;
        // Forearms that cannot meet have the root of a negative number for a height.
        (position.is_finite() && j.is_finite() && k.is_finite()).then_some(pose)
    }

    /// Motor angles (rad) for a handle position, elbows outwards; None beyond the arms' reach.
    pub fn angles(&self, position: DVec2) -> Option<[f64; 2]> {
        let bearing = |from: DVec2, side: f64| {
            let way = position - from;
            let (upper, fore, reach) = (self.proximal, self.distal, way.length());
            // The law of cosines in the triangle of motor, elbow and handle.
            let cosine = (upper * upper + reach * reach - fore * fore) / (2.0 * upper * reach);
            way.to_angle() + side * cosine.acos()
        };
        let angles = [
            bearing(DVec2::ZERO, 1.0),
            bearing(DVec2::new(self.spacing, 0.0), -1.0),
        ];
        angles.iter().all(|a| a.is_finite()).then_some(angles)
    }
}

impl Pose {
    /// Whether the handle can hardly be held: the forearms lie nearly on a line.
    pub fn is_stretched(&self) -> bool {
        self.sine < LEAST_SINE
    }

    /// Torques of the motors that give `force` (N) at the handle, N m: the Jacobian's transpose.
    pub fn torques(&self, force: DVec2) -> [f64; 2] {
        self.columns.map(|column| column.dot(force))
    }

    /// Largest force that can be had in every direction with motors of `torque_limit` (N m), N.
    pub fn largest_force(&self, torque_limit: f64) -> f64 {
        let [j, k] = self.columns.map(DVec2::length);
        torque_limit / j.max(k)
    }
}
