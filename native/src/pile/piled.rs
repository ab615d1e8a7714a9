//! Bodies that press each other, tick by tick.

use super::contact::{Against, Contact};
use super::meeting::{MOST_CONTACTS, Meeting, look, rank, share_out};
use super::member::Member;
use super::obstacle::{Around, Obstacle, Rigid};
use super::solve::pace::Pace;
use super::solve::{Given, Solver};
use crate::rest::resting::Restless;
use glam::DVec3;

/// A force aside within this share of its limit slips.
const SLIPPING: f64 = 1.0 - 1e-7;

/// A point that is found deep in another body is pressed out by so many distances between points in
/// each tick, instead of throwing both apart in one.
const OUT: f64 = 0.01;

/// Bodies, and what they meet besides each other.
#[derive(Debug, Clone)]
pub struct Pile {
    /// By number.
    pub members: Vec<Member>,
    /// By number.
    pub obstacles: Vec<Obstacle>,
    /// In the world, m/s^2.
    pub gravity: DVec3,
    /// Coulomb's coefficient between bodies.
    pub friction: f64,
    pub(super) pace: Pace,
    pub(super) contacts: Vec<Contact>,
    pub(super) solver: Solver,
    meeting: Meeting,
    /// Contacts by number, those first that are kept first, and which of them there is room for.
    ranked: Vec<usize>,
    fits: Vec<bool>,
    time: f64,
}

impl Pile {
    /// Bodies that touch nothing yet.
    pub fn new(
        members: Vec<Member>,
        obstacles: Vec<Obstacle>,
        gravity: DVec3,
        friction: f64,
    ) -> Self {
        Self {
            members,
            obstacles,
            gravity,
            friction,
            pace: Pace::UNHURRIED,
            contacts: Vec::new(),
            solver: Solver::default(),
            meeting: Meeting::default(),
            ranked: Vec::new(),
            fits: Vec::new(),
            time: 0.0,
        }
    }

    /// From now on a tick takes bounded work, and no memory.
    pub fn hurry(&mut self) {
        self.pace = Pace::IN_TICK;
        let room = self.pace.room;
        (self.members.iter_mut()).for_each(|member| member.reserve(room));
        (self.solver, self.meeting) = (Solver::default(), Meeting::default());
        self.solver.reserve(room, self.members.len());
        self.contacts.reserve(MOST_CONTACTS);
        self.ranked.reserve(MOST_CONTACTS);
        self.fits.reserve(MOST_CONTACTS);
    }

    /// Since the beginning, s.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// All contact points near anything; those that press have a push.
    pub fn contacts(&self) -> &[Contact] {
        &self.contacts
    }

    /// One tick of `dt` s; each member tells how it moved.
    ///
    /// # Errors
    /// [`Restless::NotANumber`].
    pub fn tick(&mut self, dt: f64) -> Result<(), Restless> {
        let stride = self.stride();
        for obstacle in &mut self.obstacles {
            obstacle.go(stride);
        }
        self.tick_with(&[], dt)
    }

    /// The same with tools that hands lead, where these are, and obstacles that stay.
    ///
    /// # Errors
    /// [`Restless::NotANumber`].
    pub(super) fn tick_with(
        &mut self,
        fingers: &[Option<Rigid<'_>>],
        dt: f64,
    ) -> Result<(), Restless> {
        self.find_contacts(fingers);
        for member in &mut self.members {
            member.begin(self.gravity, dt);
        }
        let given = Given {
            around: around(fingers, &self.obstacles),
            friction: self.friction,
            pace: self.pace,
        };
        (self.solver).solve(&mut self.contacts, &self.members, &given);
        self.displace();
        self.members.iter_mut().for_each(Member::move_on);
        self.look(fingers);
        self.take_anchors(fingers);
        self.time += dt;
        let mut motions = self.members.iter().map(|member| member.motion);
        let mut forces = self.contacts.iter().map(Contact::force);
        if motions.all(|motion| motion.is_finite()) && forces.all(DVec3::is_finite) {
            Ok(())
        } else {
            Err(Restless::NotANumber)
        }
    }

    /// Forgets contacts with what is said.
    pub(super) fn let_go(&mut self, goes: impl Fn(Against) -> bool) {
        self.contacts.retain(|contact| !goes(contact.against));
    }

    /// How far an obstacle goes in a tick at most, m.
    fn stride(&self) -> f64 {
        0.5 * self.spacing()
    }

    /// The least distance between contact points, m.
    pub(super) fn spacing(&self) -> f64 {
        let members = self.members.iter();
        let spacings = members.map(|member| member.touchable.own().spacing());
        spacings.fold(f64::INFINITY, f64::min)
    }

    /// Contacts come and go, and those between bodies share their forces out where they are now.
    fn find_contacts(&mut self, fingers: &[Option<Rigid<'_>>]) {
        let around = around(fingers, &self.obstacles);
        (self.meeting).meet(&mut self.contacts, &self.members, &around);
        // Between bodies, which have not moved since, the last tick has looked.
        let is_new =
            |contact: &&mut Contact| contact.gap.is_infinite() || contact.other().is_none();
        (self.contacts.iter_mut().filter(is_new))
            .for_each(|contact| look(contact, &self.members, &around));
        self.contacts.retain(|contact| contact.gap.is_finite());
        for contact in &mut self.contacts {
            share_out(contact, &self.members);
        }
        self.fit();
        self.members.iter_mut().for_each(Member::look_at_wanted);
        self.displace();
        self.look(fingers);
        if self.time > 0.0 {
            for contact in &mut self.contacts {
                let by = OUT * self.members[contact.body].touchable.own().spacing();
                contact.come_out(by, 2.0 * by);
            }
        }
    }

    /// Finds which contact points of each body are looked at. Contacts for which there is no room go,
    /// the farthest first.
    fn fit(&mut self) {
        self.ranked.clear();
        self.ranked.extend(0..self.contacts.len());
        // Where there is room for all it does not matter which is the first.
        if !self.fit_in_turn() {
            rank(&mut self.ranked, &self.contacts);
            self.fit_in_turn();
            let mut fits = self.fits.iter();
            self.contacts.retain(|_| fits.next() == Some(&true));
        }
    }

    /// Finds which contacts there is room for, each as it is ranked; whether there is for all.
    fn fit_in_turn(&mut self) -> bool {
        let (members, contacts, pace) = (&mut self.members, &self.contacts, self.pace);
        members.iter_mut().for_each(Member::begin_wanting);
        self.fits.clear();
        self.fits.resize(contacts.len(), false);
        let (mut entered, mut all_fit) = (0, true);
        for &number in &self.ranked {
            let contact = &contacts[number];
            let bodies = [Some(contact.body), contact.other()];
            let new = bodies.into_iter().flatten().map(|body| {
                let (member, shares) = (&members[body], contact.shares_on(body).iter());
                let new = shares.filter(|share| !member.wants(share.0));
                let (wanted, entering) = new.fold((0, 0), |(wanted, entering), share| {
                    (
                        wanted + 1,
                        entering + usize::from(!member.looks_at(share.0)),
                    )
                });
                (member.wanted() + wanted <= pace.room, entering)
            });
            let (has_room, entering) =
                new.fold((true, 0), |all, one| (all.0 & one.0, all.1 + one.1));
            let waits = contact.push == 0.0 && entering > 0 && entered + entering > pace.entering;
            if !has_room || waits {
                all_fit = false;
                continue;
            }
            self.fits[number] = true;
            entered += entering;
            for body in bodies.into_iter().flatten() {
                let shares = contact.shares_on(body).iter();
                shares.for_each(|share| members[body].want(share.0));
            }
        }
        all_fit
    }

    fn look(&mut self, fingers: &[Option<Rigid<'_>>]) {
        let around = around(fingers, &self.obstacles);
        for contact in &mut self.contacts {
            look(contact, &self.members, &around);
        }
    }

    /// Displaces all bodies by the contacts' forces.
    fn displace(&mut self) {
        for (body, member) in self.members.iter_mut().enumerate() {
            let turn = member.placement.rotation.inverse();
            member.begin_loading();
            for contact in self.contacts.iter().filter(|contact| contact.push > 0.0) {
                let sign = contact.sign_on(body);
                if sign != 0.0 {
                    member.add_load(contact.shares_on(body), turn * contact.force() * sign);
                }
            }
            member.give_way();
        }
    }

    /// Points that stuck keep their anchors, others have them where they are.
    fn take_anchors(&mut self, fingers: &[Option<Rigid<'_>>]) {
        let around = around(fingers, &self.obstacles);
        for contact in &mut self.contacts {
            let limit = around.coefficient(contact, self.friction);
            if contact.push <= 0.0 {
                (contact.anchor, contact.slips) = (None, false);
                continue;
            }
            let is_held = contact.anchor.is_some();
            contact.slips = is_held && contact.aside.length() >= SLIPPING * limit * contact.push;
            if !is_held || contact.slips {
                contact.anchor = Some(contact.place);
            }
        }
    }
}

fn around<'a>(fingers: &'a [Option<Rigid<'a>>], obstacles: &'a [Obstacle]) -> Around<'a> {
    Around { fingers, obstacles }
}
