//! Why there is no guardian.

use std::fmt::Display;
use std::io;

/// No guardian, with the reason.
pub(super) fn refused(why: impl Display) -> io::Error {
    io::Error::other(format!("its guardian process cannot be started: {why}"))
}
