//! Bodies that give way with time: what past forces still do to the surface.
//!
//! A body's Young's modulus relaxes, E(t) = E (1 + sum of s_i e^(-t / t_i)), at a constant Poisson's
//! ratio. So the compliance L of the surface at unit modulus stays what it is, and what a history of
//! forces does is L times what each of its nodes remembers of its own force:
//!
//! ```text
//! u = L (f + sum of g_k)     f = F / E_0     th_k dg_k/dt + g_k = c_k f
//! ```
//!
//! with E_0 the modulus at once. State is kept where forces were, on the surface and not with a finger:
//! one that comes back meets its dent. Contact sees a body of another modulus whose surface has been
//! moved by what is remembered, as other fingers would move it.

pub mod memory;
pub mod relaxation;
pub mod shown;
pub mod step;
pub mod term;
