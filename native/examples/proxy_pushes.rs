//! How many random pushes fall through or stick:
//! `cargo run --release --example proxy_pushes -- [--pushes 100000] [NAME or MESH ...]`.
//!
//! Pushes so many times at each quantum, with the shape alone and with shading and friction, into
//! all test bodies or, where given, those of these names and meshes from text files: a line with the numbers of nodes and
//! of triangles, a line of three coordinates (m) a node, a line of three node numbers a triangle.

use std::sync::Arc;
use std::{env, fs};

use glam::DVec3;
use palpate_servo::body::surface::Body;
use palpate_servo::contact::touch::ContactMode;
use palpate_servo::proxy::Feel;

#[path = "../tests/bodies/mod.rs"]
mod bodies;
#[path = "../tests/proxy/pushing.rs"]
mod pushing;

use bodies::{Dice, pushed_bodies, soft};
use pushing::{Outcome, Push, QUANTA};

const PLAIN: Feel = Feel {
    shading: false,
    static_friction: 0.0,
    dynamic_friction: 0.0,
    mode: ContactMode::Consistent,
};
const RICH: Feel = Feel {
    shading: true,
    static_friction: 0.5,
    dynamic_friction: 0.4,
    mode: ContactMode::Consistent,
};

fn read_mesh(path: &str) -> Arc<Body> {
    let text = fs::read_to_string(path).unwrap_or_else(|e| panic!("cannot read {path}: {e}"));
    let mut words = text.split_ascii_whitespace();
    let mut next = || {
        words
            .next()
            .unwrap_or_else(|| panic!("{path} ends too early"))
    };
    let integer = |word: &str| word.parse::<u32>().expect("a whole number");
    let number = |word: &str| word.parse::<f64>().expect("a number");
    let (nodes, triangles) = (integer(next()), integer(next()));
    let nodes = (0..nodes)
        .map(|_| DVec3::from_array([0; 3].map(|_| number(next()))))
        .collect();
    let triangles = (0..triangles)
        .map(|_| [0; 3].map(|_| integer(next())))
        .collect();
    soft(nodes, triangles)
}

fn main() {
    let mut pushes = 100_000;
    let known = pushed_bodies();
    let mut named: Vec<(String, Arc<Body>)> = Vec::new();
    let mut arguments = env::args().skip(1);
    while let Some(argument) = arguments.next() {
        if argument == "--pushes" {
            let count = arguments.next().expect("--pushes takes a number");
            pushes = count.parse().expect("--pushes takes a number");
        } else if let Some((name, body)) = known.iter().find(|(name, _)| *name == argument) {
            named.push(((*name).to_owned(), body.clone()));
        } else {
            let name = argument.rsplit(['/', '.']).nth(1).unwrap_or("mesh");
            named.push((name.to_owned(), read_mesh(&argument)));
        }
    }
    if named.is_empty() {
        named.extend(known.into_iter().map(|(n, b)| (n.to_owned(), b)));
    }
    let quanta = QUANTA.map(|q| format!("{:>6.0} um", q * 1e6)).concat();
    println!("fell through, stuck or astray of {pushes} pushes at each quantum");
    println!(
        "{:<16} {:>9}  {:<18} {:>8}{quanta}",
        "body", "triangles", "feel", "touched"
    );
    let mut failures = 0;
    for (name, body) in named {
        for (feel, feel_name) in [(PLAIN, "shape"), (RICH, "shading, friction")] {
            let (mut touched, mut failed) = (0, [0; QUANTA.len()]);
            for (failed, &quantum) in failed.iter_mut().zip(&QUANTA) {
                let mut dice = Dice::new(2346);
                let (mut outside, mut number) = (0, 0);
                while outside < pushes {
                    let push = Push::random(&body, &mut dice, number, quantum);
                    number += 1;
                    let outcome = push.judge(&body, &feel, |_, _, _| {});
                    outside += usize::from(outcome != Outcome::Inside);
                    match outcome {
                        Outcome::Inside | Outcome::Missed => {}
                        Outcome::Held => touched += 1,
                        _ => {
                            *failed += 1;
                            eprintln!("{name}, {quantum} m, push {number}: {outcome:?}");
                        }
                    }
                }
            }
            failures += failed.iter().sum::<usize>();
            let share = 100.0 * touched as f64 / (pushes * QUANTA.len()) as f64;
            let failed = failed.map(|f| format!("{f:>9}")).concat();
            println!(
                "{name:<16} {:>9}  {feel_name:<18} {share:>7.1}%{failed}",
                body.triangles.len()
            );
        }
    }
    assert_eq!(failures, 0, "pushes failed");
}
