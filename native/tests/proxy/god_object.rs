//! The god object never enters the body, never sticks, and rests where the device is nearest.

use crate::bodies::{
    Dice, angle_bar, cube, inner_corner, lentil, parts_side_by_side, sphere, touching_blocks,
    touching_tips, wall,
};
use crate::pushing::{distance_to_surface, nearest_on, quantised, target, winding};
use glam::DVec3;
use palpate_servo::body::closest::closest_point;
use palpate_servo::body::surface::Body;
use palpate_servo::proxy::{Feel, Proxy};

/// Triangles on the proxy's own sheet of the surface that meet its feature. Where the surface
/// touches itself the other sheet belongs to another free space.
fn triangles_here(body: &Body, triangle: u32, alpha: [f64; 3]) -> Vec<u32> {
    let face = body.face(triangle);
    let carrying: Vec<usize> = (0..3).filter(|&k| alpha[k] > 0.0).collect();
    match carrying[..] {
        [corner] => {
            let (_, corners) = body.fan(face.fans[corner]);
            corners.iter().map(|c| c.triangle).collect()
        }
        [0, 1] => vec![triangle, face.across[0].triangle],
        [1, 2] => vec![triangle, face.across[1].triangle],
        [0, 2] => vec![triangle, face.across[2].triangle],
        _ => vec![triangle],
    }
}

/// No triangle that meets the proxy's feature leads nearer to the device.
fn assert_rests(name: &str, body: &Body, proxy: &Proxy, device: DVec3) {
    let hold = proxy.god_hold().expect("it touches");
    let here = proxy.god_object().distance(device);
    for t in triangles_here(body, hold.triangle, hold.alpha) {
        let corners = body.triangles[t as usize].map(|n| body.nodes[n as usize]);
        let there = nearest_on(corners, device).distance(device);
        // Squares: a nearer point at a distance s sideways gains s^2 here.
        assert!(
            here * here - there * there <= 1e-15,
            "{name}: {here} at {:?} of {}, but {there} on {t}",
            hold.alpha,
            hold.triangle
        );
    }
}

fn all_bodies() -> Vec<(&'static str, std::sync::Arc<Body>)> {
    vec![
        ("cube", cube()),
        ("sphere", sphere(0.025, 3)),
        ("angle bar", angle_bar()),
        ("inner corner", inner_corner()),
        ("lentil", lentil()),
        ("wall", wall(0.0005)),
        ("touching blocks", touching_blocks()),
        ("touching tips", touching_tips()),
    ]
}

/// One tick of 1 ms with nothing but the shape.
fn follow(proxy: &mut Proxy, body: &Body, device: DVec3) {
    proxy.follow(body, device, &Feel::default(), 1e-3);
}

#[test]
fn a_device_inside_never_loses_the_surface_whatever_it_does() {
    for (name, body) in all_bodies() {
        let mut dice = Dice::new(11);
        let mut proxy = Proxy::new(&body, DVec3::splat(0.2));
        let mut device = DVec3::splat(0.2);
        let mut touched = 0;
        let middle = body.nodes.iter().sum::<DVec3>() / body.nodes.len() as f64;
        for step in 0..4000 {
            let reach = [1e-5, 1e-4, 1e-3, 1e-2][dice.below(4)];
            device += dice.direction() * reach - (device - middle) * 0.02;
            if step % 3 == 0 {
                device = quantised(device, 5e-5);
            }
            follow(&mut proxy, &body, device);
            if proxy.hold().is_some() {
                touched += 1;
                assert_rests(name, &body, &proxy, device);
                let off = distance_to_surface(&body, proxy.position());
                assert!(off < 1e-15, "{name}: proxy off the surface by {off}");
            } else {
                let lost =
                    winding(&body, device) > 0.5 && distance_to_surface(&body, device) > 1e-12;
                assert!(!lost, "{name}: lost the surface at {device}");
                assert_eq!(proxy.position(), device);
            }
            assert!(proxy.steps() < 300, "{name}: {} steps", proxy.steps());
        }
        assert!(touched > 100, "{name}: hardly touched ({touched})");
    }
}

#[test]
fn force_begins_and_ends_at_nothing() {
    for (_, body) in all_bodies() {
        let mut dice = Dice::new(3);
        for _ in 0..200 {
            let t = dice.below(body.triangles.len());
            let face = body.face(t as u32);
            let goal = face.at([1.0 / 3.0; 3]);
            let start = goal + face.normal * 1e-4;
            if winding(&body, start) > 0.5 {
                continue;
            }
            let mut proxy = Proxy::new(&body, start);
            for nanometres in (-2000..100_i32).rev().chain(-2000..100) {
                let height = f64::from(nanometres) * 1e-9;
                let device = goal + face.normal * height;
                follow(&mut proxy, &body, device);
                let displacement = proxy.position().distance(device);
                let expected = if nanometres < 0 { -height } else { 0.0 };
                assert!((displacement - expected).abs() < 1e-16);
                if nanometres.abs() > 1 {
                    assert_eq!(proxy.hold().is_some(), nanometres < 0);
                }
            }
        }
    }
}

#[test]
fn fast_sweeps_stop_at_thin_walls() {
    for thickness in [5e-4, 1e-5, 1e-7] {
        let body = wall(thickness);
        let mut dice = Dice::new(5);
        for _ in 0..3000 {
            // 10 m/s at 1 kHz, often through edges and nodes of the 12.5 mm grid.
            let snap = [1e-3, 1.25e-2 / 4.0, 1e-9][dice.below(3)];
            let spot = quantised(
                DVec3::new(dice.within(0.006, 0.044), dice.within(0.006, 0.044), 0.0),
                snap,
            );
            let slant = quantised(
                DVec3::new(dice.within(-0.004, 0.004), dice.within(-0.004, 0.004), 0.0),
                snap,
            );
            let up = DVec3::Z * 0.005;
            let mut proxy = Proxy::new(&body, spot - slant + up);
            let device = spot + slant - up;
            follow(&mut proxy, &body, device);
            assert!(proxy.hold().is_some(), "tunnelled at {spot}");
            assert!((proxy.position().z - thickness).abs() < 1e-12);
            follow(&mut proxy, &body, spot - slant + up);
            assert!(proxy.hold().is_none());
        }
    }
}

#[test]
fn two_planes_hold_the_proxy_in_an_inner_edge() {
    let body = angle_bar();
    // The inner edge runs along y at x = z = 25 mm.
    let mut proxy = Proxy::new(&body, DVec3::new(0.04, 0.01, 0.04));
    for step in 0..=100 {
        let t = f64::from(step) / 100.0;
        let device = DVec3::new(0.04 - 0.018 * t, 0.01 + 0.02 * t, 0.04 - 0.017 * t);
        follow(&mut proxy, &body, device);
    }
    let p = proxy.position();
    assert!(p.distance(DVec3::new(0.025, 0.03, 0.025)) < 1e-15, "{p}");
    assert!(proxy.hold().unwrap().alpha.contains(&0.0));
}

#[test]
fn three_planes_hold_the_proxy_in_an_inner_corner() {
    let body = inner_corner();
    let mut proxy = Proxy::new(&body, DVec3::splat(0.04));
    for step in 0..=50 {
        let t = f64::from(step) / 50.0;
        follow(
            &mut proxy,
            &body,
            DVec3::new(0.04 - 0.02 * t, 0.04 - 0.019 * t, 0.04 - 0.018 * t),
        );
    }
    assert_eq!(proxy.position(), DVec3::splat(0.025));
    let alpha = proxy.hold().unwrap().alpha;
    assert_eq!(alpha.iter().filter(|&&a| a == 0.0).count(), 2);
}

#[test]
fn sliding_under_a_sphere_never_needs_rescue_and_stays_near_the_nearest_point() {
    let body = sphere(0.025, 3);
    let mut dice = Dice::new(9);
    let mut device = DVec3::new(0.0, 0.0, 0.04);
    let mut proxy = Proxy::new(&body, device);
    for _ in 0..5000 {
        device += dice.direction() * 3e-4;
        device = device.normalize() * 0.0235;
        follow(&mut proxy, &body, device);
        let (closest, inside) = closest_point(&body, device, 0);
        assert!(inside && proxy.hold().is_some());
        // Under facets each has its own nearest point; they differ by less than their sag.
        let mine = proxy.position().distance(device);
        assert!(mine - closest.distance < 2e-4);
        assert_rests("sphere", &body, &proxy, device);
    }
    assert_eq!(proxy.rescues(), 0);
}

#[test]
fn set_down_inside_it_feels_nothing_until_it_was_outside() {
    let body = cube();
    let mut proxy = Proxy::new(&body, DVec3::splat(0.02));
    for z in [0.03, 0.045, 0.0499, 0.02] {
        follow(&mut proxy, &body, DVec3::new(0.02, 0.02, z));
        assert!(proxy.hold().is_none());
    }
    follow(&mut proxy, &body, DVec3::new(0.02, 0.02, 0.051));
    assert!(proxy.hold().is_none());
    follow(&mut proxy, &body, DVec3::new(0.02, 0.02, 0.049));
    assert!(proxy.hold().is_some());
    proxy.restart(&body, DVec3::splat(0.02));
    follow(&mut proxy, &body, DVec3::splat(0.021));
    assert!(proxy.hold().is_none());
}

#[test]
fn from_one_part_into_the_next_where_their_faces_coincide_nothing_falls_through() {
    let body = parts_side_by_side();
    let mut dice = Dice::new(31);
    let mut crossed = 0;
    for round in 0..2000 {
        let quantum = [1e-6, 5e-5, 1e-3][round % 3];
        let inside = |dice: &mut Dice| {
            DVec3::new(
                dice.within(0.001, 0.024),
                dice.within(0.001, 0.0115),
                dice.within(0.001, 0.0115),
            )
        };
        let first = inside(&mut dice);
        let mut ways = vec![first.with_z(0.014), first];
        ways.extend((0..3).map(|_| inside(&mut dice)));
        let mut proxy = Proxy::new(&body, ways[0]);
        let mut last = ways[0];
        for way in ways.windows(2) {
            for tick in 0..12 {
                let device = quantised(way[0].lerp(way[1], f64::from(tick) / 11.0), quantum);
                follow(&mut proxy, &body, device);
                crossed += u32::from((device.x > 0.0125) != (last.x > 0.0125));
                last = device;
                let is_inside = device.x != 0.0125 && device.z < 0.0125;
                assert!(
                    proxy.hold().is_some() || !is_inside,
                    "round {round}: free at {device}"
                );
            }
        }
        follow(&mut proxy, &body, last.with_z(0.014));
        assert!(proxy.hold().is_none(), "round {round} sticks");
    }
    assert!(crossed > 1000);
}

#[test]
fn leaving_between_parts_that_only_touch_it_is_free() {
    let body = parts_side_by_side();
    // Over the corner x = y = z = 12.5 mm of both, behind a side of either, yet outside of both.
    let ways = [
        [0.0008, 0.0109, 0.0082],
        [0.0020, 0.0095, 0.0084],
        [0.0057, 0.0052, 0.0091],
        [0.0094, 0.0009, 0.0099],
        [0.0106, -0.0005, 0.0101],
        [0.0119, -0.0019, 0.0103],
    ];
    let ways = ways.map(|p| DVec3::from(p) * 1.25);
    let mut proxy = Proxy::new(&body, ways[0]);
    for device in &ways[1..4] {
        follow(&mut proxy, &body, *device);
        assert!(proxy.hold().is_some());
    }
    for device in &ways[4..] {
        follow(&mut proxy, &body, *device);
    }
    assert!(proxy.hold().is_none());
}

#[test]
fn set_down_beside_coinciding_faces_it_feels_nothing_until_it_was_outside() {
    let body = parts_side_by_side();
    let mut dice = Dice::new(32);
    for _ in 0..500 {
        let x = 0.0125 + dice.within(-1e-3, 1e-3);
        let device = DVec3::new(x, dice.within(0.002, 0.01), dice.within(0.002, 0.01));
        assert!(Proxy::new(&body, device).is_buried(), "{device}");
    }
}

#[test]
fn the_sign_of_the_distance_agrees_with_the_winding_number() {
    for (name, body) in all_bodies() {
        let mut dice = Dice::new(13);
        for _ in 0..1500 {
            let (goal, normal) = target(&body, &mut dice);
            let p = goal + (normal + dice.direction()) * dice.within(-1e-3, 1e-3);
            let (closest, inside) =
                closest_point(&body, p, dice.below(body.triangles.len()) as u32);
            let truth = distance_to_surface(&body, p);
            assert!((closest.distance - truth).abs() < 1e-12);
            if truth > 1e-9 {
                assert_eq!(inside, winding(&body, p) > 0.5, "{name} at {p}");
            }
        }
    }
}
