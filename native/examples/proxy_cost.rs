//! What a tick of the god object costs: `cargo run --release --example proxy_cost`.
//!
//! Slides 3 mm deep around bodies of growing triangle count at 100 mm/s and 1 kHz, then hovers
//! 0.1 mm over them; prints nanoseconds a tick (proxy and contact force), median of batches.

use std::hint::black_box;
use std::time::Instant;

use glam::DVec3;
use palpate_servo::contact::touch;
use palpate_servo::proxy::{Feel, Proxy};

#[path = "../tests/bodies/mod.rs"]
mod bodies;

const TICKS: usize = 4_000;
const BATCH: usize = 40;

fn median_ns(body: &palpate_servo::surface::Body, radius: f64) -> f64 {
    let path: Vec<DVec3> = (0..TICKS)
        .map(|i| {
            // 0.1 mm a tick.
            let angle = i as f64 * 1e-4 / radius;
            let tilt = 0.3 * (0.37 * angle).sin();
            let (s, c) = angle.sin_cos();
            DVec3::new(c * tilt.cos(), s * tilt.cos(), tilt.sin()) * radius
        })
        .collect();
    let mut proxy = Proxy::new(body, path[0].normalize() * 0.04);
    let mut costs: Vec<f64> = Vec::new();
    for batch in path.chunks(BATCH) {
        let start = Instant::now();
        for &device in batch {
            proxy.follow(body, black_box(device), &Feel::default(), 1e-3);
            if let Some(hold) = proxy.hold() {
                let u = device - proxy.position();
                black_box(touch(body, hold.triangle, hold.alpha, u, 1e3));
            }
        }
        costs.push(start.elapsed().as_nanos() as f64 / batch.len() as f64);
    }
    costs.sort_by(f64::total_cmp);
    costs[costs.len() / 2]
}

fn main() {
    println!(
        "{:>10} {:>12} {:>12}",
        "triangles", "sliding ns", "hovering ns"
    );
    for halvings in 1..=7 {
        let body = bodies::sphere(0.025, halvings);
        let sliding = median_ns(&body, 0.022);
        let hovering = median_ns(&body, 0.0251);
        println!(
            "{:>10} {sliding:>12.0} {hovering:>12.0}",
            body.triangles.len()
        );
    }
}
