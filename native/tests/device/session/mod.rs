//! What ends a session, and how one begins anew.

mod begun_anew;
mod deaf;
