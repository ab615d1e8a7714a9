//! To equilibrium beside tools.

use super::gauge::Gauge;
use super::{Relaxation, Rest};
use crate::solid::domains::Nodal;
use crate::solid::load::Load;
use crate::solid::load::against::Against;
use crate::solid::search::bound;

impl Relaxation {
    /// Steps until it rests beside tools and under forces `dead`, from a linear displacement; `work` is that
    /// of a linear body. What is still within them counts as a share of it, as what is not at rest does. A
    /// `loose` body goes as a whole as they press it.
    pub fn keep_out(
        &mut self,
        linear: &Nodal,
        (dead, against): (&Nodal, &mut Against),
        loose: Option<Gauge>,
        (work, close): (f64, f64),
        most: usize,
    ) -> Rest {
        let still = self.gauge.take();
        self.gauge = loose.or_else(|| still.clone());
        self.linear.copy_from_slice(linear);
        self.history.clear();
        let mut rest = Rest {
            left: f64::INFINITY,
            steps: 0,
        };
        self.arrive(&Load::keeping_out(dead, against));
        self.find_slope(&Load::keeping_out(dead, against));
        loop {
            against.look(&self.warped);
            let load = Load::keeping_out(dead, against);
            let descent = self.direct(&load);
            let unrest = (descent / work).max(0.0).sqrt();
            let missed = against.missed(&self.warped) / work;
            rest.left = unrest.max(missed);
            if rest.left <= close || rest.steps == most {
                break;
            }
            rest.steps += 1;
            if unrest <= against.enough(missed).max(close) {
                against.count_in(&self.warped);
                self.arrive(&Load::keeping_out(dead, against));
                self.find_slope(&Load::keeping_out(dead, against));
            } else if !self.step(bound(work, descent), descent, &load) {
                if self.history.is_empty() {
                    break;
                }
                // Again by the stiffness at rest alone.
                self.history.clear();
            }
        }
        // Of springs that others do not have.
        self.history.clear();
        self.gauge = still;
        rest
    }
}
