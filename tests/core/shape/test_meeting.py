"""Loads under which a shape meets its fingers, for shapes whose answers are known."""

from dataclasses import dataclass, field

import numpy as np
import pytest

from palpate.core.body.soft_body import SoftBody
from palpate.core.contact.press import ContactSettings
from palpate.core.contact.single_press import touch_nearest
from palpate.core.contact.touches import contact_displacement
from palpate.core.shape.meeting import Meeting, settled
from palpate.core.shape.rotation_strain.finger_load import FingerLoad
from palpate.core.shape.shapes import LinearShape
from palpate.core.shape.solid.free_solid import FreeSolid
from palpate.core.shape.solid.newton import equilibrium

YOUNG = 10_000.0


@dataclass(eq=False)
class MadeUp:
    """A shape with all its needs met, of a function of nodal forces at unit modulus."""

    body: SoftBody
    law: object
    asked: list = field(default_factory=list)
    ready: float = 1.0

    def displacements(self, nodes, nodal_forces, young_modulus=None):
        return self.law(self.body, nodes, nodal_forces / (young_modulus or self.body.young_modulus))

    def wait_for(self, nodes):
        self.asked.append(nodes)

    def close(self):
        pass


def turning(body, nodes, forces):
    """Linear displacements, turned about z and shortened the more, the larger they are."""
    linear = body.deform(nodes, forces, 1.0)
    angle = 40.0 * np.linalg.norm(linear, axis=1)
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y, z = linear.T
    turned = np.column_stack([cosine * x - sine * y, sine * x + cosine * y, z])
    return turned / (1.0 + 30.0 * np.linalg.norm(linear, axis=1))[:, None]


def newton(body, nodes, forces):
    """The solid's own shape."""
    solid = FreeSolid.of(body)
    return equilibrium(solid, solid.on_free_nodes(nodes, forces)).displacements[solid.surface]


def touch(body, at, by):
    made = touch_nearest(body, at, by, ContactSettings(YOUNG))
    return made, FingerLoad(made.triangle, made.nodal_forces)


SIDE, TOP = ((0.002, 0.024, 0.04), (0.006, 0.001, 0.0)), ((0.03, 0.02, 0.05), (0.003, 0.0, 0.002))
DEEP = (TOP[0], (0.01, 0.0, 0.006))


@pytest.mark.parametrize(("law", "press"), [(turning, SIDE), (turning, TOP), (newton, DEEP)])
def test_the_touched_place_goes_where_the_finger_goes(cube, law, press):
    made, load = touch(cube, *press)
    shape = MadeUp(cube, law)
    alone = shape.displacements(load.nodes, load.forces, YOUNG)
    met = settled(cube, shape, [load], YOUNG)
    assert met.settled
    way = np.linalg.norm(press[1])

    def missed(displacements):
        return np.linalg.norm(contact_displacement(cube, made, displacements) - press[1]) / way

    # Under the same force the shape is elsewhere, so that there is something to do.
    assert missed(alone) > 0.05
    # The place that meets is the middle of the load, which is not quite the point that was touched.
    assert missed(met.displacements) < 0.03
    assert all(set(load.nodes) == set(nodes) for nodes in shape.asked)


def test_two_fingers_are_met_at_once(cube):
    loads = [touch(cube, *press)[1] for press in (SIDE, TOP)]
    met = settled(cube, MadeUp(cube, turning), loads, YOUNG)
    assert met.settled
    for load in loads:
        places = cube.free_index(load.nodes)
        np.testing.assert_allclose(
            load.weights @ met.displacements[places],
            load.weights @ met.linear[places],
            atol=0.01 * 0.008,
        )


def test_a_finger_that_moves_on_is_met_within_a_few_frames(cube):
    meeting = Meeting(cube, MadeUp(cube, turning))
    missed = []
    for share in np.linspace(0.05, 1.0, 40):
        met = meeting.step([touch(cube, SIDE[0], share * np.array(SIDE[1]))[1]], YOUNG)
        missed.append(met.missed)
    assert max(missed[5:]) < 0.06
    assert met.missed < 0.03


def test_youngs_modulus_can_be_changed_meanwhile(cube):
    meeting, (_, load) = Meeting(cube, MadeUp(cube, turning)), touch(cube, *SIDE)
    before = meeting.settle([load], YOUNG)
    firmer = FingerLoad(load.nodes, 7 * load.forces)
    after = meeting.step([firmer], 7 * YOUNG)
    assert before.settled
    assert after.settled
    np.testing.assert_allclose(after.displacements, before.displacements, atol=1e-4)


def test_a_shape_that_cannot_go_there_comes_to_rest(cube):
    def stuck(body, nodes, forces):
        linear = body.deform(nodes, forces, 1.0)
        return 0.001 * linear / (1.0 + 1e4 * np.linalg.norm(linear, axis=1).max())

    shape, (_, load) = MadeUp(cube, stuck), touch(cube, *SIDE)
    meeting = Meeting(cube, shape)
    for _ in range(15):
        meeting.step([load], YOUNG)
    rest = meeting.step([load], YOUNG)
    assert rest.settled
    np.testing.assert_array_equal(meeting.step([load], YOUNG).displacements, rest.displacements)


def test_the_linear_shape_meets_by_itself_and_nothing_touches_nothing(cube):
    _, load = touch(cube, *SIDE)
    met = settled(cube, LinearShape(cube), [load], YOUNG)
    assert met.missed == 0.0
    np.testing.assert_array_equal(met.displacements, met.linear)
    assert not settled(cube, MadeUp(cube, turning), [], YOUNG).displacements.any()
