"""Baked animations as Alembic and USD, read again by Blender."""

from __future__ import annotations

import bpy
import numpy as np
import pytest
from soft_scene import (
    empty,
    error_of,
    key_names,
    mesh_state,
    opens_usd,
    part,
    seen_places,
    soft_cube,
)
from without_palpate import without_palpate

KINDS = {"ALEMBIC": ".abc", "USD": ".usdc"}
OF_EACH = ["ALEMBIC", pytest.param("USD", marks=opens_usd)]


@pytest.fixture
def tapped(palpate, tmp_path):
    """A cube, turned and moved, that a fingertip goes into and out of within the frames 3 to 9."""
    thing, guide, scene = soft_cube(), empty(), bpy.context.scene
    for frame, height in ((3, 0.05), (6, 0.042), (9, 0.05)):
        guide.location.z = height
        guide.keyframe_insert("location", frame=frame)
    guide.parent = thing
    thing.location, thing.rotation_euler = (1.0, -2.0, 0.5), (0.4, -0.2, 1.0)
    scene.frame_start, scene.frame_end = 3, 9
    scene.frame_set(4)
    chosen = scene.palpate
    chosen.tip_radius = 0.02
    chosen.tip, chosen.source, chosen.source_empty = "SPHERE", "EMPTY", guide
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "tapped.blend"))
    return thing


def of_cache(thing):
    """Places of each frame as a point cache plays them."""
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    return {frame: at(thing, frame) for frame in range(3, 10)}


def at(thing, frame):
    bpy.context.scene.frame_set(frame)
    return seen_places(thing)


def around(thing):
    """What else there is in the file, and what is chosen of it."""
    return (
        sorted(bpy.data.objects.keys()),
        sorted(bpy.data.meshes.keys()),
        [one.name for one in bpy.context.selected_objects],
        bpy.context.object.name,
        mesh_state(thing),
    )


@pytest.mark.parametrize("kind", OF_EACH)
def test_a_file_plays_every_frame_also_without_palpate(tapped, kind, tmp_path):
    scene, wanted = bpy.context.scene, of_cache(tapped)
    scene.frame_set(4)
    before, folder = around(tapped), part("operators.object.body_store").folder_for_new_files()
    assert bpy.ops.palpate.press_frames(keep=kind) == {"FINISHED"}
    assert around(tapped) == before
    assert (scene.frame_current, scene.frame_start, scene.frame_end) == (4, 3, 9)
    assert [one.type for one in tapped.modifiers] == ["MESH_SEQUENCE_CACHE"]
    assert len(list(folder.glob(f"*-animation{KINDS[kind]}"))) == 1
    assert np.abs(wanted[6] - wanted[3]).max() > 1e-4
    for frame in (6, 3, 8, 4, 9, 7, 5):
        np.testing.assert_allclose(at(tapped, frame), wanted[frame], rtol=0, atol=1e-6)
    scene.frame_set(6)
    alone = without_palpate(tmp_path)[tapped.name]
    np.testing.assert_allclose(alone, wanted[6], rtol=0, atol=1e-6)


@pytest.mark.parametrize("kind", OF_EACH)
def test_a_second_bake_takes_the_place_of_the_first(tapped, kind):
    for _ in range(2):
        assert bpy.ops.palpate.press_frames(keep=kind) == {"FINISHED"}
    assert [one.name for one in tapped.modifiers] == ["Palpate Animation"]
    assert len(bpy.data.cache_files) == 1
    path = bpy.data.cache_files[0].filepath
    assert path.startswith("//")
    assert path.endswith(f"-animation{KINDS[kind]}")
    # Of another kind it takes its place too.
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    assert [one.type for one in tapped.modifiers] == ["MESH_CACHE"]


def test_a_file_that_blender_does_not_open_is_told(tapped, monkeypatch):
    wanted = of_cache(tapped)[6]
    files = part("operators.animation.exchange_file")

    def written(twin, scene, size, made, kind):
        made.write_bytes(b"nonsense")

    monkeypatch.setattr(files, "_export", written)
    before = around(tapped)
    message = error_of(bpy.ops.palpate.press_frames, keep="USD")
    assert "-animation.usdc" in message
    assert "Body Folder" in message
    assert around(tapped) == before
    assert not bpy.data.cache_files
    np.testing.assert_array_equal(at(tapped, 6), wanted)


@pytest.mark.parametrize("kind", OF_EACH)
def test_a_coarser_file_goes_straight_between_its_frames(tapped, kind):
    wanted = of_cache(tapped)
    assert bpy.ops.palpate.press_frames(keep=kind, step=3) == {"FINISHED"}
    for frame, share in ((3, 0.0), (4, 1 / 3), (6, 1.0)):
        expected = (1 - share) * wanted[3] + share * wanted[6]
        np.testing.assert_allclose(at(tapped, frame), expected, rtol=0, atol=1e-6)


def test_nothing_is_left_of_one_that_is_ended(tapped, monkeypatch):
    keeping, before = part("operators.animation.keeping"), around(tapped)
    folder = part("operators.object.body_store").folder_for_new_files()
    made = []

    class Noted(keeping.ScratchFolder):
        def __init__(self, word):
            super().__init__(word)
            made.append(self.path)

    monkeypatch.setattr(keeping, "ScratchFolder", Noted)

    def failing(*_, **__):
        raise part("core.errors").PalpateError("The disk is full")

    monkeypatch.setattr(part("operators.animation.exchange_file"), "_export", failing)
    assert "The disk is full" in error_of(bpy.ops.palpate.press_frames, keep="ALEMBIC")
    assert around(tapped) == before
    assert made
    assert not made[0].exists()
    assert not list(folder.glob("*-animation*"))
    assert not bpy.data.cache_files
    assert key_names(tapped) == []


def test_a_file_of_somebody_else_is_left_alone(tapped):
    name = f"tapped-{bpy.path.clean_name(tapped.name)}-animation.abc"
    place = part("operators.object.body_store").folder_for_new_files() / name
    place.parent.mkdir(exist_ok=True)
    place.write_bytes(b"of somebody else")
    assert bpy.ops.palpate.press_frames(keep="ALEMBIC") == {"FINISHED"}
    assert place.read_bytes() == b"of somebody else"
    assert bpy.data.cache_files[0].filepath.endswith("-animation-2.abc")


@opens_usd
def test_a_file_plays_places_alone_where_nobody_asked_for_forces(tapped):
    assert bpy.ops.palpate.press_frames(keep="USD") == {"FINISHED"}
    at(tapped, 6)
    seen = tapped.evaluated_get(bpy.context.evaluated_depsgraph_get()).data
    assert "palpate_pressure" not in seen.attributes
