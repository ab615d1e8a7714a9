//! Ways that look for faults: random walks inside, along edges and over nodes, grazing, skipped
//! ticks, leaps through meshes too fine for one tick's walk.

use crate::bodies::{Dice, cube, globe, pushed_bodies, sliced, turned, turned_by};
use crate::pushing::{quantised, sticks, target, winding};
use glam::DVec3;
use palpate_servo::body::closest::closest_point;
use palpate_servo::body::surface::Body;
use palpate_servo::proxy::{Feel, Proxy};

const TICK: f64 = 1e-3;

fn feels() -> [Feel; 3] {
    [(false, 0.0), (true, 0.0), (true, 0.4)].map(|(shading, friction)| Feel {
        shading,
        static_friction: friction,
        dynamic_friction: 0.8 * friction,
        ..Feel::default()
    })
}

/// What must hold after every tick, whatever the device did before it.
fn check(name: &str, body: &Body, proxy: &Proxy, device: DVec3, feel: &Feel) {
    let rounding = 1e-11 * body.size();
    let (closest, inside) = closest_point(body, device, 0);
    let Some(hold) = proxy.hold() else {
        assert!(
            !inside || closest.distance <= rounding,
            "{name}: lost the surface at {device}"
        );
        assert_eq!(proxy.position(), device);
        return;
    };
    assert!(proxy.position().is_finite());
    assert!(hold.alpha.iter().all(|a| (0.0..=1.0).contains(a)));
    let on_slivers = 1e-9 * body.size();
    let depth = proxy.god_object().distance(device);
    let felt = proxy.position().distance(device);
    assert!(felt <= depth * (2.0 + 4.0 * feel.static_friction) + on_slivers);
    let off = closest_point(body, proxy.position(), hold.triangle)
        .0
        .distance;
    assert!(off <= on_slivers, "{name}: {off} off the surface");
}

#[test]
fn random_walks_inside_never_lose_the_surface() {
    for (name, body) in pushed_bodies() {
        let middle = body.nodes.iter().sum::<DVec3>() / body.nodes.len() as f64;
        let unit = body.size() / 0.0866;
        for feel in feels() {
            let mut dice = Dice::new(31);
            let mut device = middle + DVec3::splat(2.0 * body.size());
            let mut proxy = Proxy::new(&body, device);
            let mut touched = 0;
            for step in 0..600 {
                let reach = unit * [1e-5, 1e-4, 1e-3, 1e-2][dice.below(4)];
                device += dice.direction() * reach - (device - middle) * 0.02;
                if step % 3 == 0 {
                    device = quantised(device, 5e-5 * unit);
                }
                proxy.follow(&body, device, &feel, TICK);
                touched += usize::from(proxy.hold().is_some());
                check(name, &body, &proxy, device, &feel);
            }
            assert!(touched > 50, "{name}: hardly touched ({touched})");
        }
    }
}

#[test]
fn along_edges_and_over_nodes_on_the_surface_exactly_or_by_a_hair() {
    for (name, body) in pushed_bodies() {
        let mut dice = Dice::new(37);
        for feel in feels() {
            for _ in 0..60 {
                // From node to node, as far as edges lead, at one height.
                let height = [
                    0.0, 1e-18, -1e-18, 1e-15, -1e-15, 1e-12, -1e-12, -1e-9, -1e-6,
                ][dice.below(9)];
                let triangle = dice.below(body.triangles.len());
                let mut node = body.triangles[triangle][0];
                let normal = body.face(triangle as u32).normal;
                let mut proxy = Proxy::new(
                    &body,
                    body.nodes[node as usize] + normal * body.size() * 1e-3,
                );
                for _ in 0..3 {
                    let around = body
                        .triangles
                        .iter()
                        .filter(|t| t.contains(&node))
                        .nth(dice.below(3))
                        .unwrap_or(&body.triangles[triangle]);
                    let next = around[dice.below(3)];
                    let (from, to) = (body.nodes[node as usize], body.nodes[next as usize]);
                    let up = body.node_normal(node).normalize_or_zero();
                    let stops = 1 + dice.below(12);
                    for stop in 0..=stops {
                        let device = from.lerp(to, stop as f64 / stops as f64) + up * height;
                        proxy.follow(&body, device, &feel, TICK);
                        check(name, &body, &proxy, device, &feel);
                    }
                    node = next;
                }
            }
        }
    }
}

#[test]
fn grazing_ways_and_skipped_ticks_neither_tunnel_nor_stick() {
    for (name, body) in pushed_bodies() {
        let mut dice = Dice::new(41);
        for feel in feels() {
            for _ in 0..100 {
                let (place, normal) = target(&body, &mut dice);
                let along = dice.direction().reject_from_normalized(normal).normalize();
                let slope = [0.0, 1e-12, 1e-6, 1e-3][dice.below(4)];
                let way = (along - normal * slope) * body.size() * 0.02;
                let start = place - way * 3.0 + normal * body.size() * 1e-9;
                if closest_point(&body, start, 0).1 {
                    continue;
                }
                let mut proxy = Proxy::new(&body, start);
                let mut landings = 0;
                let mut device = start;
                for _ in 0..8 {
                    // Now and then a tick is left out, or three.
                    device += way * (1 + dice.below(4)) as f64 * 0.5;
                    let was_free = proxy.hold().is_none();
                    proxy.follow(&body, device, &feel, TICK);
                    landings += usize::from(was_free && proxy.hold().is_some());
                    check(name, &body, &proxy, device, &feel);
                }
                proxy.follow(&body, start, &feel, TICK);
                check(name, &body, &proxy, start, &feel);
                if landings == 1 && proxy.hold().is_some() {
                    assert!(!sticks(&body, &proxy, start), "{name}: sticks at {start}");
                }
            }
        }
    }
}

#[test]
fn leaps_inside_a_fine_mesh_take_more_ticks_but_lose_nothing() {
    // 1,000 slivers lie between the ends of a side: more than the steps of one tick can cross.
    let body = turned(&sliced(500), 1.0);
    let mut dice = Dice::new(43);
    let feel = Feel::default();
    let within = |dice: &mut Dice, z: f64| DVec3::new(0.049, dice.within(0.01, 0.04), z);
    let mut proxy = Proxy::new(&body, turned_by(DVec3::new(0.06, 0.025, 0.025)));
    proxy.follow(
        &body,
        turned_by(DVec3::new(0.049, 0.025, 0.025)),
        &feel,
        TICK,
    );
    let mut unfinished = 0;
    for leap in 0..40 {
        let z = dice.within(0.001, 0.01);
        let z = if leap % 2 == 0 { z } else { 0.05 - z };
        let device = turned_by(within(&mut dice, z));
        let mut ticks = 0;
        loop {
            proxy.follow(&body, device, &feel, TICK);
            check("slivers", &body, &proxy, device, &feel);
            assert!(proxy.steps() <= 512);
            ticks += 1;
            if proxy.steps() < 512 {
                break;
            }
            assert!(ticks < 20, "it never arrives");
        }
        unfinished += usize::from(ticks > 1);
        let depth = proxy.god_object().distance(device);
        assert!((depth - 1e-3).abs() < 1e-12, "{depth}");
    }
    assert!(
        unfinished > 20,
        "only {unfinished} leaps took more than a tick"
    );
}

#[test]
fn at_ten_metres_a_second_nothing_tunnels_through_any_wall() {
    for (name, body) in pushed_bodies() {
        let unit = body.size() / 0.0866;
        let mut dice = Dice::new(47);
        let mut stopped = 0;
        for _ in 0..60 {
            let (place, normal) = target(&body, &mut dice);
            let way = (dice.direction() - normal * 1.5).normalize() * 0.01 * unit;
            let start = place - way * dice.within(0.05, 0.95);
            if closest_point(&body, start, 0).1 {
                continue;
            }
            let mut proxy = Proxy::new(&body, start);
            let device = start + way;
            proxy.follow(&body, device, &Feel::default(), TICK);
            // Whether the way meets the body at all, asked of points along it.
            let enters = (1..16).any(|i| {
                let p = start + way * (f64::from(i) / 16.0);
                winding(&body, p) > 0.5
            });
            let exact = winding(&body, device) > 0.5;
            if exact {
                assert!(proxy.hold().is_some(), "{name}: fell through to {device}");
            }
            if enters && proxy.hold().is_none() {
                // It may have come out again only by walking round an end of the body.
                let landed = proxy.steps() > 0;
                assert!(landed, "{name}: tunnelled from {start} to {device}");
            }
            stopped += usize::from(enters);
        }
        assert!(stopped > 2, "{name}: only {stopped} ways met it");
    }
}

#[test]
fn a_globe_is_felt_from_inside_its_slivers_all_round() {
    // At the poles 51 triangles meet in a node; the device circles it closely, deep inside.
    let body = globe(0.025);
    for feel in feels() {
        let mut proxy = Proxy::new(&body, DVec3::Z * 0.03);
        for step in 0..4000 {
            let angle = f64::from(step) * 0.05;
            let device = DVec3::new(1e-4 * angle.cos(), 1e-4 * angle.sin(), 0.022);
            proxy.follow(&body, device, &feel, TICK);
            check("globe", &body, &proxy, device, &feel);
            assert!(proxy.hold().is_some());
        }
    }
}

#[test]
fn set_down_on_a_smaller_body_it_forgets_the_larger_one() {
    let (large, small) = (globe(0.025), cube());
    let touch = |touching: &Body, device: DVec3, proxy: &mut Proxy, feel: &Feel| {
        proxy.follow(touching, device, feel, TICK);
        check("exchanged", touching, proxy, device, feel);
    };
    for feel in feels() {
        for face in [2345, 2000, 500] {
            let outside = large.face(face).at([0.3, 0.3, 0.4]) * 1.1;
            let mut proxy = Proxy::new(&large, outside);
            touch(&large, outside * 0.8, &mut proxy, &feel);
            assert!(proxy.hold().is_some_and(|h| h.triangle > 191));
            proxy.restart(&small, DVec3::new(0.02, 0.03, 0.06));
            assert!(proxy.hold().is_none());
            touch(&small, DVec3::new(0.02, 0.03, 0.049), &mut proxy, &feel);
            assert!(proxy.hold().is_some());
        }
    }
}
