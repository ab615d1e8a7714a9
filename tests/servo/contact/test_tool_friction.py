"""Friction of the servo's tools: at rest that of the engine, and what it must never do."""

import numpy as np
import pytest
from bodies.shared import highest_place
from palpate_servo.harness import SteppedFingers, ToolContact
from scipy.spatial.transform import Rotation

from palpate.core.contact.press import ContactSettings, Press
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import rod, sphere
from palpate.core.servo.session import native_tool
from palpate.core.servo.settings import Settings

TOOLS = {"sphere": sphere(0.018), "rod": rod(0.014, 0.015)}
FRICTION = 0.4
TICKS_TO_REST = 100


def above(body, tool):
    """Where a tool just touches the highest node about over the body's middle."""
    return highest_place(body) + np.array([0.0, 0.0, tool.radius])


def press_shear_unload():
    """Places (t, 3): 2 mm in, aside until all slips and about half back along another way, out."""
    down = [[0.0, 0.0, 0.0001 - 0.00015 * tick] for tick in range(15)]
    sheared = [[0.00015 * tick, 0.0, -0.002] for tick in range(1, 11)]
    back = [[0.0015 - 0.00015 * tick, 0.0001 * tick, -0.002] for tick in range(1, 8)]
    out = [[0.00045, 0.0007, -0.002 + 0.0004 * tick] for tick in range(1, 5)]
    return np.array(down + sheared + back + out)


def aside_and_push(contact):
    push = np.einsum("px,px->p", contact.forces, contact.normals)
    aside = np.linalg.norm(contact.forces - push[:, None] * contact.normals, axis=1)
    return aside, push


@pytest.mark.parametrize("name", list(TOOLS))
def test_the_servos_ticks_at_rest_are_the_engine_on_the_same_way(body, surface, name):
    tool = TOOLS[name]
    places = above(body, tool) + press_shear_unload()
    settings = Settings(body.young_modulus, static_friction=FRICTION, dynamic_friction=FRICTION)
    fingers = SteppedFingers(surface, places[:1], settings)
    fingers.set_tool(native_tool(body, surface, tool), np.eye(3))
    press = Press(body, [tool], ContactSettings(friction=FRICTION))
    forces, expected, torques, slid = [], [], [], 0.0
    for place in places:
        (touch,) = press.to([Pose.at(place)])
        felt, turned = fingers.follow(np.tile(place, (TICKS_TO_REST, 1, 1)))
        forces.append(felt[-1, 0])
        expected.append(touch.force)
        torques.append(np.abs(turned[-1, 0] - touch.torque).max())
        aside = touch.forces - touch.pushes[:, None] * touch.normals
        slid = max(slid, np.linalg.norm(aside, axis=1).sum() / max(touch.pushes.sum(), 1e-12))
    assert slid > 0.9 * FRICTION
    scale = np.abs(expected).max()
    np.testing.assert_allclose(forces, expected, atol=1e-6 * scale)
    assert max(torques) < 1e-6 * scale * tool.reach


def test_the_cone_holds_on_any_way(body, surface):
    dice = np.random.default_rng(5)
    tool = TOOLS["sphere"]
    for friction in (0.05, 0.7):
        contact = ToolContact(*native_tool(body, surface, tool), friction=friction)
        place = above(body, tool) + np.array([0.0, 0.0, 0.004])
        contact.restart(place, np.eye(3))
        way, most = np.zeros(3), 0
        for _ in range(400):
            way = np.clip(way + dice.normal(0, 1e-3, 3), -0.008, [0.008, 0.008, -0.003])
            turn = Rotation.from_rotvec(dice.normal(0, 0.2, 3)).as_matrix()
            contact.follow(place + way, turn, body.young_modulus)
            aside, push = aside_and_push(contact)
            assert (push > 0).all()
            assert (aside <= friction * push * (1 + 1e-9)).all()
            most = max(most, len(push))
        assert most >= 5


def test_friction_takes_energy_on_closed_ways_and_gives_none(body, surface):
    tool = TOOLS["sphere"]
    start = above(body, tool) + np.array([0.0, 0.0, 0.001])
    down = np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, -0.004], 80)
    angles = np.linspace(0.0, 2 * np.pi, 320)[:, None]
    round_trip = down[-1] + 0.003 * np.hstack([1 - np.cos(angles), np.sin(angles), 0 * angles])
    path = start + np.vstack([down, round_trip, down[::-1]])
    spent = {}
    for friction in (0.0, 0.1, 0.4):
        contact = ToolContact(*native_tool(body, surface, tool), friction=friction)
        contact.restart(path[0], np.eye(3))
        forces = []
        for place in path:
            contact.follow(place, np.eye(3), body.young_modulus)
            forces.append(contact.force)
        between = 0.5 * (np.array(forces)[1:] + np.array(forces)[:-1])
        works = -np.einsum("tx,tx->t", between, np.diff(path, axis=0))
        spent[friction] = works.sum() / np.abs(works[:79]).sum()
    assert abs(spent[0.0]) < 0.01
    assert spent[0.1] > 0.1
    assert spent[0.4] > spent[0.1]


def test_a_coefficient_below_zero_is_refused(body, surface):
    tool = native_tool(body, surface, TOOLS["sphere"])
    for friction in (-0.1, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="friction is"):
            ToolContact(*tool, friction=friction)
