//! A body led to where something is wanted, by forces of given patterns.

use super::{Relaxation, Rest};
use crate::solid::domains::Nodal;
use crate::solid::load::{Led, Load};

impl Relaxation {
    /// Steps until what is led is where it is wanted, missed by no more than a share `close` of the way, by
    /// energy, and at rest; what it ends with is the larger share. Where `goes_on`, from a linear displacement
    /// that is not the load's own, with what was learnt before.
    pub fn lead(
        &mut self,
        (linear, goes_on): (&Nodal, bool),
        led: &mut Led,
        close: f64,
        most: usize,
    ) -> Rest {
        let none = std::mem::take(&mut self.none);
        self.linear.copy_from_slice(linear);
        let work = Load::leading(&none, led).linear_work(linear);
        if goes_on {
            self.arrive(&Load::leading(&none, led));
            self.find_slope(&Load::leading(&none, led));
        } else {
            self.leave_rest(linear, &Load::leading(&none, led), work);
        }
        let mut steps = 0;
        let rest = loop {
            let rest = self.descend(&Load::leading(&none, led), work, close, most - steps);
            steps += rest.steps;
            let missed = led.is_missed_by(&self.warped);
            let left = rest.left.max(missed);
            if missed <= close || rest.left > close || steps == most {
                break Rest { left, steps };
            }
            led.count_in(&self.warped);
            self.arrive(&Load::leading(&none, led));
            self.find_slope(&Load::leading(&none, led));
        };
        self.none = none;
        rest
    }
}
