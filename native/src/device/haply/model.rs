//! Models of the 2DIY, as the makers' public example programs set them up (`docs/haply.md`).

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use crate::device::haply::pantograph::Pantograph;

/// Torque that no firmware seen so far cuts off, N m: the smaller of the two limits found.
pub const TORQUE_LIMIT: f64 = 0.123;

/// One motor with its encoder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Arm {
    /// Port on the board, counted from 0.
    pub port: usize,
    /// Sense of the motor for the board: 0 clockwise, 1 counter-clockwise.
    pub motor_sense: u8,
    /// Sense of the encoder for the board.
    pub encoder_sense: u8,
    /// Angle in the rest pose, degrees.
    pub rest_degrees: f32,
    /// Counts a turn as the board is told; some boards count only half of them.
    pub resolution: f32,
}

/// A device as it is set up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Model {
    /// Name for users.
    pub key: &'static str,
    /// Name for people, at most 16 bytes.
    pub name: &'static str,
    /// Address the board is given: this model, with its angles counted from a known pose. As the high
    /// byte of a float it makes next to nothing, as a command it is none.
    pub address: u8,
    /// Lengths.
    pub pantograph: Pantograph,
    /// Arm 1 at the origin, arm 2 at the spacing.
    pub arms: [Arm; 2],
    /// Middle of the workspace in the pantograph's own axes, m.
    pub centre: DVec2,
    /// Half extents of a rectangle around it in which every pose is good, m.
    pub half_extents: DVec2,
}

/// Places looked at on either side of the workspace's middle, along each axis.
const GRID: u32 = 6;

/// Bit of an address that says: angles not counted from a known pose.
const ADRIFT: u8 = 0x08;

const fn arm(
    port: usize,
    motor_sense: u8,
    encoder_sense: u8,
    rest_degrees: f32,
    resolution: f32,
) -> Arm {
    Arm {
        port,
        motor_sense,
        encoder_sense,
        rest_degrees,
        resolution,
    }
}

const V3: Pantograph = Pantograph {
    proximal: 0.07,
    distal: 0.09,
    spacing: 0.038,
};
const V2: Pantograph = Pantograph { spacing: 0.0, ..V3 };
const KIT: Pantograph = Pantograph {
    proximal: 0.05,
    distal: 0.07,
    spacing: 0.02,
};

/// All models; the first is the default.
pub const MODELS: [Model; 4] = [
    Model {
        key: "2diy-3.1",
        name: "Haply 2DIY 3.1",
        address: 0x20,
        pantograph: V3,
        arms: [arm(1, 1, 1, 168.0, 4880.0), arm(0, 1, 1, 12.0, 4880.0)],
        centre: DVec2::new(0.019, 0.095),
        half_extents: DVec2::new(0.06, 0.035),
    },
    Model {
        key: "2diy-3.0",
        name: "Haply 2DIY 3.0",
        address: 0x21,
        pantograph: V3,
        // 2048 * 2.5 * 1.0194, and for the first another factor of 1.0154: calibrated by the makers.
        arms: [
            arm(1, 1, 1, 97.23, 5_299.705_6),
            arm(0, 1, 1, 82.77, 5_219.328),
        ],
        centre: DVec2::new(0.019, 0.095),
        half_extents: DVec2::new(0.06, 0.035),
    },
    Model {
        key: "2diy-2",
        name: "Haply 2DIY 2",
        address: 0x22,
        pantograph: V2,
        arms: [arm(1, 1, 1, 241.0, 10752.0), arm(0, 0, 0, -61.0, 10752.0)],
        centre: DVec2::new(0.0, 0.085),
        half_extents: DVec2::new(0.06, 0.035),
    },
    Model {
        key: "kit",
        name: "Haply dev kit",
        address: 0x23,
        pantograph: KIT,
        arms: [arm(0, 0, 0, 180.0, 13824.0), arm(1, 0, 0, 0.0, 13824.0)],
        centre: DVec2::new(0.01, 0.07),
        half_extents: DVec2::new(0.045, 0.025),
    },
];

impl Model {
    /// The model of this key.
    pub fn find(key: &str) -> Option<&'static Self> {
        MODELS.iter().find(|model| model.key == key)
    }

    /// Address of a board that was set up only so that its motors obey.
    pub const fn adrift_address(&self) -> u8 {
        self.address | ADRIFT
    }

    /// Angles in the rest pose, degrees.
    pub fn rest_degrees(&self) -> [f32; 2] {
        self.arms.map(|arm| arm.rest_degrees)
    }

    /// Largest force in every direction in the middle of the workspace, N.
    pub fn largest_force_in_the_middle(&self) -> f64 {
        let pose = self
            .pantograph
            .angles(self.centre)
            .and_then(|angles| self.pantograph.pose(angles));
        pose.map_or(0.0, |pose| pose.largest_force(TORQUE_LIMIT))
    }

    /// The farthest that one reading of the encoders may lie from the next, anywhere in the workspace,
    /// m: both go on by a step at once. Boards that count half the edges are assumed.
    pub fn encoder_step(&self) -> f64 {
        let steps = self.arms.map(|arm| 2.0 * TAU / f64::from(arm.resolution));
        let places = (0..=2 * GRID).flat_map(|i| (0..=2 * GRID).map(move |j| (i, j)));
        places
            .filter_map(|(i, j)| {
                let part = DVec2::new(f64::from(i), f64::from(j)) / f64::from(GRID) - DVec2::ONE;
                let angles = self
                    .pantograph
                    .angles(self.centre + part * self.half_extents)?;
                let [first, second] = self.pantograph.pose(angles)?.columns;
                let (first, second) = (first * steps[0], second * steps[1]);
                Some((first + second).length().max((first - second).length()))
            })
            .fold(0.0, f64::max)
    }

    /// Device position of a point of the pantograph, m: from the workspace's middle, x to the
    /// user's right, y away from the user, z up. The pantograph's own axes are turned by half a
    /// turn: x to the left, y towards the user.
    pub fn to_device(&self, position: DVec2) -> DVec3 {
        (self.centre - position).extend(0.0)
    }

    /// A force of the servo in the pantograph's own axes; what is normal to the plane is dropped.
    pub fn to_pantograph(&self, force: DVec3) -> DVec2 {
        -force.truncate()
    }
}
