//! Marks on contact points, all taken off at once.

/// Which points are marked.
#[derive(Debug, Clone, Default)]
pub(crate) struct Marks {
    turns: Vec<u32>,
    turn: u32,
}

impl Marks {
    pub(super) fn new(points: usize) -> Self {
        Self {
            turns: vec![0; points],
            turn: 0,
        }
    }

    pub(crate) fn begin(&mut self) {
        self.turn = self.turn.wrapping_add(1);
    }

    pub(crate) fn set(&mut self, point: u32) {
        self.turns[point as usize] = self.turn;
    }

    #[inline]
    pub(crate) fn has(&self, point: u32) -> bool {
        self.turns[point as usize] == self.turn
    }
}
