//! Fingers without a clock: the tick's own contact, stepped until nothing changes any more.

use std::sync::Arc;

use glam::DVec3;

use super::Engine;
use super::goals::{Goal, PointTouch, Toucher, Unsettled, between};
use super::joint::{AllLed, Led};
use super::stillness::{MOST_TICKS, SETTLED, Stillness};
use crate::body::surface::Body;
use crate::contact::cones::MAX_FINGERS;
use crate::contact::ground::{Ground, MOST_TOOLS};
use crate::contact::touch::{ContactMode, touch};
use crate::creep::step::Step;
use crate::fingers::press::{Answers, Press, Presses};
use crate::proxy::SurfacePoint;

/// Rounding of a coordinate, as a share of the largest one, with room for what it makes of a force.
const ROUNDING: f64 = 1e-14;
/// Steps that a way may take.
const MOST_STEPS: usize = 10_000;

/// Fingers on one body.
#[derive(Debug, Clone)]
pub struct Settling {
    body: Arc<Body>,
    /// Pa.
    pub young_modulus: f64,
    mode: ContactMode,
    /// All of the way matters, not its end alone.
    rubs: bool,
    engine: Engine,
    /// By number.
    pub touchers: Vec<Toucher>,
}

impl Settling {
    /// Fingers that touch nothing yet.
    pub fn new(
        body: Arc<Body>,
        touchers: Vec<Toucher>,
        young_modulus: f64,
        mode: ContactMode,
        rubs: bool,
    ) -> Self {
        Self {
            body,
            young_modulus,
            mode,
            rubs,
            engine: Engine::default(),
            touchers,
        }
    }

    /// All fingers go to their goals together, in equal steps of at most a stride of each tool; where
    /// tools rub each step is settled, else the end.
    ///
    /// # Errors
    /// [`Unsettled`]; the contact is where it came to.
    pub fn settle(&mut self, goals: &[Goal]) -> Result<(), Unsettled> {
        let starts = self.starts(goals)?;
        let mut steps = 1;
        for (number, (start, goal)) in starts.iter().zip(goals).enumerate() {
            let needed = self.strides(number, start, goal);
            if needed > MOST_STEPS as f64 {
                return Err(Unsettled::TooFar(number));
            }
            steps = steps.max(needed as usize);
        }
        for step in 1..=steps {
            let share = step as f64 / steps as f64;
            let between = |(start, goal)| between(start, goal, share);
            let here: Vec<Goal> = starts.iter().zip(goals).map(between).collect();
            if self.rubs || step == steps {
                self.rest_at(&here)?;
            } else {
                self.tick(&here)?;
            }
        }
        Ok(())
    }

    /// Where the way to the goals begins: where fingers are, or outside of the body.
    fn starts(&mut self, goals: &[Goal]) -> Result<Vec<Goal>, Unsettled> {
        let mut starts = Vec::with_capacity(goals.len());
        for (number, (toucher, goal)) in self.touchers.iter_mut().zip(goals).enumerate() {
            starts.push(match (toucher, goal) {
                (Toucher::Point(point), Goal::Point(hold, _)) => {
                    let same = point.at.filter(|(at, _)| at == hold);
                    Goal::Point(*hold, same.map_or(DVec3::ZERO, |(_, moved)| moved))
                }
                (Toucher::Tool(tool), Goal::Tool(pose)) => {
                    if tool.pose().is_none() {
                        let out = tool.way_out(pose).ok_or(Unsettled::NoWayOut(number))?;
                        tool.restart(&out);
                    }
                    Goal::Tool(tool.pose().copied().unwrap_or(*pose))
                }
                _ => return Err(Unsettled::OtherTip(number)),
            });
        }
        Ok(starts)
    }

    /// How many strides a finger is from its goal.
    fn strides(&self, number: usize, start: &Goal, goal: &Goal) -> f64 {
        match (&self.touchers[number], start, goal) {
            (Toucher::Tool(tool), Goal::Tool(start), Goal::Tool(goal)) => {
                let (way, turn) = start.way_to(goal);
                let tool = tool.tool();
                let length = way.length() + turn.length() * tool.reach();
                (length / tool.stride() * (1.0 - 1e-12)).ceil()
            }
            _ => 1.0,
        }
    }

    /// Ticks at one place until the forces stay.
    fn rest_at(&mut self, goals: &[Goal]) -> Result<(), Unsettled> {
        let (mut stillness, mut moving) = (Stillness::default(), (0, f64::INFINITY));
        for _ in 0..MOST_TICKS {
            moving = self.tick(goals)?;
            stillness.take(moving.1);
            if stillness.is_reached() {
                return Ok(());
            }
        }
        Err(Unsettled::Moving(moving.0, moving.1))
    }

    /// One tick: whose force changed most, and by which share of the largest.
    fn tick(&mut self, goals: &[Goal]) -> Result<(usize, f64), Unsettled> {
        let before: Vec<DVec3> = (0..goals.len()).map(|number| self.force(number)).collect();
        let presses = self.presses(goals);
        let mut led: AllLed<'_> = [const { None }; MOST_TOOLS];
        for (led, (toucher, goal)) in led.iter_mut().zip(self.touchers.iter_mut().zip(goals)) {
            if let (Toucher::Tool(collider), Goal::Tool(pose)) = (toucher, goal) {
                *led = Some(Led {
                    collider,
                    goal: *pose,
                    presence: 1.0,
                });
            }
        }
        let ground = Ground {
            body: &self.body,
            number: 0,
            young_modulus: self.young_modulus,
            mobility: None,
            creep: Step::default(),
        };
        let answers = self.engine.tick(&[ground], &presses, &mut led);
        self.take(goals, answers.as_ref());
        let largest = (before.iter().enumerate())
            .map(|(number, before)| self.force(number).length().max(before.length()))
            .fold(self.rounding() / SETTLED, f64::max);
        let mut most = (0, 0.0);
        for (number, before) in before.iter().enumerate() {
            let force = self.force(number);
            if !force.is_finite() {
                return Err(Unsettled::NotANumber(number));
            }
            let change = force.distance(*before);
            if change > most.1 * largest {
                most = (number, change / largest);
            }
        }
        Ok(most)
    }

    /// A force of this size, N, is what coordinates are rounded by: a tool that grazes the body feels it
    /// or does not.
    fn rounding(&self) -> f64 {
        ROUNDING * self.young_modulus * self.body.size() * self.body.reach()
    }

    fn force(&self, number: usize) -> DVec3 {
        match &self.touchers[number] {
            Toucher::Point(point) => point.force,
            Toucher::Tool(tool) => tool.felt().map_or(DVec3::NAN, |felt| felt.force),
        }
    }

    /// The points as they see each other; none where each is answered as if it were alone.
    fn presses(&self, goals: &[Goal]) -> Presses {
        let mut presses = [None; MAX_FINGERS];
        if goals.len() > 1 && self.mode == ContactMode::Consistent {
            for (press, goal) in presses.iter_mut().zip(goals) {
                if let Goal::Point(hold, displacement) = goal {
                    *press = Some(self.press(*hold, *displacement));
                }
            }
        }
        presses
    }

    /// What the points feel.
    fn take(&mut self, goals: &[Goal], answers: Option<&Answers>) {
        for (number, goal) in goals.iter().enumerate() {
            let Goal::Point(hold, displacement) = goal else {
                continue;
            };
            let (force, nodal_forces) = match answers {
                Some(answers) => {
                    let answer = &answers[number];
                    let share = |alpha| answer.force * (alpha * self.young_modulus);
                    let force = answer.contact_force * -self.young_modulus;
                    (force, hold.alpha.map(share))
                }
                None => self.alone(hold, *displacement),
            };
            if let Toucher::Point(point) = &mut self.touchers[number] {
                *point = PointTouch {
                    at: Some((*hold, *displacement)),
                    force,
                    nodal_forces,
                };
            }
        }
    }

    /// The force felt by a point that is alone, and those on the nodes, N.
    fn alone(&self, hold: &SurfacePoint, displacement: DVec3) -> (DVec3, [DVec3; 3]) {
        let (body, modulus) = (&self.body, self.young_modulus);
        let found = touch(
            body,
            self.mode,
            hold.triangle,
            hold.alpha,
            displacement,
            modulus,
        );
        (found.force, found.nodal_forces)
    }

    /// A point as the others see it. One that does not travel rests, and pushes back inwards.
    fn press(&self, hold: SurfacePoint, displacement: DVec3) -> Press {
        let push = if displacement == DVec3::ZERO {
            -self.body.face(hold.triangle).normal
        } else {
            displacement
        };
        Press {
            body: 0,
            hold,
            touches: true,
            displacement,
            push,
            cone: None,
            most_stiffness: f64::INFINITY,
            presence: 1.0,
            remembered: DVec3::ZERO,
            carried: DVec3::ZERO,
        }
    }
}
