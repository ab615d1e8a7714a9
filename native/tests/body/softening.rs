//! The corrected relation by itself: gradient, growth, the spring in series, and how it comes in.

use crate::bodies::Dice;
use glam::{DMat3, DVec3};
use palpate_servo::body::softening::blend::Blend;
use palpate_servo::body::softening::{BLEND_SECONDS, Felt, Relation, Softening, Softenings};

fn relation(dice: &mut Dice) -> Relation {
    let columns = [0, 1, 2].map(|_| dice.direction());
    let root = DMat3::from_cols(columns[0], columns[1], columns[2]);
    Relation {
        stiffness: (root * root.transpose() + DMat3::IDENTITY * 0.1) * 100.0,
        softening: Softening {
            slope: dice.direction() * dice.within(0.0, 100.0),
            saturation: dice.within(10.0, 5000.0),
        },
    }
}

#[test]
fn the_tangent_is_the_forces_derivative_and_never_below_the_linear_share() {
    let mut dice = Dice::new(1);
    for _ in 0..2000 {
        let relation = relation(&mut dice);
        let u = dice.direction() * 10_f64.powf(dice.within(-4.0, -0.5));
        let tangent = relation.tangent(u);
        let step = 1e-5 * u.length();
        for axis in DVec3::AXES {
            let slope =
                (relation.force(u + axis * step) - relation.force(u - axis * step)) / (2.0 * step);
            let missed = (slope - tangent * axis).length();
            assert!(
                missed < 1e-6 * tangent.x_axis.length().max(100.0),
                "{missed}"
            );
        }
        let any = dice.direction();
        let least = any.dot(relation.stiffness * any) * 0.05;
        assert!(any.dot(tangent * any) > least * (1.0 - 1e-9));
    }
}

#[test]
fn behind_a_spring_both_bear_the_same_force_and_share_the_way() {
    let mut dice = Dice::new(2);
    for round in 0..2000 {
        let mut relation = relation(&mut dice);
        let u = dice.direction() * dice.within(1e-4, 0.02);
        // Pressed in it softens.
        if relation.softening.slope.dot(u) < 0.0 {
            relation.softening.slope = -relation.softening.slope;
        }
        let compliance = dice.within(1e-4, 0.05);
        let v = relation.behind_spring(compliance, u);
        let missed = (v + relation.force(v) * compliance - u).length();
        assert!(missed < 1e-12 * u.length(), "{round}: {missed}");
        assert_eq!(relation.behind_spring(0.0, u), u);
    }
}

#[test]
fn a_node_counts_at_once_when_met_and_gradually_when_it_becomes_known_under_a_finger() {
    let softenings = Softenings::unknown(5);
    let one = Softening {
        slope: DVec3::X,
        saturation: 2.0,
    };
    (0..4).for_each(|node| softenings.tell(node, &one));
    let mut blend = Blend::default();
    let middle = [1.0 / 3.0; 3];
    let at_first = blend.follow(&softenings, [0, 1, 4], Felt::Corrected, 1e-3);
    assert!((blend.share(middle) - 2.0 / 3.0).abs() < 1e-15);
    assert_eq!(at_first[0], one);
    assert!(at_first[2].is_none());
    softenings.tell(4, &one);
    let mut before = blend.share(middle);
    let ticks = (BLEND_SECONDS / 1e-3).round() as usize;
    for _ in 0..ticks {
        // Corners may come in another order.
        blend.follow(&softenings, [4, 0, 1], Felt::Corrected, 1e-3);
        let share = blend.share(middle);
        assert!(share > before && share - before < 1.01 / 3.0 / ticks as f64);
        before = share;
    }
    assert!((before - 1.0).abs() < 1e-12);
    blend.follow(&softenings, [2, 3, 4], Felt::Corrected, 1e-3);
    assert_eq!(blend.share(middle), 1.0);
}

#[test]
fn another_choice_comes_in_gradually_while_touching_and_at_once_afterwards() {
    let softenings = Softenings::unknown(3);
    (0..3).for_each(|node| {
        softenings.tell(
            node,
            &Softening {
                slope: DVec3::X,
                saturation: 2.0,
            },
        );
    });
    let mut blend = Blend::default();
    let share = |blend: &mut Blend, felt| {
        blend.follow(&softenings, [0, 1, 2], felt, 1e-3);
        blend.share([1.0, 0.0, 0.0])
    };
    assert_eq!(share(&mut blend, Felt::Linear), 0.0);
    assert!((share(&mut blend, Felt::Corrected) - 1e-3 / BLEND_SECONDS).abs() < 1e-15);
    assert_eq!(share(&mut blend, Felt::Linear), 0.0);
    blend.let_go();
    assert_eq!(share(&mut blend, Felt::Corrected), 1.0);
}

#[test]
fn only_the_first_softening_of_a_node_counts() {
    let softenings = Softenings::unknown(1);
    assert_eq!(softenings.of(0), None);
    for saturation in [3.0, 4.0] {
        softenings.tell(
            0,
            &Softening {
                slope: DVec3::Y,
                saturation,
            },
        );
    }
    assert_eq!(softenings.of(0).map(|one| one.saturation), Some(3.0));
}
