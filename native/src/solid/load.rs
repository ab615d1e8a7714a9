//! What presses a body: forces, what it is led to, and tools that it is kept out of.

pub mod against;
mod doing;
pub mod hold;
mod lower_upper;
pub mod place;
mod yielding;

use against::Against;

use super::domains::Nodal;
use super::history::{Field, add, dot};

/// By how much more stiffly than the linear body a place is led.
const STIFF: f64 = 20.0;

/// Forces on the nodes, and where the body is led.
#[derive(Debug, Clone, Copy)]
pub struct Load<'a> {
    /// Those that keep their directions.
    pub dead: &'a Nodal,
    /// On the linear displacements, whose work does not change where the body turns.
    pub turning: Option<&'a Nodal>,
    /// What is led beside.
    pub led: Option<&'a Led>,
    /// And kept out of.
    pub against: Option<&'a Against>,
}

impl<'a> Load<'a> {
    /// What is led, beside forces `none`.
    pub(super) fn leading(none: &'a Nodal, led: &'a Led) -> Self {
        Self {
            dead: none,
            turning: None,
            led: Some(led),
            against: None,
        }
    }

    /// What it is kept out of, beside forces `none`.
    pub(super) fn keeping_out(none: &'a Nodal, against: &'a Against) -> Self {
        Self {
            dead: none,
            turning: None,
            led: None,
            against: Some(against),
        }
    }

    /// Its own energy, that of a body at rest being none.
    pub(super) fn energy(&self, linear: &Nodal, warped: &Nodal) -> f64 {
        let turning = self.turning.map_or(0.0, |forces| dot(forces, linear));
        let led = self.led.map_or(0.0, |led| led.energy(warped));
        let against = self.against.map_or(0.0, |against| against.energy(warped));
        led + against - dot(self.dead, warped) - turning
    }

    /// What all of it does on the linear displacement that belongs to it.
    pub(super) fn linear_work(&self, linear: &Nodal) -> f64 {
        let turning = self.turning.map_or(0.0, |forces| dot(forces, linear));
        let led = self.led.map_or(0.0, Led::linear_work);
        dot(self.dead, linear) + turning + led
    }

    /// Takes what it does to displacements from the forces that hold them, but for what turns along.
    pub(super) fn take_from(&self, warped: &Nodal, forces: &mut Nodal) {
        add(forces, -1.0, self.dead);
        if let Some(led) = self.led {
            for (pull, pattern) in led.pulls(warped).iter().zip(&led.patterns) {
                add(forces, -pull, pattern);
            }
        }
        if let Some(against) = self.against {
            against.take_from(warped, forces);
        }
    }

    /// The same of what turns along, from the gradient by the linear displacements.
    pub(super) fn take_turning_from(&self, slope: &mut Nodal) {
        if let Some(turning) = self.turning {
            add(slope, -1.0, turning);
        }
    }
}

/// Patterns of forces, as much of each as it takes for its work on the displacements to be what is wanted.
///
/// Each is a stiff spring to its goal, and what it pulls with there is counted in (augmented Lagrangian,
/// J. Nocedal, S. J. Wright: Numerical Optimization, 2nd edition, 2006, section 17.3): so there is a rest also
/// where the body gives way under a force that stays.
#[derive(Debug, Clone)]
pub struct Led {
    patterns: Vec<Field>,
    /// The linear displacement under each.
    moved: Vec<Field>,
    wanted: Vec<f64>,
    /// The inverse of the work of each on the displacement under another, by rows.
    response: Vec<f64>,
    /// Of how much of each the forces are counted in.
    counted: Vec<f64>,
}

impl Led {
    /// To the goals `wanted`; None where sizes differ.
    pub fn new(
        patterns: Vec<Field>,
        moved: Vec<Field>,
        wanted: Vec<f64>,
        response: Vec<f64>,
    ) -> Option<Self> {
        let count = wanted.len();
        let fits = patterns.len() == count && moved.len() == count;
        (fits && response.len() == count * count).then(|| Self {
            counted: answer(&response, &wanted),
            patterns,
            moved,
            wanted,
            response,
        })
    }

    /// Of how much of each pattern the forces are there.
    pub fn pulls(&self, warped: &Nodal) -> Vec<f64> {
        let missed = self.missed(warped);
        let more = answer(&self.response, &missed);
        (self.counted.iter().zip(more))
            .map(|(counted, more)| counted - STIFF * more)
            .collect()
    }

    /// By what share of the way, in energy, the goals are missed.
    pub fn is_missed_by(&self, warped: &Nodal) -> f64 {
        let missed = self.missed(warped);
        (product(&missed, &answer(&self.response, &missed)) / self.linear_work())
            .max(0.0)
            .sqrt()
    }

    /// Counts in what pulls there.
    pub fn count_in(&mut self, warped: &Nodal) {
        self.counted = self.pulls(warped);
    }

    /// Takes a displacement of the body alone to that of the body with its springs.
    pub(super) fn hold(&self, solved: &mut Nodal) {
        let ways: Vec<f64> = self.patterns.iter().map(|one| dot(one, solved)).collect();
        let back = answer(&self.response, &ways);
        for (share, moved) in back.iter().zip(&self.moved) {
            add(solved, -share * STIFF / (1.0 + STIFF), moved);
        }
    }

    fn missed(&self, warped: &Nodal) -> Vec<f64> {
        (self.patterns.iter().zip(&self.wanted))
            .map(|(pattern, wanted)| dot(pattern, warped) - wanted)
            .collect()
    }

    fn energy(&self, warped: &Nodal) -> f64 {
        let missed = self.missed(warped);
        let spring = product(&missed, &answer(&self.response, &missed));
        let ways = self.patterns.iter().map(|one| dot(one, warped));
        let done: f64 = self.counted.iter().zip(ways).map(|(f, way)| f * way).sum();
        0.5 * STIFF * spring - done
    }

    fn linear_work(&self) -> f64 {
        product(&self.wanted, &answer(&self.response, &self.wanted))
    }
}

fn answer(rows: &[f64], ways: &[f64]) -> Vec<f64> {
    rows.chunks(ways.len())
        .map(|row| product(row, ways))
        .collect()
}

fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
