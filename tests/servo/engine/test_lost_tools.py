"""A tool that another one leaves in the body, without anything that it presses, is let go."""

from pathlib import Path

import numpy as np
import pytest
from palpate_servo.harness import SteppedFingers

from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.contact.tool.tools import sphere
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.servo.session import native_body, native_tool
from palpate.core.servo.settings import Settings
from palpate.core.stiffness.pins import PinNodes

SAMPLES = Path(__file__).resolve().parents[3] / "sample_scenes"
RADIUS = 0.01135585803752847
# Two fingertips set down in the hare beside each other; in the fourth tick one is lost, m.
FIRST = [[8.8, 27.2, 184.9], [8.7, 27.1, 184.9], [8.7, 27.1, 184.8], [8.6, 27.1, 184.8]]
SECOND = [[7.8, 31.9, 181.3], [7.7, 31.8, 181.3], [7.6, 31.8, 181.2], [7.5, 31.7, 181.2]]
PATH = 1e-3 * np.stack([FIRST, SECOND], axis=1)


@pytest.fixture(scope="module")
def hare():
    with np.load(SAMPLES / "hare-tets.npz") as stored:
        mesh, fixed = TetMesh.checked(stored["X"], stored["T"]), stored["fixed"]
    return bake(mesh, BakeSettings(0.3, 10_000.0, PinNodes(fixed)))[0]


def test_another_tool_is_felt_in_the_tick_in_which_one_is_lost(hare):
    native = native_body(hare, whole=True)
    fingers = SteppedFingers(native, PATH[0], Settings(hare.young_modulus))
    tool = native_tool(hare, native, sphere(RADIUS))
    for finger in (0, 1):
        fingers.set_tool(tool, np.eye(3), finger)
    forces = np.asarray(fingers.sent(PATH))
    # One is let go in that tick; the other presses on.
    assert np.isfinite(forces).all()
    touching = [bool(shot.touching) for shot in fingers.snapshot().fingers]
    assert sorted(touching) == [False, True]
