//! The contact point that makes the force: smooth over facets, with a cone of friction, and never
//! a source of energy.

use crate::bodies::{Dice, angle_bar, cube, globe, inner_corner, lentil, sphere, turned, voxels};
use crate::pushing::target;
use glam::{DMat3, DVec3};
use palpate_servo::body::surface::Body;
use palpate_servo::contact::touch::{ContactMode, touch};
use palpate_servo::proxy::{Feel, Proxy};

pub const TICK: f64 = 1e-3;
pub const MODULUS: f64 = 10_000.0;

pub const SHADED: Feel = Feel {
    shading: true,
    static_friction: 0.0,
    dynamic_friction: 0.0,
    mode: ContactMode::Consistent,
};

pub fn rubbing(shading: bool) -> Feel {
    Feel {
        shading,
        static_friction: 0.5,
        dynamic_friction: 0.3,
        mode: ContactMode::Consistent,
    }
}

/// The same surface on a bed of equal springs.
pub fn isotropic(body: &Body) -> Body {
    let blocks = vec![DMat3::IDENTITY; body.nodes.len()];
    Body::new(body.nodes.clone(), body.triangles.clone(), blocks).expect("a sound body")
}

/// A block of 100 x 100 x 25 mm whose upper side is the plane z = 25 mm; blocks as in `soft`.
pub fn slab() -> std::sync::Arc<Body> {
    voxels(&crate::bodies::grid(8, 8, 2), 0.0125)
}

/// A proxy that came down to `device` from above, along `up`.
pub fn pressed(body: &Body, device: DVec3, up: DVec3, feel: &Feel) -> Proxy {
    let mut proxy = Proxy::new(body, device + up);
    for step in 0..=100 {
        let height = 1.0 - f64::from(step) / 100.0;
        proxy.follow(body, device + up * height, feel, TICK);
    }
    assert!(proxy.hold().is_some());
    proxy
}

pub fn force(body: &Body, proxy: &Proxy, device: DVec3) -> DVec3 {
    let hold = proxy.hold().expect("it touches");
    let displacement = device - proxy.position();
    touch(
        body,
        ContactMode::Consistent,
        hold.triangle,
        hold.alpha,
        displacement,
        MODULUS,
    )
    .force
}

/// Share of the tangential force in the normal one.
pub fn ratio(force: DVec3, normal: DVec3) -> f64 {
    let pressing = force.dot(normal);
    assert!(pressing > 0.0);
    (force - normal * pressing).length() / pressing
}

pub fn percentile(mut values: Vec<f64>, part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * part).round() as usize]
}

/// Directions along tilted great circles, 0.1 mm a tick at `radius`.
pub fn around(radius: f64, ticks: usize) -> impl Iterator<Item = DVec3> {
    let turn = DMat3::from_rotation_x(0.4) * DMat3::from_rotation_y(0.7);
    (0..ticks).map(move |i| {
        let angle = i as f64 * 1e-4 / radius;
        let tilt = 0.8 * (0.137 * angle).sin();
        turn * DVec3::new(
            angle.cos() * tilt.cos(),
            angle.sin() * tilt.cos(),
            tilt.sin(),
        )
    })
}

/// Excess of each tick's force jump over the ideal sphere's, N, with 500 N/m.
pub fn jumps(body: &Body, depth: f64, feel: &Feel) -> Vec<f64> {
    let radius = 0.025 - depth;
    let ways: Vec<DVec3> = around(radius, 12_000).collect();
    let mut proxy = pressed(body, ways[0] * radius, ways[0] * 0.02, feel);
    let mut last: Option<(DVec3, DVec3)> = None;
    let mut excess = Vec::new();
    for way in ways {
        let device = way * radius;
        proxy.follow(body, device, feel, TICK);
        let force = (proxy.position() - device) * 500.0;
        let ideal = way * (500.0 * depth);
        if let Some((last_force, last_ideal)) = last {
            excess.push(force.distance(last_force) - ideal.distance(last_ideal));
        }
        last = Some((force, ideal));
    }
    excess
}

#[test]
pub fn facets_of_a_sphere_are_hardly_felt_without_shading_and_not_with_it() {
    let body = globe(0.025);
    let plain = percentile(jumps(&body, 0.005, &Feel::default()), 0.99);
    assert!(plain < 0.05, "{plain} N without shading");
    let shaded = percentile(jumps(&body, 0.005, &SHADED), 0.99);
    assert!(shaded < 0.01, "{shaded} N with shading");
    // Deep inside, where the facets' own nearest points jump by 1 mm, shading still is smooth.
    let deep = percentile(jumps(&body, 0.015, &SHADED), 1.0);
    assert!(deep < 0.01, "{deep} N deep inside");
}

#[test]
pub fn at_rest_the_contact_point_arrives_at_the_god_object() {
    let body = globe(0.025);
    let feel = Feel::default();
    let ways: Vec<DVec3> = around(0.02, 400).collect();
    let mut proxy = pressed(&body, ways[0] * 0.02, ways[0] * 0.01, &feel);
    let mut lagged = 0;
    for way in ways {
        proxy.follow(&body, way * 0.02, &feel, TICK);
        if proxy.position() != proxy.god_object() {
            lagged += 1;
            let mut resting = proxy.clone();
            for _ in 0..60 {
                resting.follow(&body, way * 0.02, &feel, TICK);
            }
            assert_eq!(resting.position(), resting.god_object());
        }
    }
    assert!(lagged > 50, "only {lagged} ticks lagged");
}

#[test]
pub fn without_depth_nothing_lags() {
    // Skimming over facets at less and less depth, the force goes with the depth.
    let body = globe(0.025);
    for depth in [1e-4, 1e-6, 1e-8] {
        for feel in [Feel::default(), SHADED, rubbing(false), rubbing(true)] {
            let start = around(0.025, 1).next().unwrap();
            let mut proxy = Proxy::new(&body, start * 0.03);
            let mut touched = 0;
            for way in around(0.025, 3000) {
                // Below the facet under it by `depth`.
                let (closest, _) =
                    palpate_servo::body::closest::closest_point(&body, way * 0.025, 0);
                let normal = body.face(closest.triangle).normal;
                let device = closest.point - normal * depth;
                proxy.follow(&body, device, &feel, TICK);
                if proxy.hold().is_some() {
                    touched += 1;
                    let felt = proxy.position().distance(device);
                    let real = proxy.god_object().distance(device);
                    // A lag of 19 degrees at most makes it 6 % longer.
                    let longest = match (feel.shading, feel.static_friction > 0.0) {
                        (false, false) => 1.1,
                        _ => 2.0 * (1.0 + feel.static_friction),
                    };
                    assert!(felt <= longest * real + 1e-15, "{felt} of {real}");
                }
            }
            assert!(touched > 1000);
        }
    }
}

#[test]
pub fn at_sharp_edges_the_force_lags_by_a_small_angle_only() {
    // An icosahedron: its sides meet at 41.8 degrees.
    let body = sphere(0.025, 0);
    let feel = Feel::default();
    let ways: Vec<DVec3> = around(0.015, 3000).collect();
    let mut proxy = pressed(&body, ways[0] * 0.015, ways[0] * 0.02, &feel);
    let mut largest = 0.0_f64;
    for way in ways {
        let device = way * 0.015;
        proxy.follow(&body, device, &feel, TICK);
        let (felt, real) = (proxy.position() - device, proxy.god_object() - device);
        largest = largest.max(felt.angle_between(real));
    }
    assert!((0.3..0.36).contains(&largest), "{largest} rad");
}

/// Whenever the contact point moves, the spring between it and the device loses energy. The device
/// works against that spring alone, so round any closed way it can only lose.
#[test]
pub fn the_contact_point_only_ever_takes_energy() {
    let shapes = [
        cube(),
        angle_bar(),
        inner_corner(),
        lentil(),
        globe(0.025),
        turned(&cube(), 1.0),
    ];
    for (number, body) in shapes.iter().enumerate() {
        let body = isotropic(body);
        for feel in [Feel::default(), rubbing(false), rubbing(true)] {
            let mut dice = Dice::new(21);
            let mut device = DVec3::splat(0.2);
            let mut proxy = Proxy::new(&body, device);
            let mut moved = 0;
            for _ in 0..60 {
                let (place, normal) = target(&body, &mut dice);
                let goal = place - normal * dice.within(-1e-3, 4e-3);
                let step = [2e-5, 1e-4, 5e-4][dice.below(3)];
                for _ in 0..100 {
                    device += (goal - device).clamp_length_max(step);
                    let (was_held, before) = (proxy.hold(), proxy.position());
                    proxy.follow(&body, device, &feel, TICK);
                    if was_held.is_some() && proxy.hold().is_some() {
                        let here = before.distance(device);
                        let there = proxy.position().distance(device);
                        moved += usize::from(before != proxy.position());
                        assert!(
                            there <= here + 1e-12,
                            "body {number}, {feel:?}: {here} grew to {there}"
                        );
                    }
                }
            }
            assert!(moved > 300, "body {number}: moved {moved} times");
        }
    }
}
