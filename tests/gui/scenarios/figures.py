"""What is drawn over the view: force, depth, pressure, pins, tetrahedra, faults of a mesh."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import bpy
import numpy as np
from mouse_scene import BACK, depth, drag_in, end_press, open_mouse, start_press, type_key
from shown import replaced
from stage import Stage, Wait, at_length

from bl_ext.user_default.palpate.addon.inspection import body_view
from bl_ext.user_default.palpate.addon.overlay import hud, pixels
from bl_ext.user_default.palpate.addon.overlay.reading import reading
from bl_ext.user_default.palpate.addon.toolbar import surface_circle
from bl_ext.user_default.palpate.operators.session import press_session

Area = tuple[float, float, float, float]


@at_length
def figures_keep_clear_of_the_body_at_any_scale_of_the_interface(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    view = bpy.context.preferences.view
    usual = view.ui_scale
    try:
        for scale in (1.0, 1.75):
            view.ui_scale = scale
            # On this screen it leaves no room for anything else, at the larger one.
            stage.area.spaces.active.show_region_ui = scale == 1.0
            yield 0.5
            yield from start_press(stage)
            yield from drag_in(stage)
            with _rectangles() as areas:
                yield from stage.picture(f"scale-{100 * scale:.0f}")
            assert areas, "no figures were drawn"
            body = [stage.pixel(place) for place in _places_of_the_body()]
            region = stage.region("WINDOW")
            for x, y, width, height in areas:
                for place in body:
                    across, up = place[0] - region.x - x, place[1] - region.y - y
                    assert not (0 < across < width and 0 < up < height), (scale, x, y)
                assert 0 <= x <= x + width <= region.width
                assert 0 <= y <= y + height <= region.height
            yield from end_press(stage)
    finally:
        view.ui_scale = usual


@at_length
def figures_are_drawn_in_one_view_only(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    with stage.view():
        bpy.ops.screen.area_split(direction="VERTICAL", factor=0.6)
    # Open, they would cover the body.
    for area in stage.window.screen.areas:
        if area.type == "VIEW_3D":
            area.spaces.active.show_region_ui = False
    yield 0.5
    yield from start_press(stage)
    yield from drag_in(stage)
    drawn = set()
    draw = hud._draw_at

    def draw_at(*given: object) -> None:
        drawn.add(bpy.context.area.as_pointer())
        draw(*given)

    with replaced(hud, "_draw_at", draw_at):
        yield from stage.picture("two-views")
    assert drawn == {press_session.current().area}
    yield from end_press(stage)


@at_length
def depth_and_force_rise_until_the_tool_goes_no_deeper(stage: Stage) -> Wait:
    """Beyond the fingertip's own radius too; the wheel then leads it no further."""
    yield from open_mouse(stage)
    yield from start_press(stage)
    yield from drag_in(stage, release=False)
    tip = press_session.current().tip
    depths, forces = [depth()], [reading(press_session.current()).force]
    while len(depths) < 60 and depths[-1] < 0.98 * tip.deepest:
        for _ in range(3):
            yield from stage.key("WHEELUPMOUSE")
        yield from stage.until(_is_at_rest, "the finger's rest")
        depths.append(depth())
        forces.append(reading(press_session.current()).force)
    stage.note(millimetres=[round(1000 * one, 2) for one in depths], newtons=forces)
    yield from stage.picture("deepest")
    assert depths[-1] > 1.4 * tip.tool.radius
    assert np.diff(depths).min() > -1e-4
    assert np.diff(forces).min() > -0.02 * max(forces)
    for _ in range(5):
        yield from stage.key("WHEELUPMOUSE")
    yield 0.5
    assert depth() <= 1.05 * tip.deepest
    yield from stage.event("LEFTMOUSE", "RELEASE", stage.mouse)
    yield from type_key(stage, "ESC")


def pins_and_tetrahedra_are_drawn_over_the_object(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    chosen = bpy.context.scene.palpate
    chosen.show_pins = True
    yield from stage.picture("pins")
    faces, _ = body_view._known["pins"][1]
    assert len(faces) > 0
    chosen.show_pins = False
    chosen.show_tetrahedra, chosen.cut = True, 60.0
    yield from stage.picture("tetrahedra")
    few = len(body_view._known["tetrahedra"][1][0])
    chosen.cut = 100.0
    yield from stage.picture("whole")
    assert 0 < few < len(body_view._known["tetrahedra"][1][0])


def the_circle_grows_where_it_was_while_its_radius_is_set(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    with stage.view():
        bpy.ops.wm.tool_set_by_id(name="palpate.tool")
    x, y = stage.pixel(BACK)
    yield from stage.move((x, y))
    with _circles() as drawn:
        yield from stage.key("F")
        yield from stage.move((x + 40, y))
        yield from stage.picture("larger")
    yield from type_key(stage, "ESC")
    circle = np.array(drawn[-1])
    # The last of its points is the end of the normal's line, whose length is the circle's.
    assert np.linalg.norm(circle[:-1].mean(axis=0) - (x, y)) < 10
    assert np.ptp(circle, axis=0).max() > np.ptp(np.array(drawn[0]), axis=0).max() + 40


def a_hole_is_selected_where_a_mesh_is_refused(stage: Stage) -> Wait:
    yield from stage.open_sidebar("Palpate")
    with stage.view():
        bpy.ops.object.mode_set(mode="OBJECT")
    thing = bpy.data.objects["Cube"]
    mesh = thing.data
    corners = [vertex.co[:] for vertex in mesh.vertices]
    faces = [list(face.vertices) for face in mesh.polygons][:1]
    mesh.clear_geometry()
    mesh.from_pydata(corners, [], faces)
    mesh.update()
    yield 1.0
    yield from stage.picture("refused")
    with stage.view():
        bpy.ops.palpate.show_problems()
    yield from stage.picture("selected")
    assert thing.mode == "EDIT"
    bpy.ops.object.mode_set(mode="OBJECT")
    assert sum(edge.select for edge in thing.data.edges) == 4


@contextmanager
def _circles() -> Iterator[list[list[tuple[float, float]]]]:
    """Circles that are drawn on the surface while this lasts, window pixels."""
    circles: list[list[tuple[float, float]]] = []
    draw = surface_circle._draw_line

    def line(points: list[tuple[float, float]], *rest: object) -> None:
        circles.append(points)
        draw(points, *rest)

    with replaced(surface_circle, "_draw_line", line):
        yield circles


@contextmanager
def _rectangles() -> Iterator[list[Area]]:
    """Areas that are filled in the view while this lasts."""
    areas: list[Area] = []
    draw = pixels.rectangle

    def rectangle(x: float, y: float, width: float, height: float, color: pixels.Color) -> None:
        areas.append((x, y, width, height))
        draw(x, y, width, height, color)

    with replaced(pixels, "rectangle", rectangle):
        yield areas


def _places_of_the_body() -> np.ndarray:
    session = press_session.current()
    nodes = session.seen.nodes()[session.drawn.body.mesh.surface_nodes]
    return session.drawn.frame.world_from_body(nodes)


def _is_at_rest() -> bool:
    """Whether the finger touches, and has come to where it is led."""
    shot = press_session.current().snapshot
    return bool(shot.touching and np.linalg.norm(shot.proxy - shot.probe) < 1e-5)
