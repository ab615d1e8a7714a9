//! Softenings under a finger, as they come in.

use super::{BLEND_SECONDS, Felt, Softening, Softenings};

/// Softenings under a finger, brought in gradually as they become known.
#[derive(Debug, Clone, Copy)]
pub struct Blend {
    /// From 0, linear, to 1, corrected; `None` while nothing is touched: then it begins anew.
    choice: Option<f64>,
    nodes: [u32; 3],
    /// Share of each node's softening that is in, but for the choice.
    shares: [f64; 3],
}

impl Default for Blend {
    fn default() -> Self {
        Self {
            choice: None,
            nodes: [u32::MAX; 3],
            shares: [0.0; 3],
        }
    }
}

impl Blend {
    /// Nothing is touched.
    pub fn let_go(&mut self) {
        *self = Self::default();
    }

    /// Share of the corrected relation that is felt at a place of the triangle, 0 to 1.
    pub fn share(&self, alpha: [f64; 3]) -> f64 {
        let choice = self.choice.unwrap_or(0.0);
        (self.shares.iter().zip(alpha))
            .map(|(share, a)| choice * share * a)
            .sum()
    }

    /// Whether all that was chosen and is known is in.
    pub fn is_settled(&self) -> bool {
        let is_whole = |share: f64| share == 0.0 || share == 1.0;
        self.choice.is_none_or(is_whole) && self.shares.into_iter().all(is_whole)
    }

    /// A tick of `dt` seconds on a triangle with these nodes; their softenings as they are felt.
    ///
    /// A node met for the first time counts at once, for it carries nothing yet; what becomes known
    /// of one that is held already, and another choice, come in over [`BLEND_SECONDS`].
    pub fn follow(
        &mut self,
        softenings: &Softenings,
        nodes: [u32; 3],
        felt: Felt,
        dt: f64,
    ) -> [Softening; 3] {
        let step = dt / BLEND_SECONDS;
        let aim = f64::from(u8::from(felt == Felt::Corrected));
        let choice = match self.choice {
            Some(now) => now + (aim - now).clamp(-step, step),
            None => aim,
        };
        let mut blended = [Softening::default(); 3];
        let mut known = [0.0; 3];
        for (k, &node) in nodes.iter().enumerate() {
            let before = (self.nodes.iter().position(|&n| n == node)).map(|at| self.shares[at]);
            let Some(softening) = softenings.of(node) else {
                continue;
            };
            known[k] = before.map_or(1.0, |share| (share + step).min(1.0));
            blended[k] = Softening::default().plus(&softening, choice * known[k]);
        }
        (self.choice, self.nodes, self.shares) = (Some(choice), nodes, known);
        blended
    }
}
