use super::*;

/// Firm as 1 + s / 4 + s^2 / 4 at some depths s.
fn firm() -> Firmness {
    let known = [0.5_f64, 1.0, 1.5, 2.0].map(|s| (s * s, 1.0 + 0.25 * s + 0.25 * s * s));
    Firmness::through(&known).unwrap()
}

#[test]
fn it_is_as_told_at_the_knots_straight_between_them_and_stays_beyond() {
    let firm = firm();
    assert_eq!(firm.at(0.0), 1.0);
    assert_eq!(firm.at(1.0), 1.5);
    assert!((firm.at(1.25 * 1.25) - 0.5 * (firm.at(1.0) + firm.at(2.25))).abs() < 1e-12);
    assert!((firm.at(0.0625) - 0.5 * (1.0 + firm.at(0.25))).abs() < 1e-12);
    assert_eq!((firm.at(4.0), firm.at(1e9)), (2.5, 2.5));
    assert!((firm.at(4.0 - 1e-9) - firm.at(4.0 + 1e-9)).abs() < 1e-8);
}

#[test]
fn what_is_held_is_the_integral_of_the_firmness() {
    for most in [0.1, 0.5, 3.9, 4.0, 9.0] {
        let steps = 100_000;
        let each = most / f64::from(steps);
        let middle = |k: u32| firm().at((f64::from(k) + 0.5) * each);
        let sum: f64 = (0..steps).map(middle).sum();
        assert!((sum * each / most - firm().mean(most, 0.0)).abs() < 1e-6);
    }
}

#[test]
fn what_a_spring_holds_that_has_gone_back_is_its_work_on_the_way_out() {
    let firm = firm();
    for (energy, remembered) in [(0.3, 0.5), (1.0, 2.0), (3.0, 0.1), (9.0, 0.4), (0.01, 30.0)] {
        let held = |r: f64, of: f64| {
            let steps = 20_000;
            let sum: f64 = (0..steps)
                .map(|k| (f64::from(k) + 0.5) / f64::from(steps) * of)
                .map(|s| firm.at(energy * (s + r) * (s + r)) * s)
                .sum();
            2.0 * energy * sum * of / f64::from(steps)
        };
        let mean = firm.mean(energy, remembered);
        assert!((held(remembered, 1.0) / energy - mean).abs() < 1e-6 * mean);
        // Where the place stays, the spring goes back by what is remembered more.
        let more = 1e-4;
        let gone = held(remembered, 1.0) - held(remembered + more, 1.0 - more);
        let force = firm.at(energy * (1.0 + remembered).powi(2)) * 2.0 * energy;
        let lost = force * more * (1.0 - firm.kept(energy, remembered));
        assert!((gone - lost).abs() < 1e-3 * force * more, "{gone} {lost}");
    }
}

#[test]
fn the_force_grows_as_steeply_as_is_told() {
    // The force goes with the depth s times G, and s with the root of the energy.
    let firm = firm();
    let force = |s: f64| s * firm.at(s * s);
    for s in [0.1, 0.9, 1.9, 3.0] {
        let slope = (force(s + 1e-6) - force(s - 1e-6)) / 2e-6;
        assert!((slope / firm.at(s * s) - firm.steepness(s * s)).abs() < 1e-6);
    }
}

#[test]
fn it_is_bounded_and_told_by_numbers_that_ascend() {
    let wild = Firmness::through(&[(1.0, -5.0), (4.0, 1e9)]).unwrap();
    assert_eq!((wild.at(1.0), wild.at(4.0)), (LEAST, MOST));
    assert!(Firmness::through(&[]).unwrap().is_linear());
    assert_eq!(Firmness::default().at(1.0), 1.0);
    assert_eq!(Firmness::default().mean(1.0, 0.0), 1.0);
    for wrong in [
        [(1.0, 1.0), (1.0, 1.0)],
        // Energies that ascend, but their roots are the same.
        [(1.0, 1.0), (1.0 + f64::EPSILON, 1.0)],
        [(0.0, 1.0), (1.0, 1.0)],
        [(-1.0, 1.0), (1.0, 1.0)],
        [(1.0, f64::NAN), (2.0, 1.0)],
        [(1.0, 1.0), (f64::INFINITY, 1.0)],
    ] {
        assert!(Firmness::through(&wrong).is_none());
    }
    let many: Vec<_> = (0..=MOST_KNOTS).map(|k| (1.0 + k as f64, 1.0)).collect();
    assert!(Firmness::through(&many).is_none());
}

#[test]
fn between_two_of_them_it_is_never_beyond_both_and_comes_to_the_other() {
    let firm = firm();
    let shallow = Firmness::through(&[(1e-12, 1.001)]).unwrap();
    let mut now = shallow.beside(&firm, 4.0);
    for _ in 0..50 {
        now.fade(&firm, 1e-3);
    }
    assert!(now.at(4.0) > 1.0 + 0.3 * 1.5 && now.at(4.0) < 2.5);
    for _ in 0..2000 {
        now.fade(&firm, 1e-3);
        for energy in [1e-13, 1e-6, 0.1, 4.0] {
            assert!(now.at(energy) > 1.0 - 1e-9 && now.at(energy) <= 2.5);
        }
    }
    for energy in [0.01, 1.0, 2.0, 4.0, 9.0] {
        assert!((now.at(energy) - firm.at(energy)).abs() < 1e-9);
    }
    let mut back = firm.beside(&Firmness::default(), 2.0);
    for _ in 0..2000 {
        assert!(back.at(2.0) >= 1.0 && back.at(2.0) <= firm.at(2.0));
        back.fade(&Firmness::default(), 1e-3);
    }
    assert!(back.is_linear());
}

#[test]
fn where_another_comes_it_is_at_first_what_it_was() {
    let many: Vec<_> = (1..=MOST_KNOTS)
        .map(|k| (0.01 * (k * k) as f64, 1.0 + 0.1 * (k % 3) as f64))
        .collect();
    let many = Firmness::through(&many).unwrap();
    let other = Firmness::through(&[(0.3, 2.0), (3.0, 3.0)]).unwrap();
    for press in [0.02, 1.0, 9.0, 30.0] {
        let beside = many.beside(&other, press);
        for near in [0.95, 1.0, 1.05] {
            assert!((beside.at(near * press) - many.at(near * press)).abs() < 1e-3);
        }
        // As many times as it may come.
        let mut now = beside;
        for _ in 0..5 {
            now = now.beside(&other, press).beside(&many, press);
        }
        assert!((now.at(press) - many.at(press)).abs() < 1e-3);
    }
}
