//! The contact point that makes the force: smooth over facets, with a cone of friction, and never
//! a source of energy.

mod bodies;
mod pushing;

use bodies::{Dice, angle_bar, cube, globe, inner_corner, lentil, sphere, turned, voxels};
use glam::{DMat3, DVec3};
use palpate_servo::body::surface::Body;
use palpate_servo::contact::touch::{ContactMode, touch};
use palpate_servo::proxy::{Feel, Proxy};
use pushing::target;

const TICK: f64 = 1e-3;
const MODULUS: f64 = 10_000.0;

const SHADED: Feel = Feel {
    shading: true,
    static_friction: 0.0,
    dynamic_friction: 0.0,
    mode: ContactMode::Consistent,
};

fn rubbing(shading: bool) -> Feel {
    Feel {
        shading,
        static_friction: 0.5,
        dynamic_friction: 0.3,
        mode: ContactMode::Consistent,
    }
}

/// The same surface on a bed of equal springs.
fn isotropic(body: &Body) -> Body {
    let blocks = vec![DMat3::IDENTITY; body.nodes.len()];
    Body::new(body.nodes.clone(), body.triangles.clone(), blocks).expect("a sound body")
}

/// A block of 100 x 100 x 25 mm whose upper side is the plane z = 25 mm; blocks as in `soft`.
fn slab() -> std::sync::Arc<Body> {
    voxels(&bodies::grid(8, 8, 2), 0.0125)
}

/// A proxy that came down to `device` from above, along `up`.
fn pressed(body: &Body, device: DVec3, up: DVec3, feel: &Feel) -> Proxy {
    let mut proxy = Proxy::new(body, device + up);
    for step in 0..=100 {
        let height = 1.0 - f64::from(step) / 100.0;
        proxy.follow(body, device + up * height, feel, TICK);
    }
    assert!(proxy.hold().is_some());
    proxy
}

fn force(body: &Body, proxy: &Proxy, device: DVec3) -> DVec3 {
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
fn ratio(force: DVec3, normal: DVec3) -> f64 {
    let pressing = force.dot(normal);
    assert!(pressing > 0.0);
    (force - normal * pressing).length() / pressing
}

fn percentile(mut values: Vec<f64>, part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    values[((values.len() - 1) as f64 * part).round() as usize]
}

/// Directions along tilted great circles, 0.1 mm a tick at `radius`.
fn around(radius: f64, ticks: usize) -> impl Iterator<Item = DVec3> {
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
fn jumps(body: &Body, depth: f64, feel: &Feel) -> Vec<f64> {
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
fn facets_of_a_sphere_are_hardly_felt_without_shading_and_not_with_it() {
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
fn at_rest_the_contact_point_arrives_at_the_god_object() {
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
fn without_depth_nothing_lags() {
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
fn at_sharp_edges_the_force_lags_by_a_small_angle_only() {
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

#[test]
fn slipping_on_a_plane_the_force_is_on_the_dynamic_cone() {
    // With a compliance the force is the consistent one, which friction has to judge by.
    let bodies = [slab(), bodies::elastic(&slab())];
    for (shading, body) in [(false, &bodies[0]), (true, &bodies[0]), (false, &bodies[1])] {
        let feel = rubbing(shading);
        let start = DVec3::new(0.02, 0.03, 0.022);
        let mut proxy = pressed(body, start, DVec3::Z * 0.01, &feel);
        let (mut stuck, mut slipped, mut most) = (0, 0, 0.0_f64);
        for tick in 0..500 {
            let device = start + DVec3::new(1e-4, 0.4e-4, 0.0) * f64::from(tick);
            proxy.follow(body, device, &feel, TICK);
            let mu = ratio(force(body, &proxy, device), DVec3::Z);
            most = most.max(mu);
            if proxy.is_sticking() {
                stuck += 1;
                assert!(slipped == 0, "it sticks again while it moves");
                assert!(mu <= 0.5 + 1e-9);
            } else {
                slipped += 1;
                assert!((mu - 0.3).abs() < 0.003, "{mu} at tick {tick}");
            }
        }
        assert!(most > 0.45, "it broke away at {most}");
        assert!(stuck > 5 && slipped > 400);
    }
}

#[test]
fn slipping_on_a_shaded_sphere_the_force_is_on_the_dynamic_cone() {
    let body = sphere(0.025, 3);
    let feel = rubbing(true);
    let ways: Vec<DVec3> = around(0.022, 2000).collect();
    let mut proxy = pressed(&body, ways[0] * 0.022, ways[0] * 0.01, &feel);
    let mut slipped = 0;
    for way in ways {
        let device = way * 0.022;
        proxy.follow(&body, device, &feel, TICK);
        if !proxy.is_sticking() {
            slipped += 1;
            // Node normals of a sphere are exact, so the shaded normal is the radial one.
            let mu = ratio(force(&body, &proxy, device), proxy.position().normalize());
            assert!((mu - 0.3).abs() < 0.003, "{mu}");
        }
    }
    assert!(slipped > 1800);
}

#[test]
fn friction_opposes_motion_on_every_body() {
    for body in [angle_bar(), lentil(), globe(0.025)] {
        let body = isotropic(&body);
        let feel = rubbing(false);
        let mut dice = Dice::new(4);
        let mut slips = 0;
        for _ in 0..60 {
            let face = body.face(dice.below(body.triangles.len()) as u32);
            let device = face.at([1.0 / 3.0; 3]) - face.normal * 1e-4;
            let mut proxy = Proxy::new(&body, device + face.normal * 2e-4);
            let way = dice.direction().reject_from_normalized(face.normal) * 1e-5;
            for tick in 0..40 {
                let here = device + way * f64::from(tick);
                proxy.follow(&body, here, &feel, TICK);
                if proxy.hold().is_some() && !proxy.is_sticking() {
                    slips += 1;
                    let felt = force(&body, &proxy, here).reject_from_normalized(face.normal);
                    let on_this = body.face(proxy.hold().unwrap().triangle).normal == face.normal;
                    assert!(!on_this || felt.dot(way) <= 0.0);
                }
            }
        }
        assert!(slips > 200, "{slips}");
    }
}

#[test]
fn what_sticks_does_not_drift() {
    let body = slab();
    let feel = rubbing(false);
    let start = DVec3::new(0.05, 0.05, 0.022);
    let mut proxy = pressed(&body, start, DVec3::Z * 0.01, &feel);
    // Within the cone, to and fro; then long at rest.
    let device = start + DVec3::new(3e-4, 0.0, 0.0);
    let held = proxy.position();
    for tick in 0..5000 {
        let shake = if tick < 2000 {
            DVec3::X * 2e-4 * f64::from(tick).sin()
        } else {
            DVec3::ZERO
        };
        proxy.follow(&body, device + shake, &feel, TICK);
        assert!(proxy.is_sticking());
        assert_eq!(proxy.position(), held);
    }
}

#[test]
fn after_slipping_it_comes_to_rest_and_holds_with_the_static_coefficient() {
    let body = slab();
    let feel = rubbing(false);
    let start = DVec3::new(0.03, 0.05, 0.022);
    let mut proxy = pressed(&body, start, DVec3::Z * 0.01, &feel);
    let mut device = start;
    let mut slide = |proxy: &mut Proxy, ticks: usize, step: f64| {
        for _ in 0..ticks {
            device.x += step;
            proxy.follow(&body, device, &feel, TICK);
        }
        ratio(force(&body, proxy, device), DVec3::Z)
    };
    slide(&mut proxy, 200, 1e-4);
    assert!(!proxy.is_sticking());
    let rested = proxy.position();
    let mu = slide(&mut proxy, 30, 0.0);
    assert!(proxy.is_sticking() && (mu - 0.3).abs() < 0.003);
    assert_eq!(proxy.position(), rested);
    // It now takes the static coefficient to move on, and turning back sticks at once.
    let mu = slide(&mut proxy, 3, 5e-5);
    assert!(proxy.is_sticking() && mu > 0.31, "{mu}");
    slide(&mut proxy, 200, 1e-4);
    assert!(!proxy.is_sticking());
    slide(&mut proxy, 1, -1e-4);
    assert!(proxy.is_sticking());
}

#[test]
fn without_dynamic_friction_the_static_one_still_holds() {
    let feel = Feel {
        dynamic_friction: 0.0,
        ..rubbing(false)
    };
    for body in [slab(), bodies::turned(&slab(), 1.0)] {
        let point = body.face(0).at([0.2, 0.3, 0.5]);
        let up = body.face(0).normal;
        let along = up.any_orthonormal_vector();
        let mut device = point - up * 0.002;
        let mut proxy = pressed(&body, device, up * 0.01, &feel);
        let mut slide = |proxy: &mut Proxy, ticks: usize, step: f64| {
            for _ in 0..ticks {
                device += along * step;
                proxy.follow(&body, device, &feel, TICK);
            }
            ratio(force(&body, proxy, device), up)
        };
        slide(&mut proxy, 30, 0.0);
        assert!(proxy.is_sticking());
        let mu = slide(&mut proxy, 20, 2e-5);
        assert!(proxy.is_sticking() && mu > 0.1, "{mu}");
        let mu = slide(&mut proxy, 60, 2e-5);
        assert!(!proxy.is_sticking() && mu < 1e-4, "{mu}");
    }
}

#[test]
fn friction_switched_off_while_it_holds_holds_no_more() {
    let body = slab();
    let start = DVec3::new(0.03, 0.05, 0.022);
    let mut proxy = pressed(&body, start, DVec3::Z * 0.01, &rubbing(false));
    let aside = start + DVec3::X * 0.0005;
    proxy.follow(&body, aside, &rubbing(false), TICK);
    assert!(proxy.is_sticking());
    for shading in [false, true] {
        let feel = Feel {
            shading,
            ..Feel::default()
        };
        for _ in 0..100 {
            proxy.follow(&body, aside, &feel, TICK);
        }
        assert!(!proxy.is_sticking());
        assert!(proxy.position().distance(aside.with_z(0.025)) < 1e-9);
    }
}

#[test]
fn no_friction_is_exactly_none() {
    let body = slab();
    let feel = Feel::default();
    let start = DVec3::new(0.02, 0.03, 0.022);
    let mut proxy = pressed(&body, start, DVec3::Z * 0.01, &feel);
    for tick in 0..500 {
        let device = start + DVec3::new(1e-4, 0.4e-4, 0.0) * f64::from(tick);
        proxy.follow(&body, device, &feel, TICK);
        let aside = (proxy.position() - device).truncate().length();
        assert!(aside < 1e-16, "{aside}");
    }
}

/// Whenever the contact point moves, the spring between it and the device loses energy. The device
/// works against that spring alone, so round any closed way it can only lose.
#[test]
fn the_contact_point_only_ever_takes_energy() {
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

#[test]
fn friction_holds_in_an_inner_edge_and_lets_go_along_it() {
    let body = isotropic(&angle_bar());
    let feel = rubbing(false);
    // Both walls hold: pressed into x and z alike, nothing pulls along the edge.
    let mut proxy = Proxy::new(&body, DVec3::new(0.03, 0.02, 0.03));
    let mut device = DVec3::new(0.03, 0.02, 0.03);
    for _ in 0..80 {
        device += DVec3::new(-1e-4, 0.0, -1e-4);
        proxy.follow(&body, device, &feel, TICK);
    }
    assert!(proxy.position().distance(DVec3::new(0.025, 0.02, 0.025)) < 1e-12);
    // Along it: |F_t| <= mu F_n with F_n across both walls.
    for _ in 0..300 {
        device.y += 5e-5;
        proxy.follow(&body, device, &feel, TICK);
    }
    let felt = proxy.position() - device;
    let mu = -felt.y / felt.x.hypot(felt.z);
    assert!((mu.abs() - 0.3).abs() < 0.003, "{mu}");
}
