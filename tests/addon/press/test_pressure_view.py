"""How tools, pressure and values are drawn, in numbers: no view is needed."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from soft_scene import part

TOOLS = {
    "sphere": lambda tools: tools.sphere(0.01),
    "rod": lambda tools: tools.rod(0.004, 0.03),
    "plate": lambda tools: tools.plate(0.02, 0.03),
    "mesh": lambda _: part("core.contact.tool.convex_tool").convex(
        np.random.default_rng(1).normal(size=(30, 3))
    ),
}


def test_more_pressure_is_brighter(palpate):
    colors = part("addon.overlay.pressure_colors").color_of(np.linspace(0.0, 1.2, 40))
    brightness = colors @ (0.2126, 0.7152, 0.0722)
    assert (np.diff(brightness[:33]) > 0.0).all()
    assert colors.min() >= 0.0
    assert colors.max() <= 1.0


@pytest.mark.parametrize(
    ("pressure", "top"), [(0.0, 1.0), (3.0, 5.0), (1000.0, 1000.0), (1001.0, 2000.0)]
)
def test_the_scale_is_a_round_number(palpate, pressure, top):
    assert part("addon.overlay.pressure_colors").round_up(pressure) == pytest.approx(top)


def test_the_scale_does_not_flicker(palpate):
    scale = part("addon.overlay.pressure_colors").PressureScale()
    assert scale.follow(900.0) == 1000.0
    assert scale.follow(400.0) == 1000.0
    assert scale.follow(1100.0) == 2000.0
    assert scale.follow(500.0) == 500.0


@pytest.mark.parametrize("name", TOOLS)
def test_a_tool_is_drawn_where_it_is_felt(palpate, name):
    """The drawn shape lies on the tool's own surface, wound outward, and is closed."""
    tool = TOOLS[name](part("core.contact.tool.tools"))
    shape = part("addon.overlay.shapes").tool_shape(tool)
    distance, normals = tool.distance(shape.vertices)
    assert np.abs(distance).max() < 0.05 * tool.radius
    corners = shape.vertices[shape.triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    middle = shape.vertices.mean(axis=0)
    assert (np.einsum("fx,fx->f", across, corners.mean(axis=1) - middle) > 0.0).all()
    assert np.einsum("vx,vx->v", normals, shape.normals).min() > 0.5


BALL, ACROSS = 1.0, 0.1


def cap(stretched):
    """Patch of a ball with the middle of its top pressed most, points 0.1 apart times a stretch."""
    steps = np.arange(-6, 7) * ACROSS * stretched
    flat = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2)
    flat = flat[np.linalg.norm(flat, axis=1) < 0.45]
    up = np.sqrt(BALL**2 - (flat**2).sum(axis=1))
    points = np.column_stack([flat, up])
    radii = np.full(len(points), ACROSS / np.sqrt(np.pi))
    return part("addon.overlay.reading").Patch(points, points, 1.0 - (flat**2).sum(axis=1), radii)


@pytest.mark.parametrize("stretched", [1.0, 1.7])
def test_a_patch_is_one_area_without_gaps_on_the_surface_that_is_touched(palpate, stretched):
    patch = cap(stretched)
    film = part("addon.overlay.contact_film").contact_film
    vertices, rgba, triangles = film(patch, 2.0, np.zeros(3))
    away = np.linalg.norm(vertices[:, :2], axis=1)
    within = away < 0.35
    assert within.sum() > 2 * len(patch.places)
    assert (rgba[within, 3] == 1.0).all()
    assert (rgba[away > 0.45 + 3.0 * ACROSS * stretched, 3] == 0.0).all()
    np.testing.assert_allclose(np.linalg.norm(vertices[within], axis=1), BALL, atol=0.02)
    expected = part("addon.overlay.pressure_colors").color_of((1.0 - away[within] ** 2) / 2.0)
    np.testing.assert_allclose(rgba[within, :3], expected, atol=0.03)
    corners = vertices[triangles]
    inside = within[triangles].all(axis=1)
    outward = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])[inside]
    assert (np.einsum("fx,fx->f", outward, corners[inside].mean(axis=1)) > 0.0).all()


def test_one_contact_point_is_an_area_too(palpate):
    whole = cap(1.0)
    one = type(whole)(whole.places[:1], whole.normals[:1], whole.pressures[:1], whole.radii[:1])
    vertices, rgba, _ = part("addon.overlay.contact_film").contact_film(one, 1.0, np.zeros(3))
    assert np.isfinite(vertices).all()
    assert rgba[:, 3].max() == 1.0


SLAB = "456 467 021 032 015 054 126 165 237 276 304 347"
SLAB_TRIANGLES = np.array([[int(corner) for corner in triangle] for triangle in SLAB.split()])


def slab(thickness):
    """Corners of a plate whose upper face is at height 0."""
    square = np.array([[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]])
    heights = np.repeat([-thickness, 0.0], 4)[:, None]
    return np.hstack([np.tile(square, (2, 1)), heights])


@pytest.mark.parametrize("name", ["sphere", "plate", "rod"])
@pytest.mark.parametrize("thickness", [0.5, 20.0])
def test_a_tool_is_as_deep_as_it_has_travelled_however_far(palpate, name, thickness):
    """Also beyond its own radius, and through a thin part that has given way."""
    tools, depths = part("core.contact.tool.tools"), part("operators.tool.tool_depth")
    Pose = part("core.contact.tool.pose").Pose  # noqa: N806
    tool = {
        "sphere": lambda: tools.sphere(1.0),
        "plate": lambda: tools.plate(2.0, 3.0),
        "rod": lambda: tools.rod(1.0, 4.0),
    }[name]()
    low = float(tool.core[:, 2].min()) - tool.radius
    down, nodes = np.array([0.0, 0.0, -1.0]), slab(thickness)
    for travelled in (0.01, 0.3, 1.0, 1.7, 4.0):
        pose = Pose(np.array([0.02, 0.01, -low - travelled]), np.eye(3))
        depth = depths.depth_of(tool, pose, down, nodes, SLAB_TRIANGLES)
        assert depth == pytest.approx(travelled)
    away = Pose(np.array([0.0, 0.0, 9.0]), np.eye(3))
    assert depths.depth_of(tool, away, down, nodes, SLAB_TRIANGLES) == 0.0


def test_quantities_keep_their_digits_at_any_size(palpate):
    quantities = part("core.quantities")
    assert quantities.area(12.34e-6) == "12.3 mm²"
    assert quantities.area(4.56e-4) == "4.56 cm²"
    assert quantities.area(0.124) == "0.124 m²"
    assert quantities.pressure(1234.5) == "1.23 kPa"
    assert quantities.pressure(2.5e6) == "2.5 MPa"


@pytest.mark.parametrize(
    ("force", "depth", "told"),
    [
        (25.416, 0.1542, "25.4 N     15.4 cm"),
        (3.2e-5, 1.2e-5, "32 µN     12 µm"),
        (2.4e6, 60.3, "2.4 MN     60.3 m"),
        (1e-14, 0.0, "0 N     0 m"),
    ],
)
def test_force_and_depth_are_read_at_any_size_of_the_object(palpate, force, depth, told):
    hud = part("addon.overlay.hud")
    figures = SimpleNamespace(force=force, depth=depth, touching=False)
    session = SimpleNamespace(tip=SimpleNamespace(tool=None))
    assert [line.text for line in hud._measured((figures,), session)] == [told]


ROOM = (10.0, 10.0, 790.0, 590.0)


def places(*corners):
    return np.array(corners, dtype=np.float64)


@pytest.mark.parametrize(
    ("shown", "corner"),
    [
        (places(), (10.0, 10.0)),
        (places((300, 200), (500, 200), (400, 500)), (10.0, 10.0)),
        (places((0, 0), (300, 0), (0, 300)), (590.0, 10.0)),
        (places((0, 0), (800, 0), (400, 300)), (10.0, 490.0)),
        (places((0, 0), (800, 0), (800, 600), (0, 600)), None),
        # Its bounding box covers the corner, it does not.
        (places((0, 600), (0, 400), (400, 0), (800, 0), (800, 600)), (10.0, 10.0)),
    ],
)
def test_the_hud_takes_the_first_corner_where_nothing_is(palpate, shown, corner):
    module = part("addon.overlay.free_corner")
    found = module.free_corner((200.0, 100.0), module.Room(*ROOM), shown.reshape(-1, 2))
    assert found == corner


def test_in_a_view_smaller_than_the_hud_there_is_no_corner(palpate):
    module = part("addon.overlay.free_corner")
    small = module.Room(10.0, 10.0, 100.0, 590.0)
    assert module.free_corner((200.0, 100.0), small, np.zeros((0, 2))) is None
