//! What a tick of a tool took, counted: the same tick counts the same on any machine.

/// Work of one tick.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Effort {
    /// Contact points that were looked at.
    pub near: usize,
    /// Of these, those that might have carried force.
    pub chosen: usize,
    /// Points that came in, and those that were let go.
    pub entered: usize,
    /// Points that were let go.
    pub left: usize,
    /// Blocks of the compliance that were not at hand.
    pub fetched: usize,
    /// Decompositions of a matrix.
    pub decompositions: usize,
    /// Multiplications of all, about.
    pub multiplications: usize,
}
