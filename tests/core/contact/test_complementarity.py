import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import nnls

from palpate.core.contact.complementarity import solve_complementarity


def problem(rng, size, condition=1e3):
    turn = np.linalg.qr(rng.normal(size=(size, size)))[0]
    matrix = (turn * np.geomspace(1, condition, size)) @ turn.T
    return (matrix + matrix.T) / 2, rng.normal(size=size)


def energy(matrix, gaps, forces):
    return 0.5 * forces @ matrix @ forces + gaps @ forces


@given(st.integers(0, 2**32 - 1), st.integers(1, 60))
def test_pushes_are_those_of_nonnegative_least_squares(seed, size):
    matrix, gaps = problem(np.random.default_rng(seed), size)
    found = solve_complementarity(matrix, gaps)
    # 1/2 f A f + g f is half the square of U f - b, with A = U'U and U'b = -g.
    upper = np.linalg.cholesky(matrix).T
    expected, _ = nnls(upper, -np.linalg.solve(upper.T, gaps))
    assert found.exact
    np.testing.assert_allclose(found.forces, expected, atol=1e-11)


@given(st.integers(0, 2**32 - 1))
def test_any_start_leads_to_the_same_pushes_and_a_good_one_is_kept(seed):
    rng = np.random.default_rng(seed)
    matrix, gaps = problem(rng, 40)
    cold = solve_complementarity(matrix, gaps)
    warm = solve_complementarity(matrix, gaps, rng.normal(size=40) * rng.choice([1e-3, 1, 1e3]))
    np.testing.assert_allclose(warm.forces, cold.forces, atol=1e-11)
    again = solve_complementarity(matrix, gaps, cold.forces)
    assert again.rounds == 1
    near = solve_complementarity(matrix, gaps + 1e-9 * rng.normal(size=40), cold.forces)
    assert near.rounds == 1


def test_gaps_and_forces_exclude_each_other(rng):
    for _ in range(20):
        matrix, gaps = problem(rng, 30)
        found = solve_complementarity(matrix, gaps)
        assert (found.forces >= 0).all()
        assert found.gaps.min() > -1e-12
        assert np.abs(found.forces * found.gaps).max() < 1e-12


def test_work_that_is_cut_short_still_pushes_and_lowers_the_energy(rng):
    for _ in range(20):
        matrix, gaps = problem(rng, 50, 1e8)
        start = np.abs(rng.normal(size=50)) * 0.01
        before = min(0.0, energy(matrix, gaps, start))
        for rounds in (1, 2, 3, 40):
            found = solve_complementarity(matrix, gaps, start, most_rounds=rounds)
            after = energy(matrix, gaps, found.forces)
            assert (found.forces >= 0).all()
            assert after <= before + 1e-15
            before = after
        assert found.exact


def test_a_singular_matrix_of_points_that_coincide_is_handled(rng):
    matrix, gaps = problem(rng, 10)
    twice = np.concatenate([np.arange(10), np.arange(10)])
    found = solve_complementarity(matrix[np.ix_(twice, twice)], gaps[twice])
    single = solve_complementarity(matrix, gaps)
    shared = found.forces[:10] + found.forces[10:]
    assert (found.forces >= 0).all()
    np.testing.assert_allclose(shared, single.forces, atol=1e-6)


def test_nothing_overlapped_needs_no_force():
    found = solve_complementarity(np.eye(3), np.array([0.0, 1.0, 2.0]), np.ones(3))
    np.testing.assert_array_equal(found.forces, 0.0)
    none = solve_complementarity(np.empty((0, 0)), np.empty(0))
    assert none.exact
    assert none.forces.shape == (0,)


@pytest.mark.parametrize("size", [3, 20])
def test_points_that_are_lifted_by_their_neighbours_carry_nothing(size):
    # A stiff row in which each point presses its neighbours down by nine tenths.
    order = np.arange(size)
    matrix = 0.9 ** np.abs(order[:, None] - order)
    gaps = np.full(size, 0.5)
    gaps[size // 2] = -1.0
    found = solve_complementarity(matrix, gaps)
    assert np.flatnonzero(found.forces).tolist() == [size // 2]
    assert found.forces[size // 2] == pytest.approx(1.0)
