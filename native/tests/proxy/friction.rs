//! Friction of the contact point: a cone of forces, sticking and slipping.

use crate::bodies::{Dice, angle_bar, globe, lentil, sphere};
use crate::feel::{TICK, around, force, isotropic, pressed, ratio, rubbing, slab};
use glam::DVec3;
use palpate_servo::proxy::{Feel, Proxy};

#[test]
fn slipping_on_a_plane_the_force_is_on_the_dynamic_cone() {
    // With a compliance the force is the consistent one, which friction has to judge by.
    let bodies = [slab(), crate::bodies::elastic(&slab())];
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
    for body in [slab(), crate::bodies::turned(&slab(), 1.0)] {
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
