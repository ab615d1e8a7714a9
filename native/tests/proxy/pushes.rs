//! Random quantised pushes: none falls through, none sticks. The same judge looks at 100,000 pushes
//! a body and quantum in `cargo run --release --example proxy_pushes`; here it looks at a share.

use crate::bodies::{Dice, pushed_bodies};
use crate::pushing::{Outcome, Push, QUANTA};
use palpate_servo::proxy::Feel;

const PUSHES: usize = 80;

fn push_everything(feel: &Feel, seed: u64) {
    for (name, body) in pushed_bodies() {
        let mut dice = Dice::new(seed);
        let mut held = 0;
        for quantum in QUANTA {
            for number in 0..PUSHES {
                let push = Push::random(&body, &mut dice, number, quantum);
                match push.judge(&body, feel, |_, _, _| {}) {
                    Outcome::Inside | Outcome::Missed => {}
                    Outcome::Held => held += 1,
                    failed => panic!("{name}, {quantum} m, push {number}: {failed:?}"),
                }
            }
        }
        assert!(held > 2 * PUSHES, "{name}: only {held} pushes touched");
    }
}

#[test]
fn no_push_falls_through_or_sticks() {
    push_everything(&Feel::default(), 7);
}

#[test]
fn no_push_falls_through_or_sticks_with_shading_and_friction() {
    let feel = Feel {
        shading: true,
        static_friction: 0.5,
        dynamic_friction: 0.4,
        ..Feel::default()
    };
    push_everything(&feel, 8);
}

#[test]
fn no_push_falls_through_or_sticks_with_friction_alone() {
    let feel = Feel {
        shading: false,
        static_friction: 0.9,
        dynamic_friction: 0.2,
        ..Feel::default()
    };
    push_everything(&feel, 9);
}
