//! Tools and places by the slope of their energy, and as springs on a linear body.

use super::*;
use crate::solid::history::scale;
use crate::solid::load::hold::Hold;

/// A ball of 1 m whose front is 0.1 m below a triangle that yields 0.5 m/N.
fn pressed(hold: Option<Hold>) -> Against {
    let places = [[4.0, 1.0, 1.0], [1.0, 4.0, 1.0]].map(|alpha| Place {
        corners: [0, 1, 2],
        known: [0, 1, 2],
        alpha: alpha.map(|share| share / 6.0),
        rest: DVec3::new(0.1 * alpha[0], 0.02 * alpha[1], 0.0),
        firmness: 7.0,
        tool: 0,
        hold,
    });
    let ball = Tool::new(&[DVec3::ZERO], 1.0).expect("a ball");
    let pose = Pose {
        position: DVec3::new(0.1, 0.0, 0.9),
        rotation: DMat3::IDENTITY,
    };
    let mut compliance = vec![DMat3::ZERO; 9];
    for node in 0..3 {
        compliance[4 * node] = 0.5 * DMat3::IDENTITY;
    }
    Against::new(places.to_vec(), vec![(ball, pose)], compliance, 3, 3).expect("it fits")
}

/// Smooth, so rough that places slide, and that they stick.
fn holds() -> [Option<Hold>; 3] {
    let rough = |friction| Hold {
        goal: DVec3::new(0.03, -0.02, 0.0),
        normal: DVec3::Z,
        friction,
        push: 0.5,
        pull: DVec3::new(0.01, 0.0, 0.0),
    };
    [None, Some(rough(0.05)), Some(rough(10.0))]
}

fn slides(against: &Against, moved: &Nodal) -> Option<bool> {
    against.aside(0, moved).map(|spring| spring.slides())
}

#[test]
fn its_forces_are_the_slope_of_its_energy() {
    for (hold, as_told) in holds().into_iter().zip([None, Some(true), Some(false)]) {
        let mut against = pressed(hold);
        let mut moved = vec![[0.01, 0.02, 0.005], [0.0, -0.01, 0.02], [0.02, 0.0, -0.01]];
        for counted in [false, true] {
            if counted {
                against.count_in(&moved);
                scale(&mut moved, 0.5);
            }
            assert_eq!(slides(&against, &moved), as_told);
            let mut forces = vec![[0.0; 3]; 3];
            against.take_from(&moved, &mut forces);
            for node in 0..3 {
                for axis in 0..3 {
                    let energies = [1e-6, -1e-6].map(|step| {
                        let mut beside = moved.clone();
                        beside[node][axis] += step;
                        against.energy(&beside)
                    });
                    let slope = (energies[0] - energies[1]) / 2e-6;
                    assert!((slope - forces[node][axis]).abs() < 1e-7);
                }
            }
            assert!(forces.iter().any(|force| force[2].abs() > 0.01));
        }
    }
}

#[test]
fn what_presses_holds_back_as_springs_on_a_linear_body_do() {
    let [smooth, _, sticks] = holds();
    for hold in [smooth, sticks] {
        let mut against = pressed(hold);
        against.look(&[[0.0; 3]; 3]);
        let (free, mut held) = (vec![[0.1, -0.2, -0.3]; 3], vec![[1.0; 3]; 3]);
        against.held_back(&free, &mut held);
        // u = free - C held, held = springs u.
        let moved: Vec<[f64; 3]> = (free.iter().zip(&held))
            .map(|(free, held)| [0, 1, 2].map(|axis| free[axis] - 0.5 * held[axis]))
            .collect();
        let mut sprung = vec![[0.0; 3]; 3];
        for (one, place) in against.places.iter().enumerate() {
            let (_, normal, _) = against.push(one, &[[0.0; 3]; 3]);
            let mean = place.mean(&moved);
            let aside = match hold {
                Some(_) => DVec3::new(mean.x, mean.y, 0.0),
                None => DVec3::ZERO,
            };
            place.add(
                place.firmness * (normal.dot(mean) * normal + aside),
                &mut sprung,
            );
        }
        assert_eq!(against.doing.len(), 2);
        for (held, sprung) in held.as_flattened().iter().zip(sprung.as_flattened()) {
            assert!((held - sprung).abs() < 1e-12);
        }
    }
}

#[test]
fn a_place_is_held_by_no_more_than_its_friction_and_where_it_sticks_gets_to_its_goal() {
    let moved = vec![[0.01, 0.02, 0.005]; 3];
    for (hold, wanted) in holds()
        .into_iter()
        .flatten()
        .zip([Some(0.05), None])
        .map(|(one, two)| (Some(one), two))
    {
        let mut against = pressed(hold);
        for _ in 0..3 {
            against.count_in(&moved);
        }
        let (push, normal, _) = against.push(0, &moved);
        let aside = against.force(0, &moved) - push * normal;
        match wanted {
            Some(friction) => {
                assert!((aside.length() - friction * against.counted[0]).abs() < 1e-12);
            }
            // As long as it is not there it is pulled ever more.
            None => assert!(aside.length() > 3.0 * 7.0 * DVec3::new(0.02, 0.04, 0.0).length()),
        }
        assert!(aside.x > 0.0 && aside.y < 0.0);
    }
}

#[test]
fn on_a_bed_nothing_is_missed_however_deep_it_gives() {
    let mut against = pressed(None);
    let still = vec![[0.0; 3]; 3];
    assert!(against.missed(&still) > 0.0);
    against.gives = true;
    assert!(against.missed(&still) == 0.0);
    assert!(against.pushes(&still).iter().all(|push| push.z < 0.0));
}
