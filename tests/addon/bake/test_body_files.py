"""Save, reopen, press again; and bodies that are missing, damaged or of another shape."""

from __future__ import annotations

import shutil
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from soft_scene import (
    body_of,
    cube,
    error_of,
    layer_names,
    locate,
    part,
    press_down,
    select,
    soft_cube,
    status,
)


@pytest.fixture
def saved(palpate, tmp_path):
    """A soft cube in a saved and reopened file."""
    thing = soft_cube()
    name = thing.name
    unsaved = locate(thing)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "scene.blend"))
    assert not unsaved.exists(), "the body file was left behind in the user's folder"
    bpy.ops.wm.open_mainfile(filepath=str(tmp_path / "scene.blend"))
    return select(bpy.data.objects[name])


def test_save_reopen_press_again(saved, tmp_path):
    assert locate(saved).parent == tmp_path / "palpate"
    assert status(saved).fit.name == "READY"
    press_down(saved)
    assert layer_names(saved) == ["Press 1"]


def test_the_body_goes_along_when_the_file_is_saved_elsewhere(saved, tmp_path):
    (tmp_path / "other").mkdir()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "other" / "copy.blend"))
    assert locate(saved).parent == tmp_path / "other" / "palpate"
    assert (tmp_path / "palpate" / locate(saved).name).is_file()
    press_down(saved)


@pytest.mark.parametrize("by_hand", [True, False], ids=["by Rebuild Body", "by Press itself"])
def test_a_missing_body_file_is_said_and_computed_again_the_same(saved, by_hand):
    key, path = saved.palpate.body_key, locate(saved)
    wanted = part("core.body.body_file").load(path).compliance.table
    path.unlink()
    assert status(saved).fit.name == "FILE_MISSING"
    if by_hand:
        assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    else:
        press_down(saved)
    assert saved.palpate.body_key == key
    assert status(saved).fit.name == "READY"
    assert np.array_equal(part("core.body.body_file").load(locate(saved)).compliance.table, wanted)
    press_down(saved)


@pytest.mark.parametrize("damage", ["truncated", "flipped", "foreign"])
def test_a_damaged_body_file_is_never_used(saved, damage):
    path = locate(saved)
    content = bytearray(path.read_bytes())
    if damage == "truncated":
        path.write_bytes(content[: len(content) // 2])
    elif damage == "flipped":
        content[len(content) // 2] ^= 0x10
        path.write_bytes(content)
    else:
        path.write_text("not a body")
    message = error_of(bpy.ops.palpate.press, at=(0, 0, 0.03), by=(0, 0, -0.005))
    assert path.name in message
    assert layer_names(saved) == []
    assert status(saved).fit.name == "FILE_DAMAGED", "the panel offers no Rebuild Body"
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert status(saved).fit.name == "READY"
    press_down(saved)


def test_tetrahedra_of_another_body_are_not_used_for_a_missing_one(saved):
    locate(saved).unlink()
    nodes = np.array(saved.palpate["nodes"])
    nodes[0] += 1e-4
    del saved.palpate["nodes"]
    saved.palpate["nodes"] = nodes
    message = error_of(bpy.ops.palpate.press, at=(0, 0, 0.03), by=(0, 0, -0.005))
    assert "press Make Soft" in message
    assert locate(saved) is None
    assert layer_names(saved) == []


def test_the_body_of_something_else_under_the_right_name_is_not_used(saved):
    path = locate(saved)
    other = soft_cube(0.06)
    shutil.copyfile(locate(other), path)
    select(saved)
    message = error_of(bpy.ops.palpate.press, at=(0, 0, 0.03), by=(0, 0, -0.005))
    assert "something else" in message


def test_edited_topology_is_said_and_needs_a_bake(saved):
    bpy.ops.object.mode_set(mode="EDIT")
    bpy.ops.mesh.select_all(action="SELECT")
    bpy.ops.mesh.subdivide()
    bpy.ops.object.mode_set(mode="OBJECT")
    assert status(saved).fit.name == "CHANGED"
    assert "26 vertices" in status(saved).text
    for operator in (bpy.ops.palpate.rebuild_body, bpy.ops.palpate.press):
        arguments = {"by": (0.0, 0.0, -0.005)} if operator.idname() == "PALPATE_OT_press" else {}
        assert "Make Soft" in error_of(operator, **arguments)
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert status(saved).fit.name == "READY"


def test_moving_and_turning_needs_no_bake_scaling_does(saved):
    saved.location = (3.0, 2.0, 1.0)
    saved.rotation_euler = (0.1, 0.2, 0.3)
    bpy.context.view_layer.update()
    assert status(saved).fit.name == "READY"
    saved.scale = (1.0, 1.0, 1.01)
    bpy.context.view_layer.update()
    assert status(saved).fit.name == "CHANGED"
    assert "scale" in status(saved).text


def test_the_panel_sees_a_lost_file_and_another_unit_scale_though_no_handler_tells(saved):
    known = part("addon.known_status").body_status
    scene = bpy.context.scene
    assert known(saved, scene).fit.name == "READY"
    scene.unit_settings.scale_length = 0.5
    assert known(saved, scene).fit.name == "CHANGED"
    scene.unit_settings.scale_length = 1.0
    locate(saved).unlink()
    assert known(saved, scene).fit.name == "FILE_MISSING"


class Timers:
    """Blender's timers, which do not fire in the background."""

    def __init__(self):
        self.waiting = []

    def is_registered(self, call):
        return call in self.waiting

    def register(self, call, **_):
        self.waiting.append(call)

    def unregister(self, call):
        self.waiting.remove(call)

    def fire(self):
        for call in list(self.waiting):
            if call() is None:
                self.waiting.remove(call)


@pytest.fixture
def windowed(palpate, monkeypatch):
    """What panels know, as in a Blender with a window, where every mesh is a large one."""
    known, timers = part("addon.known_status"), Timers()
    part("core.machine.machine_speed").dgemm_rate(None)
    known.forget()
    app = SimpleNamespace(background=False, timers=timers)
    monkeypatch.setattr(known, "bpy", SimpleNamespace(app=app, data=bpy.data))
    monkeypatch.setattr(known, "redraw_views", lambda: None)
    monkeypatch.setattr(known, "MOST_AT_ONCE", 0)
    yield known, timers
    known.forget()


def until_known(known, timers, thing, eventually):
    def look():
        timers.fire()
        return not known._asked

    eventually(look, "the mesh is measured")
    return known.body_status(thing, bpy.context.scene)


def geometry_of(thing):
    """A change of the mesh as a dependency graph reports it."""
    update = SimpleNamespace(is_updated_geometry=True, id=SimpleNamespace(original=thing.data))
    return SimpleNamespace(updates=[update])


def test_with_a_window_a_mesh_is_measured_in_the_background(saved, windowed, eventually):
    known, timers = windowed
    scene = bpy.context.scene
    assert known.body_status(saved, scene) is None
    assert known.prediction(saved, scene) is None
    assert len(timers.waiting) == 1
    assert until_known(known, timers, saved, eventually).fit.name == "READY"
    assert known.prediction(saved, scene).cost.nodes > 0
    assert not timers.waiting


def test_a_move_is_no_change_and_an_edit_waits_for_rest(saved, windowed, eventually, monkeypatch):
    known, timers = windowed
    scene = bpy.context.scene
    known.body_status(saved, scene)
    until_known(known, timers, saved, eventually)
    monkeypatch.setattr(known.MeshLook, "take", lambda *_: pytest.fail("the mesh was read"))
    saved.location = (3.0, 2.0, 1.0)
    saved.rotation_euler = (0.1, 0.2, 0.3)
    bpy.context.view_layer.update()
    known.changed(bpy.context.evaluated_depsgraph_get())
    assert known.body_status(saved, scene).fit.name == "READY"
    assert not timers.waiting
    monkeypatch.undo()


def test_older_figures_are_shown_until_there_are_new_ones(saved, windowed, eventually):
    known, timers = windowed
    scene = bpy.context.scene
    known.body_status(saved, scene)
    until_known(known, timers, saved, eventually)
    saved.data.vertices[0].co.x += 0.01
    known.changed(geometry_of(saved))
    for _ in range(2):
        assert known.body_status(saved, scene).fit.name == "READY"
    assert len(timers.waiting) == 1, "one timer waits for the end of the changes"
    assert until_known(known, timers, saved, eventually).fit.name == "CHANGED"


def test_a_change_while_it_is_measured_is_not_lost(saved, windowed, eventually):
    known, timers = windowed
    scene = bpy.context.scene
    known.body_status(saved, scene)
    timers.fire()
    saved.data.vertices[0].co.x += 0.01
    known.changed(geometry_of(saved))
    until_known(known, timers, saved, eventually)
    assert until_known(known, timers, saved, eventually).fit.name == "CHANGED"


def test_a_mesh_that_is_deleted_before_it_is_read_is_let_go(windowed):
    known, timers = windowed
    thing = bpy.context.object
    assert known.prediction(thing, bpy.context.scene) is None
    bpy.data.objects.remove(thing)
    timers.fire()
    assert not known._asked
    assert not timers.waiting


def test_an_object_that_is_not_soft_is_not_read_for_its_status(windowed):
    known, timers = windowed
    assert known.body_status(bpy.context.object, bpy.context.scene).fit.name == "NEVER_BAKED"
    assert not timers.waiting


def test_applying_the_scale_leaves_the_body_valid(palpate):
    thing = cube(1.0)
    thing.scale = (0.05, 0.04, 0.06)
    select(thing)
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    bpy.ops.object.select_all(action="DESELECT")
    thing.select_set(True)
    bpy.ops.object.transform_apply(location=False, rotation=False, scale=True)
    assert status(thing).fit.name == "READY"


def test_pins_and_ratio_changed_later_are_said_and_taken_over_without_tetrahedralization(saved):
    tets = np.array(saved.palpate["tets"])
    key = saved.palpate.body_key
    saved.palpate.poisson_ratio = 0.35
    saved.palpate.pin_fraction = 0.3
    assert status(saved).changed == ("Poisson's Ratio",)
    assert status(saved).pins.fit.name == "MORE"
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert status(saved).changed == ()
    assert np.array_equal(np.array(saved.palpate["tets"]), tets)
    assert saved.palpate.body_key != key
    body = body_of(saved)
    assert body.poisson_ratio == 0.35
    assert body.mesh.nodes[body.fixed, 2].max() > -0.025 + 0.2 * 0.05


@pytest.mark.at_length
def test_another_edge_length_is_said_until_there_are_other_tetrahedra(saved):
    saved.palpate.edge_length = 0.25
    assert status(saved).meshing == ("Edge Length",)
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
    assert status(saved).meshing == ("Edge Length",)
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    assert status(saved).meshing == ()


def test_a_copied_object_brings_its_body(saved):
    copy = saved.copy()
    copy.data = saved.data.copy()
    bpy.context.collection.objects.link(copy)
    select(copy)
    assert status(copy).fit.name == "READY"
    press_down(copy)
    assert layer_names(saved) == []
    assert bpy.ops.palpate.remove_softness() == {"FINISHED"}
    assert locate(saved) is not None, "the file was still needed"


def test_a_body_from_before_minus_zero_was_zero_is_restored(thing):
    store, keys = part("operators.object.body_store"), part("core.body.body_key")
    within = part("operators.object.embedded_body").embedded(thing)
    nodes = within.mesh.nodes.copy()
    nodes.flat[np.abs(nodes).argmin()] = -0.0
    older = keys._digest(
        nodes, within.mesh.tets, within.fixed, 0.3, thing.palpate.baked_formulation, None
    )
    store.locate(thing).unlink()
    del thing.palpate["nodes"]
    thing.palpate["nodes"] = nodes.ravel()
    thing.palpate.baked_poisson_ratio = 0.3
    thing.palpate.body_key = older
    body = store.restore(thing)
    assert body.key == thing.palpate.body_key != older
    assert store.load(thing).key == body.key


def test_only_what_was_written_anew_is_taken_back(saved):
    store, path = part("operators.object.body_store"), locate(saved)
    content, written = path.read_bytes(), store.stamp(saved)
    store.take_back(saved, store.present(), written)
    assert path.exists(), "it was there before"
    store.place_for(saved, saved.palpate.body_key)
    store.take_back(saved, set(), written)
    assert path.exists(), "another one stood there when it was written"
    store._replaced.clear()
    path.unlink()
    path.write_bytes(content)
    store.take_back(saved, set(), written)
    assert path.exists(), "others have put it there since"
    twin = saved.copy()
    bpy.context.scene.collection.objects.link(twin)
    store.take_back(saved, set(), store.stamp(saved))
    assert path.exists(), "another object shares it"
    bpy.data.objects.remove(twin)
    store.take_back(saved, {path.parent}, store.stamp(saved))
    assert not path.exists()
