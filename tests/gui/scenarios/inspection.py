"""Looking into an object: what is pinned, its tetrahedra, what is wrong with a mesh."""

from __future__ import annotations

import bpy
from mouse_scene import open_mouse
from stage import Stage, Wait

from bl_ext.user_default.palpate.addon.inspection import body_view


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
