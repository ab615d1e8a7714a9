"""Points and tools give no energy on closed paths without friction."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.soft_block import soft_block
from palpate_servo.harness import SteppedFingers
from referees.energy_loops import Span, books, random_loops, random_pairs
from referees.led_tips import Tip, led, tip_of

from palpate.core.contact.tool.tools import plate, sphere
from palpate.core.servo.session import native_body
from palpate.core.servo.settings import Coupling, Settings

YOUNG_MODULUS = 10_000.0
# Shares of F d / 2.
MOST = 1e-3
LOOPS = 40
SPAN = Span()
POINTS = (Tip(), Tip())


def loops_of(body, count, span=SPAN, seed=14):
    mesh = body.mesh
    free = ~np.isin(mesh.surface_nodes, body.fixed)
    nodes, triangles = mesh.nodes[mesh.surface_nodes], mesh.surface_local_triangles
    return list(random_loops(nodes, triangles, free, count, seed, span))


def books_of(surface, together, settings, motors=None, tips=POINTS):
    found = []
    for loops in together:
        follow = led(surface, settings, loops, tips[: len(loops)], motors)
        found.append(books(loops, follow))
    return [one for one in found if one is not None]


def gives_nothing(found, loops=LOOPS):
    rounds = [gain for one in found for gain in one.rounds]
    # Of two that are led together few come back to the same forces; all paths count.
    assert rounds
    assert len(found) > loops / 2
    assert max(rounds) <= MOST
    assert max(one.path for one in found) <= MOST


@pytest.mark.parametrize("shading", [False, True], ids=["facets", "shaded"])
def test_no_closed_path_gives_energy(body, shading):
    alone = [(loop,) for loop in loops_of(body, LOOPS)]
    gives_nothing(books_of(native_body(body), alone, Settings(YOUNG_MODULUS, shading=shading)))


@pytest.mark.parametrize("max_force", [3.0, 0.2], ids=["whole", "cut off"])
def test_none_gives_energy_to_motors(body, max_force):
    """The forces as sent: behind the coupling, and cut off by what the motors bear."""
    alone = [(loop,) for loop in loops_of(body, LOOPS)]
    coupled = Settings(YOUNG_MODULUS, coupling=Coupling(800.0, 4.0, passivity_control=True))
    gives_nothing(books_of(native_body(body), alone, coupled, max_force))


def test_a_way_along_a_face_is_not_counted():
    """It touches by rounding, and a share of such a force says nothing."""
    block = soft_block((0.02, 0.02, 0.02), (2, 2, 2), poisson_ratio=0.3)
    top, middle = block.mesh.nodes[:, 2].max(), block.mesh.nodes.mean(axis=0)
    loop = loops_of(block, 1)[0]
    start = np.append(middle[:2] + 1e-3, top - 4 * np.spacing(top))
    outward = np.linspace(0.02, 0.0, len(loop.press))[:, None] * np.array([0.0, 1.0, 0.0])
    rounds = np.repeat(start[None], len(loop.round), axis=0)
    beside = replace(loop, depth=0.01, press=start + outward, round=rounds)
    follow = led(native_body(block), Settings(YOUNG_MODULUS), (beside,), POINTS[:1])
    forces, _ = follow(beside.path[:, None])
    assert 0.0 < np.linalg.norm(forces, axis=2).max() < 1e-9
    assert books((beside,), follow) is None


TOOL_LOOPS = 4
RADIUS = 0.004
# Deeper than half a radius pushes are held near a direction that changes with them.
DEEP = Span(RADIUS, (0.5, 2.0), (0.2, 1.0))


@pytest.mark.parametrize(
    "tool",
    [
        pytest.param(sphere(RADIUS), id="tip"),
        pytest.param(plate(3 * RADIUS, 2 * RADIUS), id="plate", marks=pytest.mark.at_length),
    ],
)
@pytest.mark.parametrize(
    "max_force",
    [pytest.param(None, marks=pytest.mark.at_length), 0.05],
    ids=["whole", "cut off"],
)
def test_no_tool_gives_energy_down_to_two_radii(body, tool, max_force):
    surface = native_body(body, whole=True)
    alone = [(loop,) for loop in loops_of(body, TOOL_LOOPS, DEEP)]
    tips = (tip_of(body, surface, tool),)
    gives_nothing(books_of(surface, alone, Settings(YOUNG_MODULUS), max_force, tips), TOOL_LOOPS)


@pytest.mark.at_length
def test_a_tool_and_a_point_beside_it_get_no_energy(body):
    surface = native_body(body, whole=True)
    pairs = list(random_pairs(loops_of(body, 4 * TOOL_LOOPS, DEEP), seed=14))[:TOOL_LOOPS]
    tips = (tip_of(body, surface, sphere(RADIUS)), Tip())
    gives_nothing(books_of(surface, pairs, Settings(YOUNG_MODULUS), tips=tips), TOOL_LOOPS)


def test_two_that_are_led_together_get_no_energy(body):
    pairs = list(random_pairs(loops_of(body, 10 * LOOPS), seed=14))[:LOOPS]
    gives_nothing(books_of(native_body(body, whole=True), pairs, Settings(YOUNG_MODULUS)))


def test_who_is_drawn_along_by_a_deep_finger_pays_too(cube_body, whole):
    """One is 46 mm deep in the cube; the other, on a surface that bulges towards it, pressed less
    than that, so that its share of the energy was below nothing, and was asked for nothing.
    """
    pair = list(random_pairs(loops_of(cube_body, 150, seed=3), seed=3))[18]
    assert max(loop.depth for loop in pair) > 0.046
    coupled = Settings(YOUNG_MODULUS, coupling=Coupling(800.0, 4.0, passivity_control=True))
    gives_nothing(books_of(whole, [pair], coupled, motors=3.0), 1)


def test_two_who_pinch_a_thin_plate_get_no_more_than_they_put_in():
    """By its edge, beside each other: what they hold grows from next to nothing, and much of it at
    once, so that a brake which grows with their ways came too late (5 % of F d / 2).
    """
    plate_body = soft_block((0.02, 0.004, 0.06), (4, 1, 12), poisson_ratio=0.3)
    loops = loops_of(plate_body, 200, Span(None, (0.5, 2.0), (0.5, 3.0)), seed=1)
    pair = list(random_pairs(loops, seed=1))[130]
    surface = native_body(plate_body, whole=True)
    follow = led(surface, Settings(100_000.0), pair, POINTS)
    found = books(pair, follow)
    assert found is not None
    assert found.path <= 0.0


def test_the_papers_law_as_published_does(body):
    """What the test above would say of a force without a toll."""
    alone = [(loop,) for loop in loops_of(body, LOOPS)]
    found = books_of(native_body(body), alone, Settings(YOUNG_MODULUS, mode="paper"))
    rounds = np.array([gain for one in found for gain in one.rounds])
    assert (rounds > 10 * MOST).mean() > 0.1


def slid(surface, **feel):
    """A finger drawn from a soft place of the cube's top to a stiffer one, and the forces there."""
    start = np.array([0.025, 0.025, 0.05 - 0.004])
    fingers = SteppedFingers(surface, start[None] + [0, 0, 0.005], Settings(YOUNG_MODULUS, **feel))
    down = start + np.linspace(0.005, 0.0, 100)[:, None] * [0, 0, 1]
    along = start + np.linspace(0.0, 0.005, 300)[1:, None] * [0.8, 0.6, 0]
    fingers.follow(down[:, None])
    forces = fingers.follow(along[:, None])[0][:, 0]
    still = fingers.follow(np.repeat(along[-1:, None], 30, axis=0))[0][:, 0]
    return fingers, forces, still


def test_the_brake_is_against_the_way_and_gone_at_rest(whole):
    fingers, forces, still = slid(whole)
    shot = fingers.snapshot().fingers[0]
    plain = whole.contact(
        shot.triangle_index, shot.alpha, shot.probe - shot.proxy, YOUNG_MODULUS, "consistent"
    )[1]
    assert np.array_equal(still[-1], plain)
    brake = forces[-1] - plain
    assert brake @ [0.8, 0.6, 0] < -0.05 * np.linalg.norm(plain)
    assert np.linalg.norm(brake - (brake @ [0.8, 0.6, 0]) * np.array([0.8, 0.6, 0])) < 1e-3
    assert (np.linalg.norm(np.diff(still, axis=0), axis=1) < 0.1 * np.linalg.norm(plain)).all()


def test_who_makes_the_body_stiffer_meanwhile_owes_nothing(whole):
    start = np.array([0.021, 0.028, 0.05 - 0.004])
    lift = np.linspace(0.0, 0.005, 100)[:, None, None] * [0, 0, 1]
    fingers = SteppedFingers(whole, start + lift[-1], Settings(YOUNG_MODULUS))
    fingers.follow(start + lift[::-1])
    fingers.set(Settings(2 * YOUNG_MODULUS))
    force = fingers.follow(start + lift[:40])[0][-1, 0]
    shot = fingers.snapshot().fingers[0]
    u = shot.probe - shot.proxy
    plain = whole.contact(shot.triangle_index, shot.alpha, u, 2 * YOUNG_MODULUS, "consistent")[1]
    assert np.array_equal(force, plain)
