"""Equations (11) to (14) in the native code against the same in plain numpy."""

import numpy as np
import pytest
from palpate_servo import Body

PRESSES = 10_000


def reference(cube, triangle, alpha, displacement, young_modulus):
    """f_a = L_aa^-1 u (11), F_a = alpha_a f_a (12), (13), F_f = -sum F_a (14)."""
    blocks = young_modulus * cube.blocks[cube.triangles[triangle]]
    nodal_forces = alpha[:, None] * np.einsum("aij,j->ai", blocks, displacement)
    return nodal_forces, -nodal_forces.sum(axis=0)


def test_force_equals_the_formula_inside_on_edges_and_on_nodes(cube):
    rng = np.random.default_rng(14)
    for number in range(PRESSES):
        triangle = int(rng.integers(len(cube.triangles)))
        alpha = rng.dirichlet([1, 1, 1])
        alpha[rng.permutation(3)[: number % 3]] = 0
        alpha /= alpha.sum()
        u = rng.normal(size=3) * 10 ** rng.uniform(-7, -2)
        modulus = 10 ** rng.uniform(2, 6)
        nodal_forces, force = cube.native.contact(triangle, alpha, u, modulus)
        expected_nodal, expected = reference(cube, triangle, alpha, u, modulus)
        scale = np.abs(expected_nodal).max()
        assert np.abs(nodal_forces - expected_nodal).max() <= 1e-9 * scale
        assert np.abs(force - expected).max() <= 1e-9 * scale


def edges_of(triangles):
    """Every edge with its two triangles."""
    found = {}
    for number, triangle in enumerate(triangles):
        for k in range(3):
            pair = tuple(sorted((int(triangle[k]), int(triangle[(k + 1) % 3]))))
            found.setdefault(pair, []).append(number)
    return found


def test_both_triangles_of_an_edge_give_the_same_force(cube):
    rng = np.random.default_rng(12)
    for (i, j), pair in edges_of(cube.triangles).items():
        part = rng.choice([0.0, 1.0, rng.random()])
        u = rng.normal(size=3) * 1e-3
        forces = []
        for triangle in pair:
            nodes = cube.triangles[triangle]
            alpha = np.where(nodes == i, 1 - part, np.where(nodes == j, part, 0.0))
            forces.append(cube.native.contact(triangle, alpha, u, 1e4)[1])
        np.testing.assert_allclose(forces[0], forces[1], rtol=1e-14)


def test_closest_point_is_the_cubes(cube):
    rng = np.random.default_rng(5)
    for p in rng.uniform(-0.02, 0.07, size=(2000, 3)):
        triangle, alpha, point, distance = cube.native.closest_point(p)
        nearest = np.clip(p, 0, 0.05)
        outside = np.linalg.norm(p - nearest)
        depth = min(p.min(), (0.05 - p).min())
        assert distance == pytest.approx(outside if outside > 0 else -depth, abs=1e-15)
        np.testing.assert_allclose(alpha @ cube.nodes[cube.triangles[triangle]], point, atol=1e-15)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda n, t, b: (n, t[:-1], b), "not closed"),
        (lambda n, t, b: (n, t[:, ::-1], b), "inside out"),
        (lambda n, t, b: (n, t, b[:-1]), "97 blocks for 98 nodes"),
        (lambda n, t, b: (np.where(n == n.max(), np.nan, n), t, b), "not finite"),
        (lambda n, t, b: (n, t, b * np.inf), "contact block 0 is not finite"),
        (lambda n, t, b: (n, t + 1, b), "beyond the 98 nodes"),
        (lambda n, t, b: (n, t - 1, b), "names the node -1"),
        (lambda n, t, b: (n * [1, 1, 0], t, b), "no area"),
        (lambda n, t, b: (n, t[:0], b), "no triangles"),
        (lambda n, t, b: (n[:, :2], t, b), "three columns"),
    ],
)
def test_a_surface_that_cannot_be_touched_is_refused_with_the_reason(cube, change, reason):
    with pytest.raises(ValueError, match=reason):
        Body(*change(cube.nodes, cube.triangles, cube.blocks))
