//! The real-time thread of Palpate: a probe meets a soft body at 1 kHz.
//!
//! The rooms stand in the order in which they use each other. A tick of the [`servo`] reads a
//! [`device`], moves the [`proxy`] (god object) on the rest surface of the [`body`], computes the
//! [`contact`] force, (11) to (14), of points, [`fingers`] and [`tool`]s, passes it through [`control`]
//! and gives it to the device; the [`clock`] says when. The tick allocates nothing, takes no lock
//! and knows nothing of Python; the feature `python` adds the thin binding, the feature `harness` what
//! only tests and benchmarks need.

pub mod algebra;
pub mod body;
pub mod clock;
pub mod contact;
pub mod control;
pub mod creep;
pub mod device;
pub mod drawn;
pub mod engine;
pub mod fingers;
pub mod fold;
pub mod guardian;
#[cfg(feature = "harness")]
pub mod harness;
pub mod pile;
pub mod proxy;
#[cfg(feature = "python")]
mod python;
pub mod rest;
pub mod servo;
pub mod solid;
pub mod tool;
