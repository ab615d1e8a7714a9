"""The surface that is touched: its nearest points, and what is none."""

import numpy as np
import pytest
from palpate_servo import Body


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
        (lambda n, t, b: (np.where(n == n.max(), np.nan, n), t, b), "must be finite"),
        (lambda n, t, b: (n, t, b * np.inf), "contact block 0 is .* must be finite"),
        (lambda n, t, b: (n, t + 1, b), "beyond the 98 nodes"),
        (lambda n, t, b: (n, t - 1, b), "names the node -1"),
        (lambda n, t, b: (n * [1, 1, 0], t, b), "no area"),
        (lambda n, t, b: (n, t[:0], b), "has 0 triangles; it must have from 1"),
        (lambda n, t, b: (n[:, :2], t, b), r"nodes has the shape \[\d+, 2\]; it must be \(n, 3\)"),
    ],
)
def test_a_surface_that_cannot_be_touched_is_refused_with_the_reason(cube, change, reason):
    with pytest.raises(ValueError, match=reason):
        Body(*change(cube.nodes, cube.triangles, cube.blocks))
