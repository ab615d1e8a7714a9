//! Where contacts were when the matrix of a system was made, and whether it will still do.
//!
//! What contacts are moved by forces that stay is known without it. So a matrix of contacts that lie a little
//! otherwise errs in what *changes* in a tick alone, by as small a share, and the next tick finds that. All
//! of it is of one moment: as it is, it tells how bodies give way that lie as they lay then.

use glam::{DMat3, DVec3};

use crate::contact::mobility::Mobility;
use crate::pile::contact::{Against, Contact, Shares};
use crate::pile::member::Member;

/// Directions may be turned, rad, and places be moved, as a share of the body's reach, by so much at most.
const MOST_TURNED: f64 = 3e-3;
/// Forces that balance make one of such a share then, which moves the body as a whole: by so much at most of
/// what they press a place in.
const MOST_CARRIED: f64 = 1e-4;

/// By how much contacts of a body may lie otherwise.
fn turned(member: &Member) -> f64 {
    let shift = member.mobility.map_or(0.0, |mobility| mobility.shift);
    (MOST_CARRIED * member.gives() / shift).min(MOST_TURNED)
}

/// A contact as its bodies have it.
#[derive(Debug, Clone)]
struct Lay {
    whose: (usize, u32, Against),
    shares: Shares,
    on: [Option<OnBody>; 2],
}

/// Directions and place of a contact in the axes of a body.
#[derive(Debug, Clone, Copy)]
struct OnBody {
    ways: DMat3,
    place: DVec3,
}

impl OnBody {
    fn of(contact: &Contact, directions: &DMat3, body: usize, member: &Member) -> Self {
        let turn = DMat3::from_quat(member.placement.rotation.inverse());
        Self {
            ways: turn * *directions,
            place: member.arm(contact.shares_on(body)),
        }
    }

    fn is_near(&self, other: &Self, turned: f64, reach: f64) -> bool {
        let ways = self.ways - other.ways;
        let turns = ways.x_axis.length().max(ways.y_axis.length());
        turns <= turned && self.place.distance(other.place) <= turned * reach
    }
}

/// What a matrix was made of.
#[derive(Debug, Clone, Default)]
pub(super) struct Kept {
    lays: Vec<Lay>,
    rubs: Vec<usize>,
    members: Vec<(f64, Option<Mobility>)>,
}

impl Kept {
    /// Takes all memory that it ever needs for so many contacts of so many bodies.
    pub(super) fn reserve(&mut self, contacts: usize, bodies: usize) {
        self.lays.reserve(contacts);
        self.rubs.reserve(contacts);
        self.members.reserve(bodies);
    }

    /// Takes down what a matrix is made of: contacts that are `chosen`, their directions in the world, and which
    /// of them rub.
    pub(super) fn take(
        &mut self,
        (contacts, chosen): (&[Contact], &[usize]),
        members: &[Member],
        (directions, rubs): (&[DMat3], &[usize]),
    ) {
        self.rubs.clear();
        self.rubs.extend_from_slice(rubs);
        self.members.clear();
        let told = members.iter().map(|one| (one.young_modulus, one.mobility));
        self.members.extend(told);
        self.lays.clear();
        let places = chosen.iter().zip(directions);
        self.lays.extend(places.map(|(&number, directions)| {
            let contact = &contacts[number];
            let on = |body: usize| OnBody::of(contact, directions, body, &members[body]);
            Lay {
                whose: (contact.body, contact.point, contact.against),
                shares: contact.shares,
                on: bodies_of(contact).map(|body| body.map(on)),
            }
        }));
    }

    /// Whether the matrix will do for these.
    pub(super) fn is_near(
        &self,
        (contacts, chosen): (&[Contact], &[usize]),
        members: &[Member],
        (directions, rubs): (&[DMat3], &[usize]),
    ) -> bool {
        let is_same = |(told, member): (&(f64, Option<Mobility>), &Member)| {
            let moves = match (&told.1, &member.mobility) {
                (Some(told), Some(now)) => told.is_alike(now),
                (told, now) => told.is_none() && now.is_none(),
            };
            told.0 == member.young_modulus && moves
        };
        let is_near = |((lay, &number), directions): ((&Lay, &usize), &DMat3)| {
            let contact = &contacts[number];
            lay.whose == (contact.body, contact.point, contact.against)
                && (bodies_of(contact).into_iter().zip(&lay.on)).all(|(body, told)| {
                    let (Some(body), Some(told)) = (body, told) else {
                        return true;
                    };
                    let member = &members[body];
                    let now = OnBody::of(contact, directions, body, member);
                    let turned = turned(member);
                    told.is_near(&now, turned, member.reach())
                        && lay.shares.is_near(&contact.shares, turned)
                })
        };
        self.members.len() == members.len()
            && self.lays.len() == chosen.len()
            && self.rubs == rubs
            && self.members.iter().zip(members).all(is_same)
            && (self.lays.iter().zip(chosen).zip(directions)).all(is_near)
    }
}

/// The bodies of a contact.
pub(super) fn bodies_of(contact: &Contact) -> [Option<usize>; 2] {
    [Some(contact.body), contact.other()]
}
