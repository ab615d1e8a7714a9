//! All that touches one body at once, as one problem of contact: for the tick, and for whoever has no
//! clock.

pub mod settling;
