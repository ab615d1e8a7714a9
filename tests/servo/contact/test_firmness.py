"""Forces that are other than a linear body's by its firmness: what is felt, held and given back."""

import numpy as np
import pytest
from palpate_servo.harness import SteppedFingers
from referees.energy_loops import books, random_loops
from referees.led_tips import Tip, led, tip_of
from ways.told_firmness import LINEAR, told

from palpate.core.contact.tool.tools import sphere
from palpate.core.servo.session import drawn_loads, native_body, servo_on
from palpate.core.servo.settings import Coupling, Settings

MODULUS = 10_000.0
# Of a point in the middle of the cube's top: 1 + s/4 + s^2/4 and 1 - s/3, s its depth over 4 mm;
# and as of a thin part that is bent, 1 + 2 s + 4 s^2, up to 21.
FIRMER, SOFTER, THIN = (0.25, 0.25), (-1 / 3, 0.0), (2.0, 4.0)
DEEP = 2.0
COUPLED = Coupling(800.0, 4.0, passivity_control=True)
# Ticks until another firmness is there, and how nearly.
FADED, NEARLY = 1000, 1e-6


def down(depth):
    return np.array([[0.025, 0.025, 0.05 - depth]])


def held_by(whole, depth):
    """Elastic energy, J/Pa, of the linear press so deep."""
    return 0.5 * depth * linear_force(whole, depth) / MODULUS


def fingers_on(whole, start, firmness=None, settings=None):
    fingers = SteppedFingers(whole, start, settings or Settings(MODULUS))
    if firmness is not None:
        unit = held_by(whole, 0.004)
        fingers.set_firmness(*told(firmness, unit, DEEP))
    return fingers


def linear_force(whole, depth):
    fingers = fingers_on(whole, down(-0.001))
    return fingers.follow(np.stack([down(depth)] * 3))[0][-1][0][2]


@pytest.mark.parametrize("firmness", [FIRMER, SOFTER, THIN])
def test_the_force_is_that_much_firmer(whole, firmness):
    fingers = fingers_on(whole, down(-0.001), firmness)
    for depth in (0.0005, 0.002, 0.004, 0.012):
        force = fingers.follow(np.stack([down(depth)] * FADED))[0][-1][0][2]
        s = min(depth / 0.004, DEEP)
        share = max(1.0 + firmness[0] * s + firmness[1] * s * s, 0.1)
        assert force / linear_force(whole, depth) == pytest.approx(share, rel=NEARLY)
        assert fingers.snapshot().firmness == pytest.approx(share, rel=NEARLY)


def test_what_is_drawn_is_what_a_linear_body_shows(whole):
    linear, firm = fingers_on(whole, down(-0.001)), fingers_on(whole, down(-0.001), FIRMER)
    for fingers in (linear, firm):
        fingers.follow(np.stack([down(0.004)] * FADED))
    (nodes, forces), (firm_nodes, firm_forces) = (
        drawn_loads(fingers.snapshot())[0] for fingers in (linear, firm)
    )
    np.testing.assert_array_equal(nodes, firm_nodes)
    np.testing.assert_allclose(firm_forces, forces, rtol=1e-9)


def test_it_comes_and_goes_without_a_jump(whole):
    fingers = fingers_on(whole, down(-0.001))
    before = fingers.follow(np.stack([down(0.004)] * 100))[0][-1][0][2]
    unit = held_by(whole, 0.004)
    fingers.set_firmness(*told(FIRMER, unit, DEEP))
    forces = np.append(before, fingers.follow(np.stack([down(0.004)] * 500))[0][:, 0, 2])
    assert forces[-1] / before == pytest.approx(1.5, rel=1e-3)
    assert np.abs(np.diff(forces)).max() < 0.02 * before
    fingers.set_firmness(*LINEAR)
    back = fingers.follow(np.stack([down(0.004)] * 1000))[0][:, 0, 2]
    assert np.abs(np.diff(back)).max() < 0.02 * before
    assert back[-1] == pytest.approx(before, rel=1e-6)


def test_it_begins_anew_with_every_touch(whole):
    fingers = fingers_on(whole, down(-0.001), FIRMER)
    fingers.follow(np.stack([down(0.004)] * FADED))
    fingers.follow(np.stack([down(-0.001)] * 2))
    assert fingers.snapshot().firmness == 1.0
    first = fingers.follow(np.stack([down(0.004)] * 2))[0][:, 0, 2]
    np.testing.assert_allclose(first, linear_force(whole, 0.004), rtol=0.05)


@pytest.mark.parametrize("firmness", [FIRMER, SOFTER, THIN])
@pytest.mark.parametrize("ticks", [40, 400])
def test_in_and_out_gives_nothing(whole, firmness, ticks):
    """As fast as 0.2 m/s: forces of a tick are those of the last one's depth."""
    fingers = fingers_on(whole, down(-0.001), firmness)
    fingers.follow(np.stack([down(0.001)] * FADED))
    depths = 0.001 + 0.006 * np.sin(np.linspace(0.0, np.pi, ticks)) ** 2
    depths = np.append(depths, np.linspace(0.001, -0.001, ticks))
    into = np.append(np.linspace(-0.001, 0.001, ticks), depths)
    path = np.stack([down(depth) for depth in into])
    forces = fingers.follow(path)[0][:, 0, 2]
    work = -np.sum(0.5 * (forces[1:] + forces[:-1]) * np.diff(path[:, 0, 2]))
    assert work >= -1e-3 * np.abs(forces).max() * 0.007


def books_on(body, tool, coupling, firmnesses, seed):
    """Of random loops on a body that is as firm as told, one after the other."""
    mesh, settings = body.mesh, Settings(MODULUS, coupling=coupling)
    free = ~np.isin(mesh.surface_nodes, body.fixed)
    nodes = mesh.nodes[mesh.surface_nodes]
    surface = native_body(body, whole=True)
    tip = Tip() if tool is None else tip_of(body, surface, tool)
    found = []
    for loop in random_loops(nodes, mesh.surface_local_triangles, free, 8, seed):
        unit = 0.01 * loop.depth**2
        known = [told(firmness, unit, DEEP) for firmness in firmnesses]
        follow = led(surface, settings, (loop,), (tip,), 3.0 if coupling else None, known)
        found.append(books((loop,), follow))
    return [one for one in found if one is not None]


@pytest.mark.parametrize(
    ("firmness", "tool", "coupling"),
    [
        pytest.param(FIRMER, None, None, id="point"),
        pytest.param(SOFTER, None, COUPLED, id="softer, point, motors"),
        pytest.param(THIN, None, COUPLED, id="as of a thin part, point, motors"),
        *(
            pytest.param(*one, marks=pytest.mark.at_length)
            for one in (
                (SOFTER, None, None),
                (FIRMER, None, COUPLED),
                (FIRMER, sphere(0.006), COUPLED),
                (SOFTER, sphere(0.006), COUPLED),
                (FIRMER, sphere(0.006), None),
                (SOFTER, sphere(0.006), None),
                (THIN, None, None),
                (THIN, sphere(0.006), COUPLED),
                (THIN, sphere(0.006), None),
            )
        ),
    ],
)
def test_no_closed_path_gives_energy(body, firmness, tool, coupling):
    found = books_on(body, tool, coupling, (firmness,), 18)
    assert len(found) > 3
    assert max((gain for one in found for gain in one.rounds), default=0.0) <= 1e-3
    assert max(one.path for one in found) <= 1e-3


@pytest.mark.parametrize("coupling", [None, COUPLED], ids=["bare", "motors"])
@pytest.mark.parametrize("tool", [None, sphere(0.006)], ids=["point", "sphere"])
def test_a_firmness_that_comes_and_goes_gives_no_energy(body, tool, coupling):
    found = books_on(body, tool, coupling, ((0.0, 0.0), FIRMER, SOFTER, THIN), 29)
    assert len(found) > 3
    assert max((gain for one in found for gain in one.rounds), default=0.0) <= 1e-3
    assert max(one.path for one in found) <= 1e-3


@pytest.mark.parametrize("ticks", [100, 1000])
@pytest.mark.parametrize("firmness", [FIRMER, THIN])
@pytest.mark.parametrize("slide", [0.0, 0.001])
def test_one_that_comes_late_is_felt_on_the_way_in_and_kept_back_on_the_way_out(
    whole, firmness, ticks, slide
):
    """Found where a finger is deep: then no force is above that of one who knew of it from the
    beginning, and none falls and rises again.
    """
    fingers = fingers_on(whole, down(-0.001))
    unit = held_by(whole, 0.004)

    def way(begin, end):
        depths = np.linspace(begin, end, ticks)
        places = np.concatenate([down(depth) for depth in depths])
        places[:, 0] += slide * depths / 0.004
        return places[:, None]

    parts = [way(-0.001, 0.004)]
    forces = [fingers.follow(parts[0])[0][:, 0]]
    fingers.set_firmness(*told(firmness, unit, DEEP))
    for begin, end in ((0.004, 0.0041), (0.0041, 0.006), (0.006, -0.001)):
        parts.append(way(begin, end))
        forces.append(fingers.follow(parts[-1])[0][:, 0])
    last = np.linalg.norm(forces[2], axis=1)
    early = fingers_on(whole, down(-0.001), firmness)
    early.follow(np.tile(way(0.0005, 0.0005)[0], (FADED, 1, 1)))
    law = np.linalg.norm(early.follow(way(0.0005, 0.006))[0][:, 0], axis=1).max()
    assert last.max() <= 1.02 * law
    out = np.linalg.norm(forces[3], axis=1)
    assert np.diff(out).max() <= 0.005 * law
    path, force = np.concatenate(parts)[:, 0], np.concatenate(forces)
    work = np.einsum("tx,tx->", 0.5 * (force[1:] + force[:-1]), np.diff(path, axis=0))
    assert work <= 1e-3 * law * 0.003


def test_a_firmness_that_is_no_number_is_refused(whole):
    servo = servo_on(whole, Settings(MODULUS))
    for energies, shares in (
        ([1.0], [float("nan")]),
        ([-1.0], [1.0]),
        ([2.0, 1.0], [1.0, 1.0]),
        ([1.0, 2.0], [1.0]),
        (np.arange(1.0, 34.0), np.ones(33)),
    ):
        with pytest.raises(ValueError, match=r"finite numbers .* ascend, 32 at most"):
            servo.set_firmness(energies, shares)
