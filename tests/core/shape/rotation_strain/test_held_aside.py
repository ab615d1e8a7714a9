"""Places that stick on what is rough, told by a solid with nodes held, and by Coulomb's bound."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.baked_body import baked_body
from scipy.optimize import minimize

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.core.shape.firm_rest import settle_firmly
from palpate.core.shape.rotation_strain.beside.beside_tools import between_tools
from palpate.core.shape.rotation_strain.beside.held_aside import between, sliding
from palpate.core.shape.rotation_strain.finger_load import FingerLoad, Footing, Setting
from palpate.core.shape.rotation_strain.relaxation import relaxation
from palpate.core.shape.shapes import shape
from palpate.core.shape.solid.free_solid import FreeSolid

EDGE = 0.05
TOP = np.array([EDGE / 2, EDGE / 2, EDGE])
UP = np.array([0.0, 0.0, 1.0])


@pytest.fixture(scope="module")
def cube():
    mesh, _ = paper_cube(EDGE, cells=5)
    made = baked_body(mesh, np.zeros(0, dtype=np.int64), 0.45, 1.0, "smoothed")
    return replace(made, density=1.0)


@pytest.fixture(scope="module")
def solid(cube):
    return FreeSolid.of(cube)


def set_down(body, tool, friction, floor):
    """Without weight on a floor, a tool close above it; it is led down by degrees, as hands do."""
    settings = RestSettings(friction=friction, gravity=(0.0, 0.0, 0.0))
    start = TOP + 1e-5 * UP
    resting = Resting(body, [Floor(friction=floor)], [(tool, Pose.at(start))], settings=settings)
    resting.step()
    return resting, start


def led(resting, start, depths):
    for depth in depths:
        resting.lead([Pose.at(start - depth * UP)])
        resting.settle()
        yield resting.rest


def loads_of(rest):
    loads = []
    for touch in rest.touches:
        moved = rest.placement.to_tool(touch.places) - touch.at_rest
        footing = Footing(touch.at_rest, moved, touch.pushes)
        by = Setting(*touch.by, rest.body, touch.friction, footing)
        loads.append(FingerLoad(touch.nodes, touch.nodal_forces, by=by))
    return loads


def held(solid, lower):
    """Displacements of least energy where all nodes of top and foot are held, and the force."""
    positions = solid.positions
    top, foot = positions[:, 2] > EDGE - 1e-9, positions[:, 2] < 1e-9
    moved, free = positions * [0.0, 0.0, -lower / EDGE], ~(top | foot)

    def energy(inner):
        moved[free] = inner.reshape(-1, 3)
        return 1e9 * solid.energy(moved), 1e9 * solid.forces(moved)[free].ravel()

    found = minimize(energy, moved[free].ravel(), jac=True, method="L-BFGS-B", tol=1e-15)
    moved[free] = found.x.reshape(-1, 3)
    return moved, -float(solid.forces(moved)[top][:, 2].sum())


@pytest.mark.parametrize("strides", [5, 40])
@pytest.mark.parametrize("share", [0.1, 0.2])
def test_a_block_between_rough_plates_is_one_whose_faces_are_held(cube, solid, share, strides):
    resting, start = set_down(cube, plate(2 * EDGE, 2 * EDGE), 2.0, 2.0)
    # A linear foot slides in each stride, by less the shorter that is.
    *_, linear = led(resting, start, share * EDGE * np.arange(1, strides + 1) / strides)
    real = shape(cube, "real")
    (rest,) = settle_firmly(resting, [real])
    real.close()
    true, force = held(solid, share * EDGE)
    at_rest = cube.mesh.nodes[cube.compliance.free_surface]

    def off(one):
        return np.linalg.norm(one.surface() - at_rest - true[solid.surface], axis=1).max()

    assert rest.tools[0].force[2] == pytest.approx(force, rel=0.02)
    assert off(rest) < 0.03 * share * EDGE < 0.2 * off(linear)


@pytest.mark.parametrize("friction", [0.05, 0.15, 0.5])
def test_no_place_is_held_by_more_than_its_friction(cube, solid, friction):
    resting, start = set_down(cube, plate(2 * EDGE, 2 * EDGE), 0.0, friction)
    *_, rest = led(resting, start, 0.15 * EDGE * np.geomspace(1e-2, 1.0, 5))
    found = between_tools(cube, solid, relaxation(solid), loads_of(rest))
    # Forces that hold the body there, by the law alone.
    foot = solid.positions[:, 2] < 1e-9
    forces = solid.forces(found.kept.displacements)
    aside, push = np.linalg.norm(forces[foot][:, :2], axis=1), forces[foot][:, 2]
    # The foot of a cube that sticks takes a quarter of what presses it.
    assert aside.sum() > min(0.8 * friction, 0.2) * push.sum()
    assert np.all(aside <= 1.05 * friction * np.maximum(push, 0.0) + 1e-3 * push.max())


@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_one_that_goes_on_from_where_it_was_comes_to_the_same_rest_in_fewer_steps(
    cube, solid, friction
):
    resting, start = set_down(cube, plate(2 * EDGE, 2 * EDGE), friction, friction)
    before, after = map(loads_of, led(resting, start, [0.1 * EDGE, 0.11 * EDGE]))
    first = between_tools(cube, solid, relaxation(solid), before)
    anew = between_tools(cube, solid, relaxation(solid), after)
    goes_on = between_tools(cube, solid, relaxation(solid), after, first.kept)
    off = np.abs(goes_on.kept.displacements - anew.kept.displacements).max()
    assert goes_on.share == pytest.approx(anew.share, rel=2e-3)
    assert off < 0.03 * np.abs(anew.kept.displacements).max()
    assert goes_on.kept.steps < 0.7 * anew.kept.steps


@pytest.mark.parametrize("friction", [0.1, 0.25])
def test_what_is_drawn_has_no_jump_where_places_begin_to_slide(cube, solid, friction):
    resting, start = set_down(cube, plate(2 * EDGE, 2 * EDGE), 0.0, friction)
    relaxing, shares, wide = relaxation(solid), [], []
    foot = solid.positions[:, 2] < 1e-9
    for rest in led(resting, start, np.linspace(0.02, 0.2, 19) * EDGE):
        found = between_tools(cube, solid, relaxing, loads_of(rest))
        shares.append(found.share)
        wide.append(np.ptp(found.kept.displacements[foot][:, 0]) / EDGE)
    assert np.abs(np.diff(shares, 2)).max() < 0.02
    assert np.abs(np.diff(wide, 2)).max() < 0.003


def test_places_go_as_those_that_are_pressed_around_them():
    at_rest = np.array([[x, y, 0.0] for x in range(4) for y in range(4)], dtype=float)
    moved = at_rest * [0.01, -0.02, 0.0] + [0.1, 0.0, 0.2]
    pushes = np.linspace(1.0, 2.0, 16)
    footing = Footing(at_rest, moved, pushes)
    np.testing.assert_allclose(between(footing, at_rest, 1.0), moved, atol=4e-3)
    # What no longer presses tells nothing any more.
    pushes[5] = 1e-9
    left = np.arange(16) != 5
    without = Footing(at_rest[left], moved[left], pushes[left])
    np.testing.assert_allclose(
        between(Footing(at_rest, moved, pushes), at_rest, 1.0),
        between(without, at_rest, 1.0),
        atol=1e-8,
    )


def test_places_slide_where_friction_gives_no_more():
    forces = np.array([[0.0, 0.0, 1.0], [0.25, 0.0, 1.0], [0.0, 0.5, 1.0], [0.0, 0.0, 0.0]])
    np.testing.assert_allclose(sliding(forces, np.tile(UP, (4, 1)), 0.5), [0.0, 0.0, 1.0, 1.0])
