//! What a tick shows besides its snapshot, and where other bodies are.

use crate::pile::laid::Lying;
use crate::servo::Servo;

impl Servo {
    /// Publishes what the body remembers, where that is or was anything.
    pub(in crate::servo) fn show_memory(&mut self, tick: u64, young_modulus: f64) {
        let memory = &self.engine.memories()[0];
        if !(memory.is_empty() && self.remembers_nothing) {
            (self.remembered.input_buffer_mut()).show(tick, memory, young_modulus);
            self.remembered.publish();
        }
        self.remembers_nothing = memory.is_empty();
    }

    /// Publishes what bears the body and those that it presses, where that is or was anything.
    pub(in crate::servo) fn show_borne(&mut self, tick: u64, is_held: bool, young_modulus: f64) {
        let lying = self.prop.held.as_deref().filter(|_| !is_held);
        if lying.is_some() || !self.nothing_bears {
            let borne = self.borne.input_buffer_mut();
            borne.clear(tick);
            match lying {
                Some(Lying::Alone(prop)) => {
                    let forces = prop.borne();
                    borne.show(0, forces.map(|(node, force)| (node, force * young_modulus)));
                }
                Some(Lying::Among(among)) => {
                    for body in 0..among.count() {
                        borne.show(body, among.borne(body));
                    }
                }
                None => {}
            }
            self.borne.publish();
        }
        self.nothing_bears = lying.is_none();
    }

    /// Has the snapshot tell where others are that the body presses.
    pub(in crate::servo) fn show_others(&mut self, is_held: bool) {
        let published = self.snapshots.input_buffer_mut();
        published.other_count = 0;
        if let Some(Lying::Among(among)) = self.prop.held.as_deref().filter(|_| !is_held) {
            for (told, other) in published.others.iter_mut().zip(among.others()) {
                *told = other;
                published.other_count += 1;
            }
        }
    }
}
