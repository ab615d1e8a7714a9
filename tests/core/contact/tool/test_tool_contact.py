import numpy as np
import pytest
from bodies.baked_body import baked_body
from bodies.inner_corner import inner_corner
from bodies.soft_block import soft_block
from scipy.spatial.transform import Rotation

from palpate.core.contact.near_field.point_compliance import point_compliance
from palpate.core.contact.press import ContactSettings, Press
from palpate.core.contact.single_press import press_tool
from palpate.core.contact.tool.convex_tool import convex
from palpate.core.contact.tool.pose import Pose
from palpate.core.contact.tool.tool_surface import surface_and_correction
from palpate.core.contact.tool.tools import plate, rod, sphere
from palpate.core.errors import PalpateError
from palpate.core.mesh.tet_mesh import TetMesh

TOP = 0.05
BOX = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * 0.012
# Each tool on the top of the cube with a tilt and a height at which it presses 1 to 4 mm deep.
PRESSES = {
    "sphere": (sphere(0.014), [0.3, 0.2, 0.1], TOP + 0.01),
    "rod": (rod(0.012, 0.02), [0.02, 0.05, 0.4], TOP + 0.008),
    "plate": (plate(0.03, 0.03), [0.05, -0.08, 0.2], TOP - 0.0005),
    "corner": (convex(BOX, 0.006), [0.5, 0.7, 0.2], TOP + 0.014),
}


@pytest.fixture(scope="module", params=list(PRESSES))
def press(request, cube):
    """A tool on the cube, and where it is at first."""
    tool, turn, height = PRESSES[request.param]
    pose = Pose.at([0.0262, 0.0243, height], Rotation.from_rotvec(turn).as_matrix())
    return Press(cube, [tool]), tool, pose


@pytest.fixture(scope="module")
def pressed(press):
    to, _, pose = press
    return to.to([pose])[0]


def moved(pose, by=(0, 0, 0), turn=(0, 0, 0)):
    return Pose.at(pose.position + by, Rotation.from_rotvec(turn).as_matrix() @ pose.rotation)


def held_back(touch):
    """Points that stay off the tool, for their push may not tilt further from their normal."""
    gone_to = touch.places + touch.displacements
    distance, normals = touch.tool.distance(touch.pose.to_tool(gone_to))
    assert (distance > -1e-10).all()
    return distance > 1e-10, normals @ touch.pose.rotation.T


def test_the_force_is_the_slope_of_the_elastic_energy(press, pressed):
    def energy(**change):
        return press[0].to([moved(pressed.pose, **change)])[0].energy

    force, torque = np.empty(3), np.empty(3)
    for axis, along in enumerate(np.eye(3)):
        step, angle = 1e-6 * along, 1e-4 * along
        force[axis] = -(energy(by=step) - energy(by=-step)) / 2e-6
        torque[axis] = -(energy(turn=angle) - energy(turn=-angle)) / 2e-4
    assert pressed.force[2] > 0.1
    np.testing.assert_allclose(pressed.force, force, atol=2e-6 * np.linalg.norm(force))
    # The limit of a push's tilt does not turn with the tool: at the plate's rim, a part in 1000.
    share = 2e-6 if held_back(pressed)[0].sum() == 0 else 1e-3
    np.testing.assert_allclose(pressed.torque, torque, atol=share * np.linalg.norm(force) * 0.01)


def test_points_are_pushed_out_of_the_tool_and_never_pulled(pressed):
    assert (pressed.pushes > 0).all()
    assert (pressed.pressures > 0).all()
    np.testing.assert_allclose(pressed.forces, pressed.pushes[:, None] * pressed.normals)
    # The pressed points lie on the tool, exactly, where their push is not held near their normal.
    held, normals = held_back(pressed)
    np.testing.assert_allclose(normals[~held], pressed.normals[~held], atol=1e-8)
    assert (np.einsum("px,px->p", normals[held], pressed.normals[held]) < 1 - 1e-6).all()
    assert held.mean() < 0.5


def test_forces_on_nodes_add_up_to_what_the_tool_feels(cube, pressed):
    np.testing.assert_allclose(pressed.nodal_forces.sum(axis=0), -pressed.force, atol=1e-12)
    nodes = cube.mesh.nodes[pressed.nodes]
    about_origin = np.cross(nodes, pressed.nodal_forces).sum(axis=0)
    at_points = np.cross(pressed.places, pressed.forces).sum(axis=0)
    np.testing.assert_allclose(about_origin, at_points, atol=1e-12)
    assert len(np.unique(pressed.nodes)) == len(pressed.nodes)


def test_deeper_than_its_radius_a_sphere_is_still_resisted_more_and_more(cube):
    tool = sphere(0.014)
    depths = np.arange(1, 7) * 0.2 * tool.radius
    press, forces = Press(cube, [tool]), []
    for depth in depths:
        (touch,) = press.to([Pose.at([0.0262, 0.0243, TOP + tool.radius - depth])])
        forces.append(touch.force[2])
    assert held_back(touch)[0].any()
    assert (np.diff(forces) > 0).all()


@pytest.fixture(scope="module")
def corner():
    return inner_corner()


@pytest.mark.parametrize("depth", [0.001, 0.004])
def test_in_an_inner_corner_wall_and_floor_are_felt_each_by_itself(corner, depth):
    """Pushes on the wall are not held near those on the floor."""
    tool = sphere(0.008)

    def pressed(into_wall):
        place = [0.025 + tool.radius - into_wall, 0.025, 0.025 + tool.radius - depth]
        return press_tool(corner, tool, Pose.at(place)).force

    far, near, touching = pressed(-0.003), pressed(-0.0005), pressed(0.0003)
    assert near[0] == pytest.approx(far[0], abs=0.015 * far[2])
    assert near[2] == pytest.approx(far[2], rel=0.02)
    assert far[0] < 0.5 * touching[0] < touching[0] < 0.3 * far[2]


@pytest.mark.parametrize(
    ("size", "cells", "tool", "place", "out"),
    [
        ((0.06, 0.006, 0.04), (10, 2, 6), sphere(0.006), [0.029, 0.006, 0.012], [0.0, 1.0, 0.0]),
        # To nearly twice the thickness: the sphere reaches the pinned far side.
        ((0.04, 0.04, 0.006), (6, 6, 2), sphere(0.008), [0.021, 0.019, 0.006], [0.0, 0.0, 1.0]),
    ],
    ids=["upright strip", "slab on a firm base"],
)
def test_what_has_come_through_a_thin_part_does_not_draw_the_tool_on(size, cells, tool, place, out):
    press, forces = Press(soft_block(size, cells), [tool]), []
    for depth in 0.001 * np.arange(-1, 12):
        (touch,) = press.to([Pose.at(place + (tool.radius - depth) * np.array(out))])
        forces.append(touch.force @ out)
    assert (np.diff(forces[2:]) > 0).all()


def test_the_way_there_does_not_matter(press, pressed):
    above = moved(pressed.pose, by=[0.003, -0.002, 0.01], turn=[0.1, 0.0, 0.3])
    press[0].to([above])
    (around,) = press[0].to([pressed.pose])
    np.testing.assert_allclose(around.force, pressed.force, rtol=1e-8, atol=1e-10)


def test_the_force_follows_the_modulus(cube, pressed):
    settings = ContactSettings(2 * cube.young_modulus)
    double = press_tool(cube, pressed.tool, pressed.pose, settings)
    close = 2e-9 * np.linalg.norm(pressed.force)
    np.testing.assert_allclose(double.force, 2 * pressed.force, atol=close)
    np.testing.assert_allclose(double.stiffness, 2 * pressed.stiffness, rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize(
    ("settings", "said"),
    [
        (ContactSettings(float("nan")), "Young's modulus is nan"),
        (ContactSettings(friction=-0.1), "friction is -0.1"),
    ],
)
def test_settings_that_cannot_be_are_refused(cube, settings, said):
    with pytest.raises(PalpateError, match=said):
        press_tool(cube, sphere(0.014), Pose.at([0.025, 0.025, TOP]), settings)


def test_two_tools_that_pinch_feel_each_other_alike(cube):
    tool = sphere(0.014)
    left = Pose.at([-0.011, 0.025, 0.035])
    right = Pose.at([0.061, 0.025, 0.035])
    press = Press(cube, [tool, tool])
    touches = press.to([left, right])
    alone = press_tool(cube, tool, left)
    assert touches[0].force[0] < 0 < touches[1].force[0]
    assert touches[0].force[0] == pytest.approx(-touches[1].force[0], rel=0.02)
    # The other finger keeps the cube from giving way.
    assert touches[0].force[0] < 1.02 * alone.force[0] < 0
    step = 1e-6
    energies = [
        sum(touch.energy for touch in press.to([left, moved(right, by=[by, 0, 0])]))
        for by in (step, -step)
    ]
    slope = -(energies[0] - energies[1]) / (2 * step)
    # The table of the compliance is float32.
    assert touches[1].force[0] == pytest.approx(slope, rel=2e-4)
    swapped = Press(cube, [tool, tool]).to([right, left])
    np.testing.assert_allclose(swapped[0].force, touches[1].force, rtol=1e-6, atol=1e-9)


@pytest.fixture(scope="module")
def strips():
    """Strips 12 mm thick, of one to four elements."""
    cells = [(5, 1, 3), (10, 2, 7), (15, 3, 10), (20, 4, 13)]
    return [soft_block((0.06, 0.012, 0.04), each) for each in cells]


TIP = sphere(0.008)


def squeezing(depth):
    """Fingertips on both sides of such a strip."""
    sides = (depth - TIP.radius, 0.012 + TIP.radius - depth)
    return [Pose.at([0.029, y, 0.02]) for y in sides]


def test_how_far_a_strip_gives_way_to_two_fingertips_does_not_follow_its_mesh(strips):
    """Plain finite elements: 8.2, 3.2, 2.5 and 2.2 N; the near field across what bends: none."""
    forces = []
    for strip in strips:
        press = Press(strip, [TIP, TIP])
        press.to(squeezing(-0.001))
        touches = press.to(squeezing(0.002))
        assert touches[0].force[1] == pytest.approx(-touches[1].force[1], rel=0.05)
        forces.append(touches[1].force[1])
    assert (np.array(forces) > 0.7 * forces[-1]).all()
    assert (np.array(forces) < 1.1 * forces[-1]).all()


def test_all_that_two_fingertips_press_on_both_sides_of_a_strip_takes_work(strips):
    """Points within 0.7 of the radius from the middle of either side, together."""
    for strip in strips:
        surface, near = surface_and_correction(strip, TIP)
        aside = np.linalg.norm((surface.positions - [0.029, 0.0, 0.02])[:, [0, 2]], axis=1)
        few = [
            np.flatnonzero((aside < 0.0056) & (surface.normals[:, 1] * side > 0.9))
            for side in (-1, 1)
        ]
        together = np.concatenate(few)
        blocks = point_compliance(strip, surface, together, together)
        first = len(few[0])
        blocks[:first, :first] += near.between(few[0], few[0])
        blocks[first:, first:] += near.between(few[1], few[1])
        matrix = blocks.transpose(0, 2, 1, 3).reshape(3 * len(together), -1)
        values = np.linalg.eigvalsh(matrix)
        assert values[0] > 1e-3 * values[-1]


def test_a_tool_much_larger_than_the_body_presses_like_a_wide_plate(cube):
    flat = press_tool(cube, plate(0.08, 0.08), Pose.at([0.025, 0.025, TOP - 0.001]))
    huge = press_tool(cube, sphere(20.0), Pose.at([0.025, 0.025, TOP + 20.0 - 0.001]))
    assert huge.force[2] == pytest.approx(flat.force[2], rel=0.05)


@pytest.mark.parametrize("air", [0.0, 1e-18, -1e-18, 1e-16, -1e-16])
def test_a_tool_that_grazes_the_surface_comes_to_rest(cube, air):
    """Whether it touches is a matter of rounding there."""
    at = cube.mesh.nodes[:, 2].max() + 0.014 + air
    touch = Press(cube, [sphere(0.014)]).to([Pose.at([0.025, 0.025, at])])[0]
    assert np.linalg.norm(touch.force) < 1e-10


def test_a_tool_with_no_digits_left_for_where_it_touches_is_refused(cube):
    with pytest.raises(PalpateError, match="times the body's size"):
        press_tool(cube, sphere(1e6), Pose.at([0.025, 0.025, TOP + 1e6]))


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_a_body_far_from_the_origin_is_pressed_as_one_near_it(cube, cube_mesh, friction):
    mesh, fixed = cube_mesh
    away = np.array([1e4, 0.0, 0.0])
    moved_off = baked_body(TetMesh.checked(mesh.nodes + away, mesh.tets), fixed, 0.49, 10_000.0)
    near, far = (
        Press(body, [sphere(0.014)], ContactSettings(friction=friction)).to(
            [Pose.at(np.add(origin, [0.0262, 0.0243, TOP + 0.01]))]
        )[0]
        for body, origin in ((cube, 0.0 * away), (moved_off, away))
    )
    # Which of equally near points are taken is a matter of rounding.
    np.testing.assert_allclose(far.force, near.force, atol=2e-3 * np.linalg.norm(near.force))
