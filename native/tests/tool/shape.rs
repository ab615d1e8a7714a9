//! Signed distances of tools against closed forms and against a search that knows no faces.

use crate::bodies::Dice;
use glam::DVec3;
use palpate_servo::tool::shape::Tool;

fn cube_corners(half: f64) -> Vec<DVec3> {
    (0..8)
        .map(|k| DVec3::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2)))
        .map(|corner| (corner * 2.0 - 1.0) * half)
        .collect()
}

fn ball_points(dice: &mut Dice, count: usize) -> Vec<DVec3> {
    (0..count).map(|_| dice.direction() * 0.02).collect()
}

/// Distance to the hull of points by Frank and Wolfe's descent, from outside.
fn searched(core: &[DVec3], point: DVec3) -> f64 {
    let mut at = core[0];
    for _ in 0..60_000 {
        let along = |p: &&DVec3| (point - at).dot(**p);
        let ahead = *(core.iter().max_by(|a, b| along(a).total_cmp(&along(b)))).expect("some");
        let step = ahead - at;
        if step.dot(point - at) <= 1e-13 {
            break;
        }
        at += step * ((point - at).dot(step) / step.length_squared()).clamp(0.0, 1.0);
    }
    at.distance(point)
}

#[test]
fn a_box_has_the_distance_of_a_box() {
    let tool = Tool::new(&cube_corners(0.01), 0.002).expect("sound");
    let dice = &mut Dice::new(1);
    for _ in 0..2000 {
        let p = dice.direction() * dice.within(0.0, 0.03);
        let q = p.abs() - 0.01;
        // The usual closed form of a box.
        let expected = q.max(DVec3::ZERO).length() + q.max_element().min(0.0) - 0.002;
        let (distance, normal) = tool.distance(p);
        assert!(
            (distance - expected).abs() < 1e-12,
            "{p} {distance} {expected}"
        );
        assert!((normal.length() - 1.0).abs() < 1e-12);
    }
}

#[test]
fn spheres_rods_and_flat_cores_have_their_closed_forms() {
    let dice = &mut Dice::new(2);
    let sphere = Tool::new(&[DVec3::ZERO], 0.01).expect("sound");
    let rod = Tool::new(&[DVec3::NEG_X * 0.02, DVec3::X * 0.02], 0.005).expect("sound");
    let (x, y) = (DVec3::X * 0.02, DVec3::Y * 0.01);
    let sheet = Tool::new(&[x + y, x - y, -x - y, -x + y], 0.001).expect("sound");
    for _ in 0..2000 {
        let p = dice.direction() * dice.within(0.001, 0.04);
        assert!((sphere.distance(p).0 - (p.length() - 0.01)).abs() < 1e-14);
        let beyond = DVec3::new((p.x.abs() - 0.02).max(0.0), p.y, p.z).length();
        assert!((rod.distance(p).0 - (beyond - 0.005)).abs() < 1e-14);
        let off = DVec3::new(
            (p.x.abs() - 0.02).max(0.0),
            (p.y.abs() - 0.01).max(0.0),
            p.z,
        );
        assert!((sheet.distance(p).0 - (off.length() - 0.001)).abs() < 1e-14);
    }
    // In the middle there is no direction: one that works is given, and no NaN.
    for tool in [&sphere, &rod, &sheet] {
        let (distance, normal) = tool.distance(DVec3::ZERO);
        assert!((distance + tool.radius()).abs() < 1e-15);
        assert!(normal.distance(DVec3::NEG_Z) < 1e-12);
    }
}

#[test]
fn a_hull_of_many_points_is_as_far_as_a_search_says() {
    let dice = &mut Dice::new(3);
    for count in [4, 9, 64] {
        let core = ball_points(dice, count);
        let tool = Tool::new(&core, 1e-6).expect("sound");
        for _ in 0..30 {
            let p = dice.direction() * dice.within(0.021, 0.04);
            let (distance, normal) = tool.distance(p);
            assert!(
                (distance + 1e-6 - searched(&core, p)).abs() < 1e-6,
                "{count} {p}"
            );
            // The normal leads straight away from the tool.
            let step = 1e-6;
            let farther = tool.distance(p + normal * step).0;
            assert!((farther - distance - step).abs() < 1e-11);
        }
        // Inside, no face is nearer than told.
        for _ in 0..100 {
            let p = dice.direction() * dice.within(0.0, 0.005);
            let (distance, normal) = tool.distance(p);
            if distance < -1e-5 {
                let margin = distance.abs() - 1e-6;
                assert!(tool.distance(p + dice.direction() * margin * 0.999).0 < 0.0);
                assert!(tool.distance(p + normal * (distance.abs() + 1e-9)).0 > 0.0);
            }
        }
    }
}

#[test]
fn the_cheap_bound_is_one() {
    let dice = &mut Dice::new(4);
    let tool = Tool::new(&ball_points(dice, 20), 0.002).expect("sound");
    for _ in 0..1000 {
        let p = dice.direction() * dice.within(0.0, 0.05);
        assert!(tool.least_distance(p) <= tool.distance(p).0.max(-tool.radius()) + 1e-15);
    }
}

#[test]
fn what_makes_no_tool_is_refused() {
    let refused = |core: &[DVec3], radius: f64| Tool::new(core, radius).expect_err("none").0;
    assert!(refused(&[], 0.01).contains("from 1 to 64"));
    assert!(refused(&[DVec3::ZERO; 65], 0.01).contains("65 core points"));
    assert!(refused(&[DVec3::NAN], 0.01).contains("core point 0"));
    assert!(refused(&[DVec3::ZERO], 0.0).contains("greater than zero"));
    assert!(refused(&[DVec3::ZERO], f64::NAN).contains("radius is NaN"));
}
