"""Objects that operators act on for a while, without an override of the context."""

import threading

import bpy
import pytest
from soft_scene import cube, part, select

pytestmark = pytest.mark.usefixtures("palpate")


@pytest.fixture
def chosen_alone():
    return part("operators.scene.active_object").chosen_alone


def test_what_was_active_and_selected_is_so_again(chosen_alone):
    first, second = select(cube()), cube()
    second.select_set(True)
    select(first)
    with chosen_alone(second):
        assert bpy.context.object == second
        assert bpy.context.selected_objects == [second]
    assert bpy.context.object == first
    assert second in bpy.context.selected_objects


def test_so_they_are_after_an_error(chosen_alone):
    first, second = select(cube()), cube()
    select(first)
    with pytest.raises(RuntimeError, match="poll"), chosen_alone(second):
        bpy.ops.mesh.delete()
    assert bpy.context.object == first


def test_nothing_active_is_so_again(chosen_alone):
    thing = cube()
    thing.select_set(False)
    bpy.context.view_layer.objects.active = None
    with chosen_alone(thing):
        assert bpy.context.object == thing
    assert bpy.context.object is None
    assert not bpy.context.selected_objects


def test_what_is_in_no_view_layer_is_refused_and_nothing_is_changed(chosen_alone):
    thing = select(cube())
    apart = bpy.data.objects.new("Apart", thing.data)
    with pytest.raises(RuntimeError), chosen_alone(apart):
        pass
    assert bpy.context.object == thing
    assert thing in bpy.context.selected_objects


def test_operators_act_on_it_while_another_thread_works(chosen_alone):
    """Under an override of the context Blender 5.0 crashes here, most times."""
    ended = threading.Event()

    def work():
        while not ended.is_set():
            _ = {str(i): [i] for i in range(200)}

    thread = threading.Thread(target=work)
    thread.start()
    thing = cube()
    try:
        for _ in range(200):
            with chosen_alone(thing):
                bpy.ops.object.mode_set(mode="EDIT")
                bpy.ops.object.mode_set(mode="OBJECT")
    finally:
        ended.set()
        thread.join()
    assert thing.mode == "OBJECT"
