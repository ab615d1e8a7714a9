"""What bears a body carries its weight, no more and no less."""

import numpy as np
import pytest
from bodies.free_shapes import free_block
from bodies.soft_block import soft_block

from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import plate, sphere
from palpate.core.errors import PalpateError
from palpate.core.rest.rest_settings import EARTH, RestSettings
from palpate.core.rest.resting import Resting
from palpate.core.rest.support import Floor, Support

TURNED = np.array([[0.8, 0.0, 0.6], [0.0, 1.0, 0.0], [-0.6, 0.0, 0.8]])


def weight_of(body):
    return body.mass * np.array(EARTH)


def all_forces(rest):
    """On the body, N."""
    return -np.sum([touch.force for touch in (*rest.tools, *rest.supports)], axis=0)


@pytest.mark.parametrize("friction", [0.0, 0.6])
@pytest.mark.parametrize("rotation", [np.eye(3), TURNED])
def test_floor_carries_the_weight(cube, friction, rotation):
    placement = Pose.at([0.1, 0.0, 0.05], rotation)
    rest = Resting(cube, [Floor(friction=friction)], placement=placement).settle()
    weight = weight_of(cube)
    np.testing.assert_allclose(all_forces(rest), -weight, atol=1e-6 * np.linalg.norm(weight))
    (floor,) = rest.supports
    assert floor.pushes.sum() == pytest.approx(-weight[2], rel=1e-6)
    lowest = rest.surface()[:, 2].min()
    assert -2e-4 < lowest < 2e-4
    assert rest.elastic > 0.0


def test_a_higher_floor_bears_it_higher(cube):
    low, high = (
        Resting(cube, [Floor(height, friction=0.0)]).settle().centre[2] for height in (0.0, -0.03)
    )
    assert low - high == pytest.approx(0.03, abs=1e-8)


@pytest.mark.parametrize("cells", [(3, 3, 9), (5, 5, 15)])
def test_a_column_is_pressed_together_by_its_own_weight_as_linear_theory_has_it(cells):
    width, height, modulus = 0.03, 0.09, 300_000.0
    column = free_block((width, width, height), cells, young_modulus=modulus)
    rest = Resting(column, [Floor(friction=0.0)]).settle()
    at_rest = column.mesh.nodes[column.mesh.surface_nodes][:, 2]
    lower = at_rest - rest.surface()[:, 2]
    top, foot = at_rest > at_rest.max() - 1e-9, at_rest < at_rest.min() + 1e-9
    load = column.mass * EARTH[2] / width**2
    assert lower[foot].mean() - lower[top].mean() == pytest.approx(
        0.5 * load * height / modulus, rel=0.02
    )


def test_finger_and_floor_carry_the_weight_together(cube):
    finger = sphere(0.01)
    resting = Resting(cube, [Floor()], [(finger, Pose.at([0.026, 0.024, 0.0605]))])
    before = resting.settle()
    assert not before.tools[0].force.any()
    resting.lead([Pose.at([0.026, 0.024, 0.057])])
    rest = resting.settle()
    weight = weight_of(cube)
    np.testing.assert_allclose(all_forces(rest), -weight, atol=1e-6 * np.linalg.norm(weight))
    assert rest.tools[0].force[2] > 0.5
    assert rest.elastic > before.elastic


def test_beams_bear_it_as_a_floor_does(cube):
    table = Support(plate(0.2, 0.2), Pose.at([0.0, 0.0, -1e-4], np.diag([1.0, -1.0, -1.0])))
    on_table = Resting(cube, [table]).settle()
    weight = weight_of(cube)
    np.testing.assert_allclose(all_forces(on_table), -weight, atol=1e-6 * np.linalg.norm(weight))
    beams = [
        Support(plate(0.2, 0.01), Pose.at([0.0, y, -1e-4], np.diag([1.0, -1.0, -1.0])))
        for y in (0.005, 0.045)
    ]
    on_beams = Resting(cube, beams).settle()
    np.testing.assert_allclose(all_forces(on_beams), -weight, atol=1e-6 * np.linalg.norm(weight))
    shares = [touch.force[2] / weight[2] for touch in on_beams.supports]
    np.testing.assert_allclose(shares, 0.5, atol=0.05)
    # Softer, for less of it is borne.
    assert on_beams.centre[2] < on_table.centre[2]


def test_where_it_rests_does_not_depend_on_the_drag(cube):
    heights = [
        Resting(cube, [Floor(friction=0.0)], settings=RestSettings(drag_time=time))
        .settle()
        .centre[2]
        for time in (0.02, 0.1)
    ]
    assert heights[0] == pytest.approx(heights[1], abs=1e-9)


def test_what_nothing_bears_does_not_rest(cube):
    with pytest.raises(PalpateError, match="nothing may bear it"):
        Resting(cube, [Floor(friction=0.0, up=(0.3, 0.0, 1.0))]).settle()


def test_what_cannot_rest_is_refused(cube):
    with pytest.raises(PalpateError, match="pinned"):
        Resting(soft_block((0.05, 0.05, 0.05), (2, 2, 2)), [Floor()])
    with pytest.raises(PalpateError, match="20 supports bear the body; at most"):
        Resting(cube, [Floor()] * 20)
    with pytest.raises(PalpateError, match="coefficient of friction"):
        Floor(friction=-0.1)
    inside = Resting(cube, [Floor()], [(sphere(0.005), Pose.at([0.025, 0.025, 0.025]))])
    with pytest.raises(PalpateError, match="tool 0 is within the body"):
        inside.settle()
    with pytest.raises(PalpateError, match="2 goals for 1 tools"):
        inside.lead([Pose.at([0.0, 0.0, 0.1])] * 2)
