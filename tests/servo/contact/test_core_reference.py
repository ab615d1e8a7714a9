"""The native contact against the equations of the paper and what continues them, on real bodies."""

import time

import numpy as np
import pytest
from bodies.shared import nodal_forces_of
from palpate_servo import Pointer

from palpate.core.errors import PalpateError
from palpate.core.servo.session import displacements_of, native_body, servo_on
from palpate.core.servo.settings import Settings

PRESSES = 10_000


def random_alpha(rng):
    """Inside, on an edge, or on a node, one as often as the other."""
    alpha = rng.dirichlet([1, 1, 1])
    alpha[rng.permutation(3)[: rng.integers(0, 3)]] = 0
    return alpha / alpha.sum()


REST_TICKS = 50


@pytest.mark.parametrize("mode", ["paper", "consistent"])
def test_native_force_equals_the_reference_at_random_presses(body, mode):
    rng = np.random.default_rng(1999)
    native = native_body(body)
    for _ in range(PRESSES):
        triangle = int(rng.integers(len(body.mesh.surface_triangles)))
        alpha, u = random_alpha(rng), rng.normal(size=3) * 0.005
        expected = nodal_forces_of(body, triangle, alpha, u, mode)
        nodal_forces, force = native.contact(triangle, alpha, u, body.young_modulus, mode)
        scale = np.abs(expected).max()
        assert np.abs(nodal_forces - expected).max() <= 1e-9 * scale
        assert np.abs(force + expected.sum(axis=0)).max() <= 1e-9 * scale


@pytest.mark.parametrize("mode", ["paper", "consistent"])
def test_the_running_servo_publishes_what_the_reference_computes(body, mode):
    low, high = body.mesh.nodes.min(axis=0), body.mesh.nodes.max(axis=0)
    above = np.array([*(0.5 * (low + high))[:2], high[2] + 0.01])
    with servo_on(native_body(body), Settings(body.young_modulus, mode=mode)) as servo:
        servo.start(Pointer(above))
        servo.set_target(above - [0, 0, 0.02])
        snapshot = servo.snapshot()
        deadline = time.monotonic() + 20
        while not (snapshot.touching and np.allclose(snapshot.probe, above - [0, 0, 0.02])):
            assert time.monotonic() < deadline, snapshot
            time.sleep(0.01)
            snapshot = servo.snapshot()
        # At rest no brake is left of the way (`native/src/control/toll.rs`).
        arrived = snapshot.tick
        while snapshot.tick < arrived + REST_TICKS:
            assert time.monotonic() < deadline, snapshot
            time.sleep(0.01)
            snapshot = servo.snapshot()
    u = snapshot.probe - snapshot.proxy
    forces = nodal_forces_of(body, snapshot.triangle_index, snapshot.alpha, u, mode)
    np.testing.assert_allclose(snapshot.contact_force, -forces.sum(axis=0), rtol=1e-9)
    np.testing.assert_allclose(snapshot.nodal_forces, forces, rtol=1e-9, atol=1e-15)
    triangle = body.mesh.surface_triangles[snapshot.triangle_index]
    moved = displacements_of(body, snapshot)
    np.testing.assert_allclose(
        moved, body.deform(triangle, forces), atol=1e-9 * np.abs(moved).max()
    )


@pytest.mark.parametrize(
    ("setting", "told"),
    [
        ({"rate_hz": 10}, "servo: .*rate"),
        ({"max_force": -1.0}, "servo: .*force"),
        ({"young_modulus": 0.0}, "servo: .*young_modulus"),
    ],
)
def test_settings_out_of_range_are_refused(body, setting, told):
    options = {"young_modulus": body.young_modulus} | setting
    modulus = options.pop("young_modulus")
    with pytest.raises(PalpateError, match=told):
        servo_on(native_body(body), Settings(modulus), **options)
