"""A fingertip that goes deeper into a pinned body than its radius feels what it always felt."""

import numpy as np
import pytest
from palpate_servo.harness import SteppedFingers

from palpate.core.contact.place import nearest_place
from palpate.core.contact.press import ContactSettings, Press
from palpate.core.contact.single_press import set_down
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.servo.session import native_body, native_tool
from palpate.core.servo.settings import Settings

MODULUS, TIP = 5_000.0, sphere(0.008)
ON_THE_BACK = np.array([-0.027, -0.014, 0.057])
DEPTHS = (0.003, 0.006, 0.009, 0.012)
"""m."""
# At each depth, with this friction, N. What is about bodies that nobody holds may not change them.
FORCES = {
    0.0: [
        [-0.02618213837093392, -0.02453448094601694, 0.09465252222264185],
        [-0.06686044020125233, -0.06446113806169321, 0.24070552898660266],
        [-0.10721538050224902, -0.10812926537294087, 0.38947504089492324],
        [-0.15268642009518005, -0.1579155815977928, 0.5551700331723859],
    ],
    0.4: [
        [-0.02488043055568595, -0.021620877068130023, 0.09752299352874191],
        [-0.0666623854977284, -0.05690959618402195, 0.26768608953642975],
        [-0.11654557704165233, -0.09945047972965042, 0.47008769102672987],
        [-0.17513879097765664, -0.15029791825635536, 0.7016415048020409],
    ],
}
SAME = 1e-9
# Ticks on the way to a depth, and there. Deeper than its radius there is more than one equilibrium
# without friction, a little apart.
TICKS, ANOTHER = 200, 0.01
FARTHEST_BY_ONE_WAY = 0.009


def way_in(body):
    """Where the fingertip just touches the mouse's back, and the way in, (3,)."""
    place = nearest_place(body, ON_THE_BACK)
    return set_down(body, TIP, place), place.axis


@pytest.mark.parametrize("friction", list(FORCES))
def test_a_press_without_a_clock_is_unchanged(mouse, friction):
    start, axis = way_in(mouse)
    press = Press(mouse, [TIP], ContactSettings(MODULUS, friction))
    felt = [
        press.to([Pose(start.position + depth * axis, start.rotation)])[0].force for depth in DEPTHS
    ]
    stored = np.array(FORCES[friction])
    assert np.abs(felt - stored).max() <= SAME * np.abs(stored).max()


def test_a_press_by_ticks_comes_to_the_same(mouse):
    start, axis = way_in(mouse)
    native = native_body(mouse, whole=True)
    servo = SteppedFingers(native, start.position[None], Settings(MODULUS), max_force=10.0)
    servo.set_tool(native_tool(mouse, native, TIP), start.rotation, 0)
    before, stored = 0.0, np.array(FORCES[0.0])
    for depth, force in zip(DEPTHS, stored, strict=True):
        depths = np.concatenate([np.linspace(before, depth, TICKS), np.full(TICKS, depth)])
        forces, _ = servo.follow((start.position + depths[:, None] * axis)[:, None])
        bound = SAME if depth <= FARTHEST_BY_ONE_WAY else ANOTHER
        assert np.abs(forces[-1][0] - force).max() <= bound * np.abs(stored).max()
        before = depth
