"""Bodies for the servo's tests: a made-up one, for which nothing is baked, and baked ones."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from bodies.shared import mouse_mesh  # noqa: F401
from palpate_servo import Body

from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.servo.session import native_body
from palpate.core.stiffness.pins import PinNodes

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from palpate.core.body.soft_body import SoftBody

YOUNG_MODULUS = 10_000.0
FELT = 0.3
"""N."""
PRESSES = 5


@dataclass(frozen=True)
class SoftCube:
    """The paper's cube, 50 mm, 98 surface nodes, with made-up stiffness, native and as arrays."""

    nodes: NDArray[np.float64]
    triangles: NDArray[np.int64]
    blocks: NDArray[np.float64]
    native: Body


@pytest.fixture(scope="session")
def cube() -> SoftCube:
    mesh, _ = paper_cube()
    nodes = mesh.nodes[mesh.surface_nodes]
    triangles = np.searchsorted(mesh.surface_nodes, mesh.surface_triangles)
    factors = np.random.default_rng(98).normal(size=(len(nodes), 3, 3))
    # About 100 N/m at 10 kPa, different from node to node and direction to direction.
    blocks = 0.004 * (factors @ factors.swapaxes(1, 2)) + 0.01 * np.eye(3)
    return SoftCube(nodes, triangles, blocks, Body(nodes, triangles, blocks))


@pytest.fixture(scope="session")
def cube_body() -> SoftBody:
    """The paper's cube, baked."""
    mesh, fixed = paper_cube()
    return bake(mesh, BakeSettings(0.49, 10_000.0, PinNodes(fixed)))[0]


@pytest.fixture(scope="session")
def whole(cube_body: SoftBody) -> Body:
    """The baked cube as native code holds it, with its whole compliance."""
    return native_body(cube_body, whole=True)


@pytest.fixture(scope="session", params=["cube", "mouse"])
def body(request: pytest.FixtureRequest) -> SoftBody:
    """A baked body for tools; its contact points and near field are made once for all tests."""
    if request.param == "cube":
        baked: SoftBody = request.getfixturevalue("cube_body")
        return baked
    mesh, fixed = request.getfixturevalue("mouse_mesh")
    return bake(mesh, BakeSettings(0.3, 1_000.0, PinNodes(fixed)))[0]


@pytest.fixture(scope="session")
def surface(body: SoftBody) -> Body:
    """The baked body as native code holds it, with its whole compliance."""
    return native_body(body, whole=True)


@pytest.fixture(scope="session")
def press_into(eventually: Callable[..., Any]) -> Callable[..., None]:
    """Lead a simulated device's hand from where it is free to where more than ``felt`` N are sent.

    A machine that is held up meanwhile has the probe set down inside of the body: then again.
    """

    def go(device: Any, servo: Any, free: Any, deep: Any, felt: float = FELT) -> None:
        def stands() -> str:
            shot = servo.snapshot()
            return "felt" if np.linalg.norm(shot.output_force) > felt else shot.reason

        for _ in range(PRESSES):
            device.move_hand(deep, 0.3)
            eventually(lambda: stands() in ("felt", "inside the body"), servo.snapshot)
            if stands() == "felt":
                return
            device.move_hand(free, 0.3)
            eventually(lambda: servo.snapshot().reason != "inside the body", servo.snapshot)
        pytest.fail(f"not felt: {servo.snapshot()}")

    return go
