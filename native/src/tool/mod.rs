//! Rigid tools against the body: a fingertip, plate, rod or convex hull, in the tick.
//!
//! The [`shape`] of a tool meets [`points`] fixed on the body's surface; those near it form a
//! [`patch`], whose forces may only push ([`complementarity`]). A [`collider`] is such a tool on its
//! way. Readable references: `core/contact/tool/tools.py`,
//! `core/contact/near_field/contact_points.py`.

pub(crate) mod blocks;
pub mod coefficients;
pub mod collider;
pub mod complementarity;
pub mod effort;
pub mod friction;
pub mod near_field;
pub mod patch;
pub mod points;
pub mod shape;
pub mod slot;
