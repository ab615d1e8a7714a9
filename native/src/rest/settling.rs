//! Ticks until nothing changes any more, in as many parts as is liked.

use glam::DVec3;

use super::placement::Placement;
use super::to_and_fro::{Now, Staying, Wavering};

/// The first tick is as long as this share of the longest one, and so is the shortest.
pub(super) const SHORTEST: f64 = 1e-3;
/// On the way to rest it goes by this share of the distance between contact points in a tick, about.
const WAY_PER_SPACING: f64 = 0.25;
/// It rests when what is left of all wrenches, and by how much forces still change, is less than this
/// share of the largest force.
const AT_REST: f64 = 1e-8;
/// In so many ticks one after the other.
const QUIET_TICKS: usize = 3;
/// It hardly moves where no more is left than this, forces change by no more than that, and what is led is off by
/// no more than that, as shares of the same.
const HARDLY_LEFT: f64 = 3e-7;
const HARDLY_CHANGED: f64 = 1e-5;
const HARDLY_OFF: f64 = 1e-6;
/// What goes to and fro is so far from what is led at most.
const NEAR_GOAL: f64 = 1e-4;
/// Ticks that it is given, and how many times its size it may go meanwhile.
const MOST_TICKS: usize = 20_000;
const MOST_SIZES: f64 = 20.0;
/// After all of its ticks so much may be left: a ball on a floor rolls ever so slowly to where its mesh
/// is softest.
const CREEPING: f64 = 1e-5;
/// What is led is at its goal if it misses that by this share of the size.
pub(super) const AT_GOAL: f64 = 1e-9;

/// Why a body does not rest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Restless {
    /// A force is no number.
    NotANumber,
    /// After so many s it still moves at this speed, m/s.
    Moving(f64, f64),
}

/// What comes to rest tick by tick.
pub trait Settles {
    /// One tick of `dt` s: how far a place went in it at most, m.
    ///
    /// # Errors
    /// [`Restless::NotANumber`].
    fn go(&mut self, dt: f64) -> Result<f64, Restless>;
    /// The longest tick in which contact is found, s.
    fn longest_tick(&self) -> f64;
    /// The same at a speed, m/s.
    fn longest_at(&self, longest: f64, _speed: f64) -> f64 {
        longest
    }
    /// Forces between all that may touch, N.
    fn forces(&self) -> Vec<DVec3>;
    /// The largest weight, N.
    fn weight(&self) -> f64;
    /// What is left of the wrenches at most, N; a torque by the size.
    fn left(&self) -> f64;
    /// Whether all that is led is where it goes, but for a share of the size.
    fn is_led(&self, share: f64) -> bool;
    /// The least distance between contact points, m.
    fn spacing(&self) -> f64;
    /// m.
    fn size(&self) -> f64;
    /// Since the beginning, s.
    fn since(&self) -> f64;
    /// Of each body.
    fn placements(&self) -> Vec<Placement>;
    /// How fast the lightest body goes under a force, m/s for each newton.
    fn mobility(&self) -> f64;
}

/// How far something has come on its way to rest.
#[derive(Debug, Clone)]
pub struct Settling {
    ticks: usize,
    quiet: usize,
    /// Metres.
    gone: f64,
    /// Seconds.
    longest: f64,
    dt: f64,
    before: Vec<DVec3>,
    wavering: Wavering,
    staying: Staying,
}

impl Settling {
    /// At the beginning.
    pub fn of(settles: &impl Settles) -> Self {
        let longest = settles.longest_tick();
        Self {
            ticks: 0,
            quiet: 0,
            gone: 0.0,
            longest,
            dt: SHORTEST * longest,
            before: settles.forces(),
            wavering: Wavering::default(),
            staying: Staying::default(),
        }
    }

    /// Goes on by at most so many ticks; whether it rests.
    ///
    /// # Errors
    /// [`Restless`]; it is where it came to.
    pub fn go_on(&mut self, settles: &mut impl Settles, ticks: usize) -> Result<bool, Restless> {
        for _ in 0..ticks {
            let way = settles.go(self.dt)?;
            let now = settles.forces();
            let largest = largest(&now).max(settles.weight());
            let left = share_of(settles.left(), largest);
            let changed = share_of(change(&self.before, &now), largest);
            let is_quiet = settles.is_led(AT_GOAL) && left <= AT_REST && changed <= AT_REST;
            self.quiet = if is_quiet { self.quiet + 1 } else { 0 };
            self.before = now;
            let hardly_moves =
                left <= HARDLY_LEFT && changed <= HARDLY_CHANGED && settles.is_led(HARDLY_OFF);
            if self.quiet == QUIET_TICKS
                || self.wavering.is_over(hardly_moves, changed / self.dt)
                || self.stays(settles, largest)
            {
                return Ok(true);
            }
            let speed = way / self.dt;
            (self.ticks, self.gone) = (self.ticks + 1, self.gone + way);
            if self.gone > MOST_SIZES * settles.size() || self.ticks == MOST_TICKS {
                return if settles.is_led(CREEPING) && left <= CREEPING {
                    Ok(true)
                } else {
                    Err(Restless::Moving(settles.since(), speed))
                };
            }
            let most = (WAY_PER_SPACING * settles.spacing() / way).clamp(0.1, 2.0);
            let longest = settles.longest_at(self.longest, speed);
            self.dt = (self.dt * most).clamp(SHORTEST * longest, longest);
        }
        Ok(false)
    }

    /// Whether it has long gone to and fro about one place, under forces of `largest` N.
    fn stays(&mut self, settles: &impl Settles, largest: f64) -> bool {
        let now = settles.is_led(NEAR_GOAL).then(|| Now {
            tick: self.ticks,
            since: settles.since(),
            at: settles.placements(),
            size: settles.size(),
            speed: settles.mobility() * largest,
        });
        self.staying.is_over(now)
    }
}

/// Ticks until it rests.
///
/// # Errors
/// [`Restless`]; it is where it came to.
pub fn settle(settles: &mut impl Settles) -> Result<(), Restless> {
    Settling::of(settles).go_on(settles, MOST_TICKS).map(drop)
}

/// The largest of some forces, N.
fn largest(forces: &[DVec3]) -> f64 {
    (forces.iter()).fold(0.0_f64, |most, force| most.max(force.length()))
}

/// By how much a force has changed at most, N.
fn change(before: &[DVec3], now: &[DVec3]) -> f64 {
    let pairs = before.iter().zip(now);
    pairs.fold(0.0_f64, |most, (a, b)| most.max(a.distance(*b)))
}

fn share_of(part: f64, whole: f64) -> f64 {
    if part == 0.0 { 0.0 } else { part / whole }
}

/// Whether forces have stayed as they were, or there are none.
pub(super) fn have_stayed(before: &[DVec3], now: &[DVec3]) -> bool {
    change(before, now) <= AT_REST * largest(now)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A weight of 1 N on a floor that pushes by a little else in each tick.
    struct Pushed<F: Fn(f64) -> f64> {
        tick: f64,
        beside: F,
        /// How far a newton takes it in a tick, m.
        mobility: f64,
        gone: f64,
    }

    impl<F: Fn(f64) -> f64> Settles for Pushed<F> {
        fn go(&mut self, _dt: f64) -> Result<f64, Restless> {
            self.tick += 1.0;
            self.gone += self.mobility * (self.beside)(self.tick);
            Ok(1e-9)
        }
        fn longest_tick(&self) -> f64 {
            1.0
        }
        fn forces(&self) -> Vec<DVec3> {
            vec![DVec3::Z * (1.0 + (self.beside)(self.tick))]
        }
        fn weight(&self) -> f64 {
            1.0
        }
        fn left(&self) -> f64 {
            (self.beside)(self.tick).abs()
        }
        fn is_led(&self, share: f64) -> bool {
            share >= 1e-7
        }
        fn spacing(&self) -> f64 {
            1e-3
        }
        fn size(&self) -> f64 {
            0.1
        }
        fn since(&self) -> f64 {
            self.tick
        }
        fn placements(&self) -> Vec<Placement> {
            vec![Placement {
                position: DVec3::X * self.gone,
                ..Placement::default()
            }]
        }
        fn mobility(&self) -> f64 {
            self.mobility
        }
    }

    fn ticks(beside: impl Fn(f64) -> f64) -> Option<f64> {
        let mut pushed = Pushed {
            tick: 0.0,
            beside,
            mobility: 0.01,
            gone: 0.0,
        };
        let rests = Settling::of(&pushed).go_on(&mut pushed, 1000);
        rests.ok()?.then_some(pushed.tick)
    }

    #[test]
    fn what_sticks_and_slips_for_ever_so_little_rests() {
        let wavers = |tick: f64| 1e-7 * (0.7 * tick).sin();
        assert!(ticks(wavers).is_some_and(|ticks| ticks < 100.0));
        let grows = |tick: f64| 1e-8 * 1.016_f64.powf(tick);
        assert!(ticks(grows).is_some_and(|ticks| ticks < 100.0));
    }

    #[test]
    fn what_goes_to_and_fro_about_one_place_rests_there_after_a_while() {
        let rests = ticks(|tick| 1e-4 * (0.7 * tick).sin());
        assert!(rests.is_some_and(|ticks| ticks > 60.0 && ticks < 200.0));
    }

    #[test]
    fn what_goes_on_or_comes_to_rest_ever_more_slowly_goes_on() {
        assert_eq!(ticks(|_| 1e-4), None);
        assert_eq!(ticks(|tick| 1e-4 * (1.0 + (0.7 * tick).sin())), None);
        assert_eq!(ticks(|tick| 1e-3 * 0.998_f64.powf(tick)), None);
    }
}
