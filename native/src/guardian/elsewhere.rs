//! Systems without a guardian.

use std::io;

use crate::guardian::refusal::refused;

/// Never there.
#[derive(Debug)]
pub enum Guardian {}

impl Guardian {
    /// Says that there is none.
    ///
    /// # Errors
    /// Always.
    pub fn of<P>(_port: &P) -> io::Result<Self> {
        Err(refused("there is none for this system"))
    }

    /// Never called.
    pub fn live(&self, _last_word: &[u8]) -> bool {
        match *self {}
    }
}
