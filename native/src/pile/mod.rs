//! Soft bodies that press each other: lying side by side, one on the other, on a floor, in hands.
//!
//! Contact points of one body meet the surface of the other. A force at such a place acts on both,
//! equal and opposite to the last bit; both give way under it, each by its own compliance and by its
//! own motion as a whole, and all contacts of all bodies are found together, without a clock.

pub mod among;
mod between;
pub mod contact;
pub mod laid;
mod meeting;
pub mod member;
pub mod obstacle;
mod outline;
pub mod piled;
pub mod settling;
mod shares;
mod solve;
