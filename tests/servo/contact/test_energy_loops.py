"""A point gives no energy on closed paths without friction, and is as the law says at rest."""

import numpy as np
import pytest
from palpate_servo.harness import SteppedFingers
from referees.energy_loops import books, random_loops

from palpate.core.servo.session import native_body
from palpate.core.servo.settings import Settings

YOUNG_MODULUS = 10_000.0
# Shares of F d / 2.
MOST = 1e-3
LOOPS = 40


def by(surface, settings, start):
    fingers = SteppedFingers(surface, start[None], settings)

    def follow(path):
        forces = fingers.follow(path[:, None])[0][:, 0]
        return forces, fingers.snapshot().fingers[0].proxy

    return follow


def books_of(body, settings):
    mesh = body.mesh
    free = ~np.isin(mesh.surface_nodes, body.fixed)
    nodes, triangles = mesh.nodes[mesh.surface_nodes], mesh.surface_local_triangles
    surface = native_body(body)
    loops = random_loops(nodes, triangles, free, LOOPS, seed=14)
    found = [books(loop, by(surface, settings, loop.press[0])) for loop in loops]
    return [one for one in found if one is not None]


@pytest.mark.parametrize("shading", [False, True], ids=["facets", "shaded"])
def test_no_closed_path_gives_energy(body, shading):
    found = books_of(body, Settings(YOUNG_MODULUS, shading=shading))
    rounds = [gain for one in found for gain in one.rounds]
    assert len(rounds) > LOOPS
    assert max(rounds) <= MOST
    assert max(one.path for one in found) <= MOST


def test_the_papers_law_as_published_does(body):
    """What the test above would say of a force without a toll."""
    found = books_of(body, Settings(YOUNG_MODULUS, mode="paper"))
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
