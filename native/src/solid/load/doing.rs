//! What places do that tools press: by which the way of the body is chosen, step by step.

/// What a place does, as far as steps are chosen by it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Doing {
    pub place: usize,
    pub presses: bool,
    /// Whether it slides; none of what nothing holds.
    pub slides: Option<bool>,
}

/// How many places press of which the other ones do not, and how many stick or slide of which those do not.
pub fn changed(before: &[Doing], now: &[Doing]) -> (usize, usize) {
    let (mut before, mut now) = (before.iter().peekable(), now.iter().peekable());
    let (mut pressing, mut sliding) = (0, 0);
    while let (Some(one), Some(other)) = (before.peek(), now.peek()) {
        let is_one = one.place == other.place;
        pressing += usize::from(!is_one || one.presses != other.presses);
        sliding += usize::from(is_one && one.slides != other.slides);
        let (one, other) = (one.place, other.place);
        before.next_if(|_| one <= other);
        now.next_if(|_| other <= one);
    }
    (pressing + before.count() + now.count(), sliding)
}
