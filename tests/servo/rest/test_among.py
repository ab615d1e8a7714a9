"""A body that nobody holds among others, in the servo: its ticks are those of a pile."""

import numpy as np
import pytest
from bodies.free_shapes import free_block
from palpate_servo.harness import SteppedFingers

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.errors import PalpateError
from palpate.core.pile.pile import Pile
from palpate.core.pile.pile_settings import PileSettings
from palpate.core.rest.support import Floor
from palpate.core.servo.session import displacements_of, native_tool
from palpate.core.servo.settings import Settings

EDGE = 0.05
TIP = sphere(0.01)
ABOVE = np.array([0.027, 0.023, 2 * EDGE + 0.0102])


@pytest.fixture(scope="module")
def cube():
    """50 mm, 125 g."""
    return free_block((EDGE,) * 3, (4, 4, 4))


def stacked(cube, friction=0.0, tools=()):
    """The upper one first: it is the one that is touched."""
    places = [Pose.at([0.0, 0.0, EDGE + 1e-5]), Pose.at([0.0, 0.0, 0.0])]
    return Pile(
        [(cube, place) for place in places],
        [Floor(friction=friction)],
        tools,
        settings=PileSettings(friction=friction, spacing=0.013),
    )


def come_down(pile):
    """The same where all that bears it has been found: the servo finds so much in a tick."""
    for _ in range(5):
        pile.tick()
    return pile


def in_servo(pile, start, friction=0.0):
    native, body = pile.native_body, pile.bodies[0]
    settings = Settings(body.young_modulus, static_friction=friction, dynamic_friction=friction)
    fingers = SteppedFingers(native, start[None], settings, prop=pile.laid())
    fingers.set_tool(native_tool(body, native, TIP), np.eye(3))
    return fingers


def press(depth=0.003, ticks=120):
    """Waits, comes down, slides a little and goes up again."""
    share = np.concatenate(
        [np.zeros(40), np.linspace(0.0, 1.0, ticks), np.linspace(1.0, 0.0, ticks)]
    )
    aside = 0.001 * np.sin(3.0 * share)
    return ABOVE + np.column_stack([aside, 0.5 * aside, -(depth + 2e-4) * share])


@pytest.mark.parametrize(("friction", "apart"), [(0.0, 1e-4), (0.5, 0.03)])
def test_each_tick_is_that_of_a_pile(cube, friction, apart):
    path = press()
    pile = come_down(stacked(cube, friction, [(TIP, Pose.at(path[0]))]))
    pile.tick()
    felt, placements = [], []
    for place in path:
        pile.lead([Pose.at(place)])
        upper, lower = pile.step()
        felt.append(upper.tools[0].force)
        placements.append((upper.placement.position, lower.placement.position))
    servo = in_servo(come_down(stacked(cube, friction)), path[0], friction)
    told, places = [], []
    for place in path:
        force, _ = servo.follow(place[None, None])
        shot = servo.snapshot()
        told.append(force[0, 0])
        places.append((shot.placement[0], shot.others[0][0]))
    largest = np.abs(felt).max()
    assert largest > 0.2
    assert np.abs(np.array(told) - felt).max() < apart * largest
    assert np.abs(np.array(places) - placements).max() < apart * EDGE


def test_it_looks_as_it_does_in_the_pile(cube):
    path = press()[:160]
    pile = come_down(stacked(cube, 0.0, [(TIP, Pose.at(path[0]))]))
    pile.tick()
    for place in path:
        pile.lead([Pose.at(place)])
        upper, _ = pile.step()
    servo = in_servo(come_down(stacked(cube)), path[0])
    servo.follow(path[:, None])
    moved = displacements_of(cube, servo.snapshot(), cube.young_modulus)
    assert np.abs(upper.displacements()).max() > 1e-4
    np.testing.assert_allclose(moved, upper.displacements(), atol=1e-8)


def test_a_point_waits_for_a_tool(cube):
    pile = stacked(cube)
    start = np.array([0.025, 0.025, 2 * EDGE + 1e-3])
    fingers = SteppedFingers(
        pile.native_body, start[None], Settings(cube.young_modulus), prop=pile.laid()
    )
    forces, _ = fingers.follow(np.linspace(start, start - [0.0, 0.0, 0.004], 50)[:, None])
    assert np.all(forces == 0.0)
    assert "tool" in fingers.snapshot().reason


def test_a_tool_set_down_in_the_other_body_feels_nothing_until_it_was_outside(cube):
    pile = stacked(cube)
    within = np.array([0.025, 0.025, 0.02])
    servo = in_servo(pile, within)
    forces, _ = servo.follow(np.repeat(within[None, None], 20, 0))
    assert np.all(forces == 0.0)
    aside = within + np.array([0.06, 0.0, 0.0])
    servo.follow(np.linspace(within, aside, 100)[:, None])
    forces, _ = servo.follow(np.linspace(aside, aside - [0.028, 0.0, 0.0], 100)[:, None])
    assert forces[-1, 0, 0] > 0.1


def test_what_cannot_be_laid_is_refused(cube):
    with pytest.raises(PalpateError, match="fingers lead them"):
        stacked(cube, 0.0, [(TIP, Pose.at(ABOVE))]).laid()
    many = [(cube, Pose.at([0.0, 0.0, 0.06 * k])) for k in range(5)]
    with pytest.raises(PalpateError, match="at most 4"):
        Pile(many).laid()
