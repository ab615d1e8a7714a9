"""Fingertips at the border of a bone in flesh, where a body is a half-space of neither."""

import numpy as np
import pytest
from bodies.baked_body import baked_body

from palpate.core.contact.press import ContactSettings, Press
from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tools import sphere
from palpate.core.mesh.paper_cube import paper_cube

EDGE, RADIUS = 0.05, 0.006
UP = np.array([0.0, 0.0, 1.0])


def half_of_bone(contrast, formulation="smoothed"):
    """A cube whose one half, along the first axis, is stiffer."""
    mesh, fixed = paper_cube(EDGE, cells=5)
    middles = mesh.nodes[mesh.tets].mean(axis=1)
    scale = np.where(middles[:, 0] < 0.4 * EDGE, contrast, 1.0)
    return baked_body(mesh, fixed, 0.3, 1e4, formulation, young_scale=scale)


@pytest.mark.parametrize("formulation", ["linear", "smoothed"])
@pytest.mark.parametrize("friction", [0.0, 0.3])
def test_presses_at_a_bone_s_border_come_to_rest(formulation, friction):
    body = half_of_bone(1000.0, formulation)
    for x in np.linspace(0.012, 0.034, 12):
        press = Press(body, [sphere(RADIUS)], ContactSettings(1e4, friction))
        forces = [0.0]
        for depth in (0.0, 0.1, 0.3, 0.6, 1.0, 1.4):
            pose = Pose.at(np.array([x, 0.023, EDGE + (1.0 - depth) * RADIUS]))
            (touch,) = press.to([pose])
            forces.append(float(touch.force @ UP))
        assert np.isfinite(forces).all()
        # As deep as its radius it is pushed aside by the bone.
        assert (np.diff(forces[2:-2]) > 0.0).all()


def test_from_flesh_to_bone_a_press_grows_firmer():
    body = half_of_bone(1000.0)
    at = [np.array([x, 0.023, EDGE + 0.7 * RADIUS]) for x in (0.04, 0.03, 0.02, 0.01)]
    forces = [float(press_tool(body, sphere(RADIUS), Pose.at(place)).force @ UP) for place in at]
    assert (np.diff(forces) > 0.0).all()
    assert 100.0 < forces[-1] / forces[0] < 1000.0


def test_what_is_all_bone_is_as_flesh_but_for_its_modulus():
    """Nothing but ratios of moduli counts."""
    place = Pose.at(np.array([0.023, 0.027, EDGE + 0.7 * RADIUS]))
    mesh, fixed = paper_cube(EDGE, cells=5)
    forces = [
        press_tool(
            baked_body(mesh, fixed, 0.3, 1e4, "smoothed", young_scale=np.full(len(mesh.tets), of)),
            sphere(RADIUS),
            place,
        ).force
        for of in (1.0, 1000.0)
    ]
    assert forces[1] == pytest.approx(1000.0 * forces[0], rel=1e-4)
