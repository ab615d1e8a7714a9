"""A body that nobody holds among others, in the servo: its ticks are those of a pile."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.free_shapes import free_block
from palpate_servo.harness import SteppedFingers

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.errors import PalpateError
from palpate.core.pile.pile import Pile
from palpate.core.pile.pile_settings import PileSettings
from palpate.core.rest.resting import Resting
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
        fingertips=[TIP],
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


@pytest.mark.parametrize(
    ("pascal", "friction", "apart"),
    # Soft ones lie for many ticks as they did, as far as their contacts can tell.
    [(1e5, 0.0, 1e-4), (1e5, 0.5, 0.03), (3e4, 0.0, 1e-4), (3e4, 0.5, 0.03)],
)
def test_each_tick_is_that_of_a_pile(cube, pascal, friction, apart):
    path, cube = press(), replace(cube, young_modulus=pascal)
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
    assert largest > 0.1 * pascal / 1e5
    assert np.abs(np.array(told) - felt).max() < apart * largest
    assert np.abs(np.array(places) - placements).max() < apart * EDGE


def firm_in_servo(cube, ticks=1500):
    """The upper one, pressed by 3 mm and a quarter firmer there; and where the tip is."""
    pile = come_down(stacked(cube, 0.5))
    servo = in_servo(pile, ABOVE, 0.5)
    down = ABOVE - [0.0, 0.0, 0.003]
    way = np.linspace(ABOVE, down, 200)
    servo.follow(np.concatenate([way, np.repeat(down[None], ticks, 0)])[:, None])
    held = servo.snapshot().held
    assert held > 0.0
    servo.set_firmness([held], [1.25])
    servo.follow(np.repeat(down[None], ticks, 0)[:, None])
    return servo, down


def test_the_touched_one_may_be_so_many_times_as_firm(cube):
    servo, down = firm_in_servo(cube)
    shot = servo.snapshot()
    assert 1.2 < shot.firmness <= 1.25
    firm = stacked(cube, 0.5, [(TIP, Pose.at(ABOVE))])
    firm.firm([shot.firmness, 1.0])
    firm.settle()
    firm.lead([Pose.at(down)])
    upper, _ = firm.settle()
    force = upper.tools[0].force
    assert shot.fingers[0].contact_force[2] == pytest.approx(force[2], rel=0.02)
    assert force[2] > 1.1 * _linear(cube, down)


def _linear(cube, down):
    pile = stacked(cube, 0.5, [(TIP, Pose.at(ABOVE))])
    pile.settle()
    pile.lead([Pose.at(down)])
    return pile.settle()[0].tools[0].force[2]


@pytest.mark.parametrize("ticks", [400, 4000])
def test_in_and_out_of_the_firmer_one_gives_nothing(cube, ticks):
    servo, down = firm_in_servo(cube)
    up = 0.0025 * np.sin(np.linspace(0.0, 2 * np.pi, ticks)) ** 2
    path = down + up[:, None] * [0.0, 0.0, 1.0]
    forces = servo.sent(path[:, None])[:, 0]
    assert np.abs(forces).max() > 0.5
    given = np.einsum("ta,ta->t", forces[1:], np.diff(path, axis=0)).sum()
    assert given < 1e-3 * np.abs(forces).max() * 0.0025 / 2


def test_it_looks_as_it_does_in_the_pile(cube):
    path = press()[:160]
    pile = come_down(stacked(cube, 0.0, [(TIP, Pose.at(path[0]))]))
    pile.tick()
    for place in path:
        pile.lead([Pose.at(place)])
        upper, lower = pile.step()
    servo = in_servo(come_down(stacked(cube)), path[0])
    servo.follow(path[:, None])
    shot = servo.snapshot()
    moved = displacements_of(cube, shot, cube.young_modulus)
    np.testing.assert_allclose(moved, upper.displacements(), atol=1e-7)
    assert np.abs(upper.displacements()).max() > 5e-4
    ((nodes, forces),) = shot.seen_from_body().other_loads
    moved = cube.deform(cube.mesh.surface_nodes[nodes], forces)
    np.testing.assert_allclose(moved, lower.displacements(), atol=1e-7)
    assert np.abs(lower.displacements()).max() > 1e-4


SMALL = sphere(0.0043)


@pytest.mark.parametrize("beside", [(0.0, 0.0), (0.002, -0.002), (-0.0025, 0.0035)])
def test_a_tip_smaller_than_points_of_bodies_are_apart_has_closer_ones(cube, beside):
    """The cubes' own are 8.7 mm apart."""
    places = [Pose.at([0.0, 0.0, EDGE + 1e-5]), Pose.at([0.0, 0.0, 0.0])]
    laid = [(cube, place) for place in places]

    def over(rest):
        """From a little above its top to 2 mm into it."""
        first = np.array([0.025 + beside[0], 0.025 + beside[1], 0.0])
        first[2] = rest.surface()[:, 2].max() + 0.0045
        return first - np.linspace(0.0, 0.0022, 100)[:, None] * [0.0, 0.0, 1.0]

    path = over(Resting(cube, [Floor()]).settle())
    alone = Resting(cube, [Floor()], [(SMALL, Pose.at(path[0]))])
    alone.settle()
    alone.lead([Pose.at(path[-1])])
    expected = alone.settle().tools[0].force[2]
    pile = Pile(laid, [Floor()], fingertips=[SMALL])
    path = over(pile.settle()[0])
    fingers = SteppedFingers(
        pile.native_body, path[:1], Settings(cube.young_modulus), prop=pile.laid()
    )
    fingers.set_tool(native_tool(cube, pile.native_body, SMALL), np.eye(3))
    forces, _ = fingers.follow(np.concatenate([path, np.repeat(path[-1:], 400, 0)])[:, None])
    pressed = Pile(laid, [Floor()], [(SMALL, Pose.at(path[0]))])
    pressed.settle()
    pressed.lead([Pose.at(path[-1])])
    (touch,) = pressed.settle()[0].tools
    # The cube beneath is squeezed by 0.16 mm of the 2, of which force is the power of 3/2.
    assert touch.force[2] == pytest.approx(expected * (1.0 - 0.08) ** 1.5, rel=0.03)
    assert len(touch.pushes) > 3
    assert forces[-1, 0, 2] == pytest.approx(touch.force[2], rel=0.03)


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
