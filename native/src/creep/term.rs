//! A term of a Prony series.

/// Terms of a series; three span four decades of time to a few percent.
pub const MOST_TERMS: usize = 3;

/// A term of a Prony series.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Term {
    /// Of the modulus in the end, that is there besides at first. In a creep series: of the
    /// compliance at once, that comes later.
    pub share: f64,
    /// s.
    pub seconds: f64,
}
