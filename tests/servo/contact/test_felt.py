"""The corrected felt force in the servo: the reference's numbers, energies, and how it comes in."""

import numpy as np
import pytest
from palpate_servo import Pointer
from palpate_servo.harness import SteppedFingers
from referees.softened_points import (
    STRONG,
    corrected_forces,
    coupled,
    couplings,
    relation_at,
    share_of,
)

from palpate.core.bake.steps import BakeSettings, bake
from palpate.core.contact.place import compliance_between
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.mesh.tet_mesh import TetMesh
from palpate.core.servo.session import native_body, servo_on
from palpate.core.servo.settings import Settings
from palpate.core.shape.force_at_depth.softening_table import SofteningTable
from palpate.core.stiffness.pins import PinNodes

EDGE = 0.05
TOP = np.array([0.021, 0.027, EDGE])
UP = np.array([0.0, 0.0, 1.0])
BLEND_TICKS = 50


@pytest.fixture(scope="module")
def baked():
    mesh, fixed = paper_cube(EDGE)
    return bake(mesh, BakeSettings(0.3, 10_000.0, PinNodes(fixed)))[0]


@pytest.fixture(scope="module")
def table(baked):
    table = SofteningTable(baked)
    table.fill()
    return table


@pytest.fixture
def surface(baked, table):
    """With softenings of its own: they are told once."""
    surface = native_body(baked, whole=True)
    table.listen(surface.set_softenings)
    return surface


def random_alpha(rng):
    alpha = rng.dirichlet([1, 1, 1])
    alpha[rng.permutation(3)[: rng.integers(0, 3)]] = 0
    return alpha / alpha.sum()


@pytest.mark.parametrize("mode", ["paper", "consistent"])
def test_native_forces_are_those_of_the_reference(baked, table, surface, mode):
    rng = np.random.default_rng(6)
    for _ in range(1000):
        triangle = int(rng.integers(len(baked.mesh.surface_triangles)))
        alpha, u = random_alpha(rng), rng.normal(size=3) * 10 ** rng.uniform(-5, -1)
        expected = corrected_forces(baked, table.values, triangle, alpha, u, mode)
        nodal, force = surface.contact(triangle, alpha, u, baked.young_modulus, mode, "corrected")
        scale = np.abs(expected).max()
        assert np.abs(nodal - expected).max() <= 1e-9 * scale
        assert np.abs(force + expected.sum(axis=0)).max() <= 1e-9 * scale


def pressed(surface, depths, **keywords):
    """Forces of a finger led down above TOP to depths (k,), and the fingers themselves."""
    fingers = SteppedFingers(surface, [TOP + 0.01 * UP], Settings(1e4, **keywords))
    down = np.linspace(0.001, -depths[0], 200)
    path = np.concatenate([down, -np.asarray(depths)])
    paths = TOP + path[:, None, None] * UP
    return fingers.follow(paths)[0][len(down) :, 0], fingers


def test_a_led_finger_feels_the_reference_and_the_snapshot_says_so(baked, table, surface):
    depths = np.linspace(0.001, 0.012, 30)
    forces, fingers = pressed(surface, depths, felt="corrected")
    shot = fingers.snapshot()
    assert (shot.felt, shot.felt_share) == ("corrected", pytest.approx(1.0))
    for depth, force in zip(depths, forces, strict=True):
        u = shot.probe - shot.proxy
        u *= depth / depths[-1]
        expected = corrected_forces(baked, table.values, shot.triangle_index, shot.alpha, u)
        np.testing.assert_allclose(force, -expected.sum(axis=0), rtol=1e-9, atol=1e-12)
    assert (np.diff(forces[:, 2]) > 0).all()
    linear, plain = pressed(surface, depths)
    assert forces[-1, 2] > 1.02 * linear[-1, 2]
    assert (plain.snapshot().felt, plain.snapshot().felt_share) == ("linear", 0.0)
    # With these the linear body is drawn as far down as the finger is.
    assert np.array_equal(shot.nodal_forces, plain.snapshot().nodal_forces)
    np.testing.assert_allclose(shot.surface_point, shot.probe, atol=1e-9)


def test_what_becomes_known_under_the_finger_comes_in_without_a_jump(baked, table):
    surface = native_body(baked)
    depth = 0.008
    _, fingers = pressed(surface, [depth], felt="corrected")
    still = np.tile(TOP - depth * UP, (2 * BLEND_TICKS, 1, 1))
    linear = fingers.follow(still[:5])[0][-1, 0, 2]
    assert fingers.snapshot().felt_share == 0.0
    table.listen(surface.set_softenings)
    forces = fingers.follow(still)[0][:, 0, 2]
    again = pressed(surface, [depth], felt="corrected")[1]
    corrected = again.follow(still)[0][-1, 0, 2]
    steps = np.diff(np.concatenate([[linear], forces]))
    assert (steps >= 0).all()
    assert np.abs(steps).max() < 2 / BLEND_TICKS * (corrected - linear)
    assert forces[-1] == pytest.approx(corrected, rel=1e-12)


def test_the_choice_changes_live_without_a_jump(surface):
    depth = 0.008
    _, fingers = pressed(surface, [depth])
    still = np.tile(TOP - depth * UP, (2 * BLEND_TICKS, 1, 1))
    before = fingers.follow(still[:2])[0][-1, 0, 2]
    fingers.set(Settings(1e4, felt="corrected"))
    forces = fingers.follow(still)[0][:, 0, 2]
    fingers.set(Settings(1e4))
    back = fingers.follow(still)[0][:, 0, 2]
    change = forces[-1] - before
    assert change > 0.01 * before
    everything = np.concatenate([[before], forces, back])
    assert np.abs(np.diff(everything)).max() < 2 / BLEND_TICKS * change
    assert back[-1] == before


def led_to(surface, places, **keywords):
    fingers = SteppedFingers(surface, np.asarray(places) + 0.01 * UP, Settings(1e4, **keywords))
    down = np.linspace(0.01, 0.0005, 50)[:, None, None] * UP
    fingers.follow(np.asarray(places) + down)
    return fingers


def coupled_relations(baked, table, shots):
    """The reference's compliance of the fingers, their relations and couplings."""
    places = [shot.triangle_index for shot in shots], [shot.alpha for shot in shots]
    compliance = compliance_between(baked, *places)
    alone = [relation_at(baked, table.values, shot.triangle_index, shot.alpha) for shot in shots]
    strengths = couplings(compliance, alone)
    held = [coupled(one, strength) for one, strength in zip(alone, strengths, strict=True)]
    return compliance / baked.young_modulus, held, strengths


def test_several_fingers_each_soften_their_own_place(baked, table, surface):
    places = np.array([[0.01, 0.02, EDGE], [0.036, 0.027, EDGE]])
    depths = np.array([0.008, 0.005])
    fingers = led_to(surface, places, felt="corrected")
    way = np.linspace(-0.0005, 1, 400)[:, None, None] * depths[:, None] * -UP
    forces = fingers.follow(np.concatenate([places + way, np.tile(places + way[-1], (20, 1, 1))]))[
        0
    ][-1]
    shots = fingers.snapshot().fingers
    compliance, own, strengths = coupled_relations(baked, table, shots)
    shares = [share_of(strength) for strength in strengths]
    assert min(shares) > 0.3
    assert [shot.felt_share for shot in shots] == pytest.approx(shares, abs=1e-6)
    asked = np.array([shot.probe - shot.proxy for shot in shots])
    # What a finger's place is moved by itself, and by the other one.
    for p, (shot, relation) in enumerate(zip(shots, own, strict=True)):
        by_other = compliance[p, 1 - p] @ -forces[1 - p]
        felt = 1e4 * relation.force(asked[p] - by_other)
        np.testing.assert_allclose(forces[p], -felt, rtol=1e-6)
        linear = 1e4 * relation.stiffness @ (asked[p] - by_other)
        assert np.linalg.norm(felt - linear) > 0.002 * np.linalg.norm(linear)
        # The linear body is drawn where the fingers are.
        np.testing.assert_allclose(shot.surface_point, shot.probe, atol=1e-6)


@pytest.mark.parametrize(("count", "wide"), [(1, 0.004), (2, 0.0015)])
def test_held_fingers_do_no_work_round_a_closed_path(surface, count, wide):
    # Friction holds the contact points, so that fingers may go anywhere.
    places = np.array([[0.015, 0.02, EDGE], [0.032, 0.027, EDGE]])[:count]
    fingers = led_to(surface, places, felt="corrected", static_friction=1e6, dynamic_friction=1e6)
    angle = np.linspace(0, 2 * np.pi, 8001)[:, None, None]
    # All press, deeper than what the others do to them, at other phases.
    phases = np.array([[0.0, 1.0, 2.0], [0.7, 0.2, 1.5]])[:count]
    path = places - 0.006 * UP + wide * np.sin(angle + phases)
    fingers.follow(np.linspace(places + 0.0005 * UP, places - 0.0001 * UP, 20))
    fingers.follow(np.linspace(places - 0.0001 * UP, path[0], 300))
    forces = fingers.follow(path)[0]
    assert all(shot.sticking for shot in fingers.snapshot().fingers)
    parts = 0.5 * (forces[1:] + forces[:-1]) * np.diff(path, axis=0)
    assert abs(parts.sum()) < 1e-6 * np.abs(parts).sum()


@pytest.fixture(scope="module")
def arm():
    """A bar 80 mm long and 20 mm thick that is held at one end, and its softenings."""
    cube, _ = paper_cube(1.0)
    mesh = TetMesh.checked(cube.nodes * [0.08, 0.02, 0.02], cube.tets)
    fixed = np.flatnonzero(mesh.nodes[:, 0] == 0.0)
    body = bake(mesh, BakeSettings(0.3, 10_000.0, PinNodes(fixed)))[0]
    table = SofteningTable(body)
    table.fill()
    return body, table


def test_a_pinch_comes_and_goes_without_a_jump_and_is_the_references(arm):
    body, table = arm
    surface = native_body(body, whole=True)
    table.listen(surface.set_softenings)
    places = np.array([[0.0655, 0.0105, 0.02], [0.0655, 0.0105, 0.0]])
    outward = np.array([UP, -UP])
    fingers = SteppedFingers(surface, places + 0.01 * outward, Settings(1e4, felt="corrected"))
    first = np.concatenate([np.linspace(0.01, -0.003, 1300), np.full(3200, -0.003)])
    # 5 mm/s: as the other one comes to touch, the correction may change by far more in a tick than
    # the way does. It comes from where the first one has bent the bar to.
    second = np.concatenate([np.full(1300, 0.006), np.linspace(0.006, -0.002, 1600)])
    second = np.concatenate([second, np.linspace(-0.002, 0.006, 1600)])
    paths = places + np.stack([first, second], axis=1)[:, :, None] * outward
    before = fingers.follow(paths[:1300])[0]
    assert fingers.snapshot().fingers[0].felt_share == pytest.approx(1.0)
    alone = np.linalg.norm(before[-1, 0])
    pinched = fingers.follow(paths[1300:2900])[0]
    shots = fingers.snapshot().fingers
    compliance, held, strengths = coupled_relations(body, table, shots)
    assert (strengths > STRONG).all()
    assert [shot.felt_share for shot in shots] == [0.0, 0.0]
    asked = np.array([shot.probe - shot.proxy for shot in shots])
    for p, relation in enumerate(held):
        by_other = compliance[p, 1 - p] @ -pinched[-1, 1 - p]
        felt = 1e4 * relation.force(asked[p] - by_other)
        np.testing.assert_allclose(pinched[-1, p], -felt, rtol=1e-6)
    gone = fingers.follow(paths[2900:])[0]
    assert np.linalg.norm(gone[-1, 0]) == pytest.approx(alone, rel=1e-3)
    everything = np.concatenate([before[-1:], pinched, gone])
    steps = np.abs(np.diff(everything, axis=0)).max()
    assert steps < 0.02 * np.linalg.norm(pinched[-1, 0])


def test_the_running_servo_takes_the_choice_while_it_runs(baked, surface, eventually):
    with servo_on(surface, Settings(1e4, felt="corrected")) as servo:
        servo.start(Pointer(TOP + 0.002 * UP))
        servo.set_target(TOP - 0.006 * UP)
        eventually(lambda: servo.snapshot().felt_share == pytest.approx(1.0))
        eventually(lambda: servo.snapshot().probe[2] == pytest.approx(EDGE - 0.006))
        firm = servo.snapshot().contact_force[2]
        servo.set(Settings(1e4))
        eventually(lambda: servo.snapshot().felt_share == 0.0)
        assert servo.snapshot().felt == "linear"
        assert servo.snapshot().contact_force[2] < 0.995 * firm
        with pytest.raises(ValueError, match='felt is "real"'):
            servo.set(Settings(1e4, felt="real"))


def test_softenings_that_make_no_relation_are_refused(baked):
    surface = native_body(baked)
    for nodes, rows, reason in (
        ([0], [[0.0, 0.0, np.nan, 1.0]], "finite"),
        ([0], [[1.0, 0.0, 0.0, 0.0]], "positive"),
        ([0], [[0.0, 0.0, 0.0, -1.0]], "negative"),
        ([0], [[0.0, 0.0, 0.0]], "four numbers"),
        ([10_000], [[0.0, 0.0, 0.0, 0.0]], "beyond"),
    ):
        with pytest.raises(ValueError, match=reason):
            surface.set_softenings(nodes, rows)
