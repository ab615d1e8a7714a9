"""Animations that are baked before there is a .blend: saving takes them along."""

from __future__ import annotations

from pathlib import Path

import bpy
import numpy as np
import pytest
from pressed_scene import tapped_by_ball
from soft_scene import opens_usd, seen_places, select

KINDS = ["ALEMBIC", "CACHE", pytest.param("USD", marks=opens_usd)]


@pytest.fixture
def baked(palpate, request):
    """A cube that plays an animation in a file that was never saved."""
    thing, scene = select(tapped_by_ball()), bpy.context.scene
    scene.frame_start, scene.frame_end = 1, 4
    assert bpy.ops.palpate.press_frames(keep=request.param) == {"FINISHED"}
    return thing


def dent(thing):
    """Places in the deepest frame."""
    bpy.context.scene.frame_set(1)
    bpy.context.scene.frame_set(4)
    return seen_places(thing)


def played(thing):
    """The path of the file that an object plays, as it is stored, which each system reads in its
    own way of writing.
    """
    modifier = thing.modifiers["Palpate Animation"]
    return getattr(modifier, "cache_file", modifier).filepath.replace("\\", "/")


def is_temporary(thing):
    return Path(bpy.path.abspath(played(thing))).is_relative_to(bpy.app.tempdir)


def opened(blend):
    """What the object of a file plays, opened anew."""
    bpy.ops.wm.open_mainfile(filepath=str(blend))
    (thing,) = (one for one in bpy.data.objects if one.modifiers)
    return thing


@pytest.mark.parametrize("baked", KINDS, indirect=True)
def test_the_first_save_takes_the_file_along(baked, tmp_path):
    seen = dent(baked)
    bpy.context.scene.frame_set(1)
    assert np.abs(seen - seen_places(baked)).max() > 1e-4
    assert is_temporary(baked)
    blend = tmp_path / "shot.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    assert played(baked).startswith("//palpate/shot-")
    np.testing.assert_array_equal(dent(baked), seen)
    moved = tmp_path / "moved"
    moved.mkdir()
    for one in ("palpate", "shot.blend"):
        (tmp_path / one).rename(moved / one)
    np.testing.assert_array_equal(dent(opened(moved / "shot.blend")), seen)


@pytest.mark.parametrize("baked", KINDS, indirect=True)
def test_a_saved_copy_plays_and_the_open_file_goes_on(baked, tmp_path):
    seen = dent(baked)
    blend = tmp_path / "copy.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(blend), copy=True)
    assert not bpy.data.filepath
    assert is_temporary(baked)
    np.testing.assert_array_equal(dent(baked), seen)
    assert played(opened(blend)).startswith("//palpate/copy-")
    np.testing.assert_array_equal(dent(opened(blend)), seen)


@pytest.mark.parametrize("baked", ["CACHE"], indirect=True)
def test_a_save_that_fails_changes_nothing(baked, tmp_path):
    seen = dent(baked)
    blend = tmp_path / "taken.blend"
    blend.mkdir()
    with pytest.raises(RuntimeError):
        bpy.ops.wm.save_as_mainfile(filepath=str(blend))
    assert is_temporary(baked)
    np.testing.assert_array_equal(dent(baked), seen)


@pytest.mark.parametrize("baked", ["CACHE"], indirect=True)
def test_a_second_bake_takes_the_place_of_the_first(baked):
    first = played(baked)
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    assert played(baked) == first
