"""Bodies that nobody holds, pressed by their laws between floor and tools."""

from dataclasses import replace

import numpy as np
import pytest
from bodies.baked_body import baked_body
from scipy.optimize import brentq

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate, sphere
from palpate.core.mesh.paper_cube import paper_cube
from palpate.core.pile.pile import Pile
from palpate.core.rest.rest_settings import RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor
from palpate.core.shape.firm_rest import FirmRest, settle_firmly
from palpate.core.shape.shapes import LinearShape, shape

EDGE, RATIO, YOUNG = 0.05, 0.45, 1e4
MIDDLE = np.array([EDGE / 2, EDGE / 2, EDGE])


def free_cube(cells, density):
    mesh, _ = paper_cube(EDGE, cells=cells)
    made = baked_body(mesh, np.zeros(0, dtype=np.int64), RATIO, YOUNG, "smoothed")
    return replace(made, density=density)


@pytest.fixture(scope="module")
def cube():
    return free_cube(5, 20.0)


@pytest.fixture(scope="module")
def real(cube):
    made = shape(cube, "real")
    made.wait_for(cube.mesh.surface_nodes[:1])
    yield made
    made.close()


def pressed(body, tool, depth, friction):
    """The body on a floor, a tool led in from its top."""
    above = 1e-4 + (tool.radius if tool.name == "sphere" else 0.0)
    start = MIDDLE + np.array([0.0, 0.0, above])
    settings = RestSettings(friction=friction)
    resting = Resting(body, [Floor(friction=friction)], [(tool, Pose.at(start))], settings=settings)
    resting.settle()
    resting.lead([Pose.at(start - [0.0, 0.0, 1e-4 + depth])])
    return resting


def squeezed(stretch):
    """Pressure on a neo-Hookean block of 1 Pa, squeezed between smooth plates, and its width."""
    shear, first = 0.5 / (1 + RATIO), RATIO / (1 + RATIO) / (1 - 2 * RATIO)

    def stress(along, across):
        volume = stretch * across * across
        return shear * (along - 1 / along) + first * (volume - 1) * volume / along

    across = brentq(lambda width: stress(width, width), 1.0, 2.0)
    return -stress(stretch, across), across


@pytest.mark.parametrize("share", [0.1, 0.2])
def test_a_block_under_a_plate_is_that_of_closed_form(cube, real, share):
    resting = pressed(cube, plate(2 * EDGE, 2 * EDGE), share * EDGE, 0.0)
    linear = resting.settle()
    (rest,) = settle_firmly(resting, [real])
    pressure, width = squeezed(1.0 - share)
    force = rest.tools[0].force[2]
    assert force == pytest.approx(pressure * YOUNG * EDGE**2, rel=0.01)
    assert linear.tools[0].force[2] < 0.93 * force
    moved = cube.mesh.nodes[cube.compliance.free_surface] + rest.deformed
    top, foot = (
        moved[cube.mesh.nodes[cube.compliance.free_surface][:, 2] == height]
        for height in (cube.mesh.nodes[:, 2].max(), 0.0)
    )
    # Both faces are flat, as far apart as plate and floor, and as wide as the block is.
    assert np.ptp(top[:, 2]) < 0.01 * share * EDGE
    assert np.ptp(foot[:, 2]) < 0.01 * share * EDGE
    assert top[:, 2].mean() - foot[:, 2].mean() == pytest.approx((1 - share) * EDGE, rel=1e-3)
    assert np.ptp(top[:, 0]) == pytest.approx(width * EDGE, rel=5e-3)


def test_floor_and_finger_carry_the_weight_together(cube, real):
    (rest,) = settle_firmly(pressed(cube, sphere(0.012), 0.006, 0.5), [real])
    weight = cube.mass * 9.81
    assert rest.tools[0].force[2] > 10.0 * weight
    borne = rest.tools[0].force + rest.supports[0].force + [0.0, 0.0, weight]
    np.testing.assert_allclose(borne, 0.0, atol=1e-6 * rest.tools[0].force[2])


def test_a_ball_presses_a_block_on_a_floor_more_firmly_than_a_linear_one(cube, real):
    resting = pressed(cube, sphere(0.02), 0.01, 0.5)
    linear = resting.settle().tools[0].force[2]
    (rest,) = settle_firmly(resting, [real])
    # A block that is pinned beneath: 1.09 times.
    assert 1.03 < rest.tools[0].force[2] / linear < 1.3
    assert rest.elastic > 0.0


def test_small_presses_are_linear(cube, real):
    resting = pressed(cube, sphere(0.02), 1e-4, 0.5)
    linear = resting.settle()
    (rest,) = settle_firmly(resting, [real])
    force = linear.tools[0].force
    np.testing.assert_allclose(rest.tools[0].force, force, atol=0.02 * force[2])
    np.testing.assert_allclose(rest.displacements(), linear.displacements(), atol=5e-6)


def test_in_parts_it_comes_to_the_same_rest(cube, real):
    (whole,) = settle_firmly(pressed(cube, sphere(0.012), 0.006, 0.5), [real])
    firm = FirmRest(pressed(cube, sphere(0.012), 0.006, 0.5), [real])
    while not firm.settle_on(7):
        pass
    force = whole.tools[0].force
    np.testing.assert_allclose(firm.rests[0].tools[0].force, force, atol=5e-3 * force[2])
    np.testing.assert_allclose(firm.rests[0].deformed, whole.deformed, atol=2e-5)


def test_linear_bodies_stay_as_they_are(cube):
    resting = pressed(cube, sphere(0.012), 0.006, 0.5)
    linear = resting.settle()
    (rest,) = settle_firmly(resting, [LinearShape(cube)])
    force = linear.tools[0].force
    np.testing.assert_allclose(rest.tools[0].force, force, atol=1e-6 * force[2])
    assert rest.deformed is None
    assert resting.firmness == (1.0,)


def test_of_two_blocks_each_carries_what_lies_on_it():
    heavy = free_cube(3, 1000.0)
    real = shape(heavy, "real")
    pile = Pile(
        [(heavy, Pose.at([0.0, 0.0, 0.0])), (heavy, Pose.at([0.0, 0.0, 1.002 * EDGE]))], [Floor()]
    )
    lower, upper = settle_firmly(pile, [real, real])
    weight = heavy.mass * 9.81
    assert upper.others[0].force[2] == pytest.approx(-weight, rel=1e-6)
    assert lower.supports[0].force[2] == pytest.approx(-2 * weight, rel=1e-6)
    # What carries more is squeezed more, and firmer.
    assert pile.firmness[0] > pile.firmness[1] > 1.0
