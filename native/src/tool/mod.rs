//! Rigid tools against the body: a fingertip, plate, rod or convex hull, in the tick.
//!
//! The [`shape`] of a tool meets [`points`] fixed on the body's surface; those near it form a
//! [`patch`], whose forces may only push ([`complementarity`]). [`contact`] follows the pose from tick
//! to tick. Readable references: `core/contact/tool/tools.py`, `core/contact/near_field/contact_points.py`, `core/contact/tool/tool_contact.py`.

mod blocks;
pub mod complementarity;
pub mod contact;
pub mod effort;
pub mod friction;
pub mod near_field;
pub mod patch;
pub mod points;
pub mod shape;
