"""Files of baked animations: each object of each .blend has its own, and none is lost."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest
from pressed_scene import tapped_by_ball
from soft_scene import seen_places, select

KINDS = ["CACHE", "ALEMBIC"]


@pytest.fixture
def shot(palpate, tmp_path):
    """A cube that a ball taps, in a saved file."""
    thing = tapped_by_ball()
    thing.name = "Soft"
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot1.blend"))
    return thing


def bake(thing, keep="CACHE"):
    """Bake, and where the file is."""
    select(thing)
    given = {"frame_start": 1, "frame_end": 4, "keep": keep}
    assert bpy.ops.palpate.press_frames(**given) == {"FINISHED"}
    return file_of(thing)


def file_of(thing):
    modifier = thing.modifiers["Palpate Animation"]
    path = getattr(modifier, "cache_file", modifier).filepath
    return Path(bpy.path.abspath(path))


def dent(thing):
    """Coordinates in the frame in which the ball is deepest."""
    bpy.context.scene.frame_set(4)
    return seen_places(thing)


@pytest.mark.parametrize("keep", KINDS)
def test_another_file_of_the_folder_keeps_its_animation(shot, tmp_path, keep):
    first = bake(shot, keep)
    kept = first.read_bytes()
    bpy.ops.wm.save_mainfile()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "shot2.blend"))
    bpy.data.objects["Ball"].scale = (1.3, 1.3, 1.3)
    second = bake(shot, keep)
    assert second != first
    assert first.read_bytes() == kept
    assert second.read_bytes() != kept
    # Its own it replaces.
    assert bake(shot, keep) == second


def test_a_new_object_of_an_old_name_leaves_the_other_s_file(shot):
    first = bake(shot)
    kept = first.read_bytes()
    shot.name = "Old"
    other = shot.copy()
    other.data, other.name = shot.data.copy(), "Soft"
    bpy.context.collection.objects.link(other)
    # The copy plays the same file, which neither may replace now.
    files = {bake(other), bake(shot), first}
    assert len(files) == 3
    assert first.read_bytes() == kept
    other.modifiers.clear()
    assert bake(other) not in files


def test_names_that_become_the_same_word_have_files_of_their_own(shot):
    shot.name = "Soft_001"
    other = shot.copy()
    other.data, other.name = shot.data.copy(), "Soft.001"
    bpy.context.collection.objects.link(other)
    bpy.data.objects["Ball"].scale = (1.3, 1.3, 1.3)
    first = bake(other)
    seen = dent(other)
    bpy.data.objects["Ball"].scale = (1.0, 1.0, 1.0)
    assert bake(shot) != first
    np.testing.assert_array_equal(dent(other), seen)
    assert np.abs(dent(shot) - seen).max() > 1e-5
