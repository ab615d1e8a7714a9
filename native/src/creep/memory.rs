//! What the nodes of a surface remember of the forces on them.

use glam::{DMat3, DVec3};

use super::step::{Step, Trace};

/// Nodes that remember; of more, the one that remembers least leaves that to the nearest other.
pub const MOST_REMEMBERED: usize = 1024;
/// Nodes that can be loaded in one tick.
const MOST_LOADED: usize = 1024;
/// Of the most that was remembered since nothing was, what is less than this is forgotten.
const FORGOTTEN: f64 = 1e-7;

/// A node that remembers.
#[derive(Debug, Clone, Copy, Default)]
pub struct Node {
    /// Its number.
    pub number: u32,
    /// Of its forces over the modulus at once, m^2.
    pub trace: Trace,
    /// What of that there was at the end of the last tick and will be of this, but for what comes in
    /// it, m^2.
    ahead: [DVec3; 2],
}

/// Nodes that remember, and what; allocates all it ever needs.
#[derive(Debug, Clone)]
pub struct Memory {
    body: u32,
    step: Step,
    /// By node, ascending.
    nodes: Vec<Node>,
    merged: Vec<Node>,
    loads: Vec<(u32, DVec3)>,
    most: f64,
}

impl Default for Memory {
    fn default() -> Self {
        let room = MOST_REMEMBERED + MOST_LOADED;
        Self {
            body: u32::MAX,
            step: Step::default(),
            nodes: Vec::with_capacity(room),
            merged: Vec::with_capacity(room),
            loads: Vec::with_capacity(MOST_LOADED),
            most: 0.0,
        }
    }
}

impl Memory {
    /// Begins a tick of a numbered body; another one remembers nothing.
    pub fn begin(&mut self, body: u32, step: &Step) {
        if self.body != body || step.is_none() {
            self.nodes.clear();
        }
        (self.body, self.step) = (body, *step);
        for node in &mut self.nodes {
            node.ahead = [node.ahead[1], node.trace.ahead(step)];
        }
        self.loads.clear();
    }

    /// Whether it remembers nothing.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.nodes.is_empty()
    }

    /// The tick that it is in.
    #[inline]
    pub fn step(&self) -> &Step {
        &self.step
    }

    /// All nodes that remember.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// How far a place moves by what is remembered, at the end of the last tick and of this one, m.
    /// `block` is L at unit modulus between two nodes.
    pub fn moved(
        &self,
        place: &[(u32, f64)],
        mut block: impl FnMut(u32, u32) -> DMat3,
    ) -> [DVec3; 2] {
        let mut moved = [DVec3::ZERO; 2];
        for &(seen, weight) in place.iter().filter(|(_, weight)| *weight != 0.0) {
            for node in &self.nodes {
                let block = block(seen, node.number) * weight;
                for (moved, ahead) in moved.iter_mut().zip(node.ahead) {
                    *moved += block * ahead;
                }
            }
        }
        moved
    }

    /// What a place remembers of its own displacement, m.
    pub fn trace(&self, place: &[(u32, f64)], mut block: impl FnMut(u32, u32) -> DMat3) -> Trace {
        let mut sum = Trace::default();
        for &(seen, weight) in place.iter().filter(|(_, weight)| *weight != 0.0) {
            for node in &self.nodes {
                sum += node.trace.seen_by(&(block(seen, node.number) * weight));
            }
        }
        sum
    }

    /// A force on a node at the end of this tick, over the modulus of the tick, m^2.
    pub fn load(&mut self, node: u32, force: DVec3) {
        if force != DVec3::ZERO && force.is_finite() && self.loads.len() < MOST_LOADED {
            self.loads.push((node, force * self.step.at_once()));
        }
    }

    /// Ends the tick. `positions` are those of all nodes of the body, m.
    pub fn end(&mut self, positions: &[DVec3]) {
        if self.step.is_none() || (self.nodes.is_empty() && self.loads.is_empty()) {
            return;
        }
        self.loads.sort_unstable_by_key(|load| load.0);
        let mut loads = self.loads.iter().copied().peekable();
        self.merged.clear();
        let mut nodes = self.nodes.iter().copied().peekable();
        loop {
            let next = |known: Option<u32>, loaded: Option<u32>| match (known, loaded) {
                (Some(known), Some(loaded)) => Some(known.min(loaded)),
                (known, loaded) => known.or(loaded),
            };
            let Some(number) = next(nodes.peek().map(|n| n.number), loads.peek().map(|l| l.0))
            else {
                break;
            };
            let known = nodes.next_if(|known| known.number == number);
            let mut node = known.unwrap_or(Node {
                number,
                ..Node::default()
            });
            let mut now = DVec3::ZERO;
            while let Some((_, force)) = loads.next_if(|load| load.0 == number) {
                now += force;
            }
            node.trace.advance(&self.step, now);
            self.merged.push(node);
        }
        std::mem::swap(&mut self.nodes, &mut self.merged);
        self.forget(positions);
    }

    /// Drops what is next to nothing, and what there is no room for.
    fn forget(&mut self, positions: &[DVec3]) {
        let largest = |most: f64, node: &Node| most.max(node.trace.size());
        self.most = self.nodes.iter().fold(self.most, largest);
        let least = FORGOTTEN * self.most;
        (self.nodes).retain(|node| node.trace.is_loaded() || node.trace.size() > least);
        while self.nodes.len() > MOST_REMEMBERED {
            self.pass_on(positions);
        }
        if self.nodes.is_empty() {
            self.most = 0.0;
        }
    }

    /// The node that remembers least leaves that to the nearest other.
    fn pass_on(&mut self, positions: &[DVec3]) {
        let sizes = self.nodes.iter().map(|node| node.trace.size());
        let Some((weakest, _)) = sizes.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)) else {
            return;
        };
        let gone = self.nodes.remove(weakest);
        let at = positions[gone.number as usize];
        let away = |node: &Node| positions[node.number as usize].distance_squared(at);
        let nearest = (self.nodes.iter_mut()).min_by(|a, b| away(a).total_cmp(&away(b)));
        if let Some(nearest) = nearest {
            nearest.trace += gone.trace;
        }
    }
}
