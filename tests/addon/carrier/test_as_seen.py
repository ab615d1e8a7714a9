"""Bodies of the mesh as seen, and dents on vertices that the mesh itself does not have."""

from __future__ import annotations

import time
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from soft_scene import (
    COARSE,
    error_of,
    layer_names,
    moved,
    part,
    pose_by_bone,
    rest_places,
    seen_places,
    select,
    status,
)
from without_palpate import without_palpate

STROKE = {"motion": "PUSH", "depth": 0.15, "radius": 0.25}


def default_cube():
    thing = select(bpy.data.objects["Cube"])
    thing.palpate.edge_length = COARSE
    return thing


def half_sphere():
    """The half of a sphere of radius 1 with x >= 0, mirrored to a whole one."""
    bpy.ops.mesh.primitive_uv_sphere_add(segments=24, ring_count=12)
    thing = bpy.context.object
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.bisect(plane_co=(0, 0, 0), plane_no=(1, 0, 0), clear_inner=True)
    bpy.ops.object.mode_set(mode="OBJECT")
    thing.modifiers.new("Mirror", "MIRROR")
    thing.palpate.edge_length = COARSE
    return select(thing)


def made_soft(thing):
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    return thing


def carrier_places(thing):
    return rest_places(thing.palpate.carrier)


def seen_mesh(thing):
    bpy.context.view_layer.update()
    return thing.evaluated_get(bpy.context.evaluated_depsgraph_get()).data


def open_edges(mesh):
    """Edges that have one face."""
    faces = np.zeros(len(mesh.edges), dtype=int)
    for loop in mesh.loops:
        faces[loop.edge_index] += 1
    return int((faces == 1).sum())


def test_the_default_cube_shows_a_round_dent_between_sharp_edges(palpate):
    thing = made_soft(default_cube())
    mesh = rest_places(thing).tobytes()
    assert (len(seen_places(thing)), thing.modifiers.keys()) == (8, [])
    assert bpy.ops.palpate.stroke(place=(0.1, 0.2, 1.0), **STROKE) == {"FINISHED"}
    assert thing.modifiers.keys() == ["Palpate Fine", "Press 1"]
    rest, seen = carrier_places(thing), seen_places(thing)
    np.testing.assert_allclose(seen - rest, moved(thing, "Press 1"), atol=1e-6)
    dent = -(seen - rest)[:, 2]
    deepest = rest[np.argmax(dent)]
    np.testing.assert_allclose(deepest, (0.1, 0.2, 1.0), atol=0.07)
    assert 0.1 < dent.max() < 0.16
    # The cube's own edges are sharp, and nothing else: flat faces are shaded flat, dents smooth.
    evaluated = seen_mesh(thing)
    on_edges = (np.abs(np.abs(rest) - 1.0) < 1e-6).sum(axis=1) >= 2
    for edge in evaluated.edges:
        assert edge.use_edge_sharp == on_edges[list(edge.vertices)].all()
    assert all(face.use_smooth for face in evaluated.polygons)
    assert rest_places(thing).tobytes() == mesh
    # Without layers it is as it was.
    part("operators.layer.layers").remove(thing, thing.modifiers["Press 1"])
    assert (len(seen_places(thing)), thing.modifiers.keys()) == (8, [])


def test_a_press_of_the_default_cube_that_is_cancelled_leaves_nothing(sessions, states, palpate):
    thing = made_soft(default_cube())
    session = sessions.begin(thing, bpy.context.scene, states.Source.POINTER)
    assert thing.modifiers.keys()[0] == "Palpate Fine"
    session.post(states.Moment.CANCEL)
    assert (thing.modifiers.keys(), len(seen_places(thing))) == ([], 8)
    names = thing.palpate.carrier.data.attributes.keys()
    assert not [name for name in names if name.lower().startswith("palpate")]


def test_strokes_on_a_carrier_are_undone_saved_and_gone_on_from(palpate, tmp_path):
    made_soft(default_cube())
    bpy.ops.ed.undo_push(message="before")
    for place in ((0.1, 0.2, 1.0), (0.2, 0.1, 1.0)):
        assert bpy.ops.palpate.stroke("EXEC_DEFAULT", True, place=place, **STROKE) == {"FINISHED"}
    both = seen_places(bpy.data.objects["Cube"])
    bpy.ops.ed.undo()
    thing = bpy.data.objects["Cube"]
    assert layer_names(thing) == ["Press 1"]
    np.testing.assert_allclose(
        seen_places(thing), carrier_places(thing) + moved(thing, "Press 1"), atol=1e-6
    )
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "cube.blend"))
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "cube.blend"))
    thing = select(bpy.data.objects["Cube"])
    assert bpy.ops.palpate.stroke(place=(0.2, 0.1, 1.0), **STROKE) == {"FINISHED"}
    np.testing.assert_allclose(seen_places(thing), both, atol=1e-4)


def test_its_own_vertices_are_taken_where_that_is_asked(palpate):
    thing = half_sphere()
    thing.palpate.bake_from = "BASE"
    thing.modifiers["Mirror"].show_viewport = False
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.edge_face_add()
    bpy.ops.object.mode_set(mode="OBJECT")
    thing.modifiers["Mirror"].show_viewport = True
    made_soft(thing)
    assert thing.palpate.carrier is None
    assert part("operators.object.embedded_body").embedded(thing).mesh.nodes[:, 0].min() > -0.1


def test_a_mirrored_half_is_baked_whole_and_dented_across_its_closed_seam(palpate, tmp_path):
    thing = half_sphere()
    group = thing.vertex_groups.new(name="Held")
    low = np.flatnonzero(rest_places(thing)[:, 2] < -0.8)
    group.add(low.tolist(), 1.0, "REPLACE")
    thing.palpate.pin_mode, thing.palpate.pin_group = "GROUP", "Held"
    made_soft(thing)
    within = part("operators.object.embedded_body").embedded(thing)
    left, right = (within.mesh.nodes[within.fixed][:, 0] * side for side in (-1, 1))
    # Painted on the half, held on both sides.
    assert (left > 0.1).any()
    assert (right > 0.1).any()
    armature = pose_by_bone(thing, 1.0)
    turn = np.array(armature.pose.bones["Bone"].matrix_channel)[:3, :3]
    at = turn @ np.array([0.05, 0.1, 0.99])
    assert bpy.ops.palpate.stroke(place=tuple(at), **STROKE) == {"FINISHED"}
    assert thing.modifiers.keys()[0] == "Mirror"
    assert thing.modifiers.keys()[-2:] == ["Press 1", "Pose"]
    rest, dent = carrier_places(thing), moved(thing, "Press 1")
    np.testing.assert_allclose(seen_places(thing), (rest + dent) @ turn.T, atol=1e-5)
    deepest = rest[np.argmax(np.linalg.norm(dent, axis=1))]
    assert deepest[2] > 0.9
    assert np.abs(dent[(rest[:, 0] < -0.05) & (rest[:, 2] > 0.9)]).max() > 0.02
    assert open_edges(seen_mesh(thing)) == 0
    seen = seen_places(thing)
    opened = without_palpate(tmp_path)
    np.testing.assert_allclose(opened[thing.name], seen, rtol=0, atol=1e-6)


@pytest.mark.at_length
def test_a_finer_mesh_takes_the_dent_over_by_place_and_a_new_bake_keeps_the_carrier(palpate):
    thing = default_cube()
    subdivision = thing.modifiers.new("Subdivision", "SUBSURF")
    subdivision.levels = 3
    made_soft(thing)
    carrier = thing.palpate.carrier
    top = seen_places(thing)[:, 2].max()
    assert bpy.ops.palpate.stroke(place=(0.05, 0.05, top), **STROKE) == {"FINISHED"}
    assert thing.modifiers.keys()[0] == "Subdivision"
    lowest = -moved(thing, "Press 1")[:, 2].min()
    assert lowest > 0.1
    before = seen_places(thing)
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert thing.palpate.carrier == carrier
    np.testing.assert_array_equal(seen_places(thing), before)
    # As renders have it, which take another level.
    subdivision.levels = 4
    finer = seen_places(thing)
    assert len(finer) > 3 * len(before)
    thing.modifiers["Press 1"].show_viewport = False
    smooth = seen_places(thing)
    assert abs((smooth - finer)[:, 2].max() - lowest) < 0.05 * lowest
    thing.modifiers["Press 1"].show_viewport = True
    fit = part("operators.object.soft_object").Fit
    assert (status(thing).fit, "modifiers" in status(thing).text) == (fit.CHANGED, True)
    assert "modifiers" in error_of(bpy.ops.palpate.stroke, place=(0, 0, top), **STROKE)
    assert layer_names(thing) == ["Press 1"]


def test_vertices_that_change_from_frame_to_frame_are_refused_by_name(palpate):
    thing, scene = default_cube(), bpy.context.scene
    thing.modifiers.new("Triangulate", "TRIANGULATE")
    array = thing.modifiers.new("More and more", "ARRAY")
    for frame, count in ((1, 1), (20, 3)):
        array.count = count
        array.keyframe_insert("count", frame=frame)
    scene.frame_start, scene.frame_end = 1, 20
    scene.frame_set(1)
    said = error_of(bpy.ops.palpate.make_soft)
    assert "'More and more'" in said
    assert "Base Mesh" in said
    assert (scene.frame_current, thing.palpate.body_key) == (1, "")


def test_looking_at_other_frames_moves_nothing(palpate):
    thing, scene = default_cube(), bpy.context.scene
    thing.modifiers.new("Weld", "WELD")
    array = thing.modifiers.new("Array", "ARRAY")
    array.count = 2
    array.keyframe_insert("count", frame=1)
    for frame, height in ((1, 0.0), (20, 1.0)):
        thing.location.z = height
        thing.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, 20
    scene.frame_set(7, subframe=0.5)
    thing["weight"] = 1.0
    thing.keyframe_insert('["weight"]', frame=1)
    # Moved by hand, and not keyed.
    thing.location.x, thing["weight"] = 3.0, 2.0
    bpy.context.view_layer.update()
    place, scenes = thing.matrix_world.copy(), list(bpy.data.scenes)
    part("operators.carrier.changing").refuse(thing, scene)
    assert (thing.matrix_world, thing.location.x, thing["weight"]) == (place, 3.0, 2.0)
    bpy.context.view_layer.update()
    assert thing.matrix_world == place
    assert (scene.frame_current, scene.frame_subframe) == (7, pytest.approx(0.5))
    assert list(bpy.data.scenes) == scenes


@pytest.mark.at_length
def test_another_number_of_vertices_than_was_baked_is_refused_when_pressed(palpate):
    thing, scene = default_cube(), bpy.context.scene
    solid = thing.modifiers.new("Bevel", "BEVEL")
    for frame, segments in ((1, 2), (40, 4)):
        solid.segments = segments
        solid.keyframe_insert("segments", frame=frame)
    scene.frame_start = scene.frame_end = 1
    scene.frame_set(1)
    made_soft(thing)
    scene.frame_set(40)
    said = error_of(bpy.ops.palpate.stroke, place=(0, 0, 1), **STROKE)
    assert "vertices in this frame" in said
    scene.frame_set(1)
    assert bpy.ops.palpate.stroke(place=(0, 0, 1), **STROKE) == {"FINISHED"}


@pytest.mark.parametrize("keep", ["CACHE", pytest.param("KEYS", marks=pytest.mark.at_length)])
def test_an_animation_is_played_on_the_carriers_vertices(palpate, keep, tmp_path):
    thing, scene = default_cube(), bpy.context.scene
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "cube.blend"))
    thing = select(bpy.data.objects["Cube"])
    made_soft(thing)
    bpy.ops.object.empty_add(type="SPHERE", radius=0.3)
    tool = bpy.context.object
    for frame, height in ((1, 1.5), (3, 1.15)):
        tool.location.z = height
        tool.keyframe_insert("location", frame=frame)
    group = bpy.data.collections.new("Tools")
    group.objects.link(tool)
    thing.palpate.pressers = group
    select(thing)
    scene.frame_start, scene.frame_end = 1, 3
    if keep == "KEYS":
        assert "Mesh Cache" in error_of(bpy.ops.palpate.press_frames, keep=keep)
        return
    assert bpy.ops.palpate.press_frames(keep=keep) == {"FINISHED"}
    scene.frame_set(3)
    rest, seen = carrier_places(thing), seen_places(thing)
    assert len(seen) == len(rest)
    assert 0.1 < (rest - seen)[:, 2].max() < 0.2


def test_the_panel_predicts_what_is_seen(palpate):
    """A plane has no inside; with a Solidify modifier it has, which counts."""
    bpy.ops.mesh.primitive_plane_add(size=1.0)
    thing, scene = select(bpy.context.object), bpy.context.scene
    known = part("addon.known_status")
    with pytest.raises(part("core.errors").PalpateError):
        _predicted(known, thing, scene)
    thing.modifiers.new("Solidify", "SOLIDIFY").thickness = 0.3
    bpy.context.view_layer.update()
    known.forget()
    assert _predicted(known, thing, scene).cost.peak_bytes > 0
    thing.palpate.bake_from = "BASE"
    with pytest.raises(part("core.errors").PalpateError):
        _predicted(known, thing, scene)


def _predicted(known, thing, scene):
    for _ in range(200):
        found = known.prediction(thing, scene)
        if found is not None:
            return found
        time.sleep(0.05)
    raise AssertionError("no prediction")


def test_what_is_not_evaluated_is_refused_and_not_baked_from_the_base(palpate):
    thing = half_sphere()
    thing.hide_viewport = True
    bpy.context.view_layer.update()
    source = part("operators.carrier.body_source")
    with pytest.raises(part("core.errors").PalpateError, match="disabled in viewports"):
        source.read(thing, bpy.context.scene)
    thing.hide_viewport = False
    thing.hide_set(True)
    surface = source.read(thing, bpy.context.scene)
    assert surface.local[:, 0].min() < -0.9


def test_words_of_modifiers_tell_what_was_set_and_no_more(palpate):
    stack, thing = part("operators.layer.stack"), half_sphere()
    modifier = thing.modifiers.new("Finer", "SUBSURF")
    words = stack.words(thing, list(thing.modifiers))
    assert words == "MIRROR use_axis=(True, False, False); SUBSURF"
    modifier.open_advanced_panel = not modifier.open_advanced_panel
    modifier.show_expanded, modifier.render_levels = False, 4
    assert stack.words(thing, list(thing.modifiers)) == words
    modifier.levels = 2
    assert stack.words(thing, list(thing.modifiers)) == f"{words} levels=2"


def test_settings_that_a_newer_blender_adds_change_no_words(palpate):
    stack = part("operators.layer.stack")
    flags = {"is_array": False, "is_enum_flag": False}
    known = {"type": "INT", "identifier": "levels", "default": 1, **flags}
    added = {"type": "BOOLEAN", "identifier": "use_new_way", "default": False, **flags}

    def words(*properties):
        described = SimpleNamespace(properties=[SimpleNamespace(**one) for one in properties])
        modifier = SimpleNamespace(
            type="SUBSURF", bl_rna=described, levels=3, use_new_way=False, path_from_id=str
        )
        return stack.words(bpy.data.objects["Cube"], [modifier])

    assert words(known, added) == words(known) == "SUBSURF levels=3"
