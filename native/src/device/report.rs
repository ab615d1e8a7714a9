//! Counters of a device's line, and the device's greeting.

use crate::device::arrival::ArrivalReport;

/// Greeting of a device.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Greeting {
    /// Protocol version the device speaks; of another one than the host's nothing else is known.
    pub protocol: u8,
    /// UTF-8, zero padded.
    pub name: [u8; 16],
    /// Number of axes.
    pub axes: u8,
    /// Largest force, N.
    pub max_force: f32,
    /// Half extents of the workspace, m.
    pub half_extents: [f32; 3],
    /// Rate of the STATE stream, Hz.
    pub rate_hz: u16,
    /// Largest damping that the host may ask for, N s/m; zero where there is none.
    pub largest_damping: f32,
}

impl Greeting {
    /// Whether its figures can be those of a device.
    pub fn is_sound(&self) -> bool {
        let [x, y, z] = self.half_extents;
        [self.max_force, x, y, z]
            .iter()
            .all(|figure| figure.is_finite() && *figure >= 0.0)
    }
}

/// Counters of a link; all zero for a pointer.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct LinkReport {
    /// Valid STATE messages.
    pub states: u64,
    /// FORCE messages sent.
    pub forces: u64,
    /// STATE messages missing by their sequence numbers.
    pub lost: u64,
    /// STATE messages with the sequence number of the one before.
    pub duplicates: u64,
    /// STATE messages older than the one before; not used.
    pub out_of_order: u64,
    /// Frames with a wrong checksum.
    pub crc_errors: u64,
    /// Frames that are not COBS.
    pub cobs_errors: u64,
    /// Frames that are too long.
    pub oversize: u64,
    /// Sound frames of unknown type or length.
    pub unknown: u64,
    /// ORIENTATION messages that came with their STATE.
    pub orientations: u64,
    /// ORIENTATION messages whose STATE did not come, or was not used.
    pub orientations_unpaired: u64,
    /// ORIENTATION messages that hold no unit quaternion.
    pub orientations_refused: u64,
    /// STATE messages without ORIENTATION of a device that has told one.
    pub orientations_lost: u64,
    /// HELLO messages sent.
    pub hellos: u64,
    /// FAULT messages of the device.
    pub device_faults: u64,
    /// FORCE messages not sent because the port took no more.
    pub unsent: u64,
    /// Times the port was opened again.
    pub reopened: u64,
    /// Time from a FORCE until a STATE told that it was taken, averaged, s; None in protocol 1.
    pub round_trip: Option<f64>,
    /// FORCE messages of which no STATE has told yet.
    pub in_flight: u64,
    /// Time since the last STATE came, s; none was heard if None.
    pub state_age: Option<f64>,
    /// Code and detail of the device's last FAULT.
    pub last_fault: Option<(u8, u16)>,
    /// Arrivals of STATE messages.
    pub arrivals: ArrivalReport,
    /// Another process says zero should this one end.
    pub guarded: bool,
    /// The device's greeting.
    pub greeting: Option<Greeting>,
}
