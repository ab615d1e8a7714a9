"""Animated tools, pressed frame by frame: what is kept plays by itself."""

from __future__ import annotations

import csv

import bpy
import numpy as np
import pytest
from soft_scene import (
    empty,
    error_of,
    key_coordinates,
    key_names,
    layer_names,
    mesh_state,
    part,
    seen_places,
    soft_cube,
)


@pytest.fixture
def chosen(palpate):
    """The scene's settings, with a fingertip so large that few contact points suffice."""
    settings = bpy.context.scene.palpate
    settings.tip_radius = 0.02
    return settings


@pytest.fixture
def tapped(chosen, tmp_path):
    """A cube that a fingertip goes into and out of within the frames 1 to 7, in a saved file."""
    thing, guide, scene = soft_cube(), empty(), bpy.context.scene
    for frame, height in ((1, 0.05), (4, 0.042), (7, 0.05)):
        guide.location.z = height
        guide.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, 7
    scene.frame_set(2)
    chosen.tip, chosen.source, chosen.source_empty = "SPHERE", "EMPTY", guide
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "tapped.blend"))
    return thing


def frames_of(thing, scene, frames):
    """Coordinates (p, 3) of each frame, pressed by a script."""
    pressed, opened = (
        part("operators.animation.frames.pressed_frames"),
        part("operators.object.drawn_body").open_body(thing, scene),
    )
    with part("operators.shape.drawn_shape").closing_shape(thing, opened) as shape:
        return [
            here.coordinates(opened).reshape(-1, 3).copy()
            for here in pressed.press_frames(
                scene, frames, pressed.AnimatedPress(thing, opened, shape)
            )
        ]


def test_a_cache_plays_every_frame_without_a_shape_key(tapped):
    scene, rest = bpy.context.scene, mesh_state(tapped)
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    assert scene.frame_current == 2
    assert mesh_state(tapped) == rest
    assert key_names(tapped) == []
    modifier = tapped.modifiers[0]
    assert modifier.type == "MESH_CACHE"
    assert modifier.filepath.startswith("//palpate/")
    frames = list(range(1, 8))
    wanted = frames_of(tapped, scene, frames)
    assert np.abs(wanted[3] - wanted[0]).max() > 1e-4
    # Scrubbed in any order.
    for frame in (4, 1, 6, 3, 7, 2, 5):
        scene.frame_set(frame)
        np.testing.assert_allclose(seen_places(tapped), wanted[frame - 1], rtol=0, atol=1e-7)
    # A second bake takes the place of the first.
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    assert [one.type for one in tapped.modifiers] == ["MESH_CACHE"]


def test_a_coarser_cache_goes_straight_between_its_frames(tapped):
    scene = bpy.context.scene
    assert bpy.ops.palpate.press_frames(step=3) == {"FINISHED"}
    wanted = frames_of(tapped, scene, [1, 4, 7])
    for frame, share in ((1, 0.0), (2, 1 / 3), (4, 1.0)):
        scene.frame_set(frame)
        expected = (1 - share) * wanted[0] + share * wanted[1]
        np.testing.assert_allclose(seen_places(tapped), expected, rtol=0, atol=1e-7)


def test_forces_are_written_as_a_table(tapped, tmp_path):
    table = tmp_path / "forces.csv"
    assert bpy.ops.palpate.press_frames(forces=str(table)) == {"FINISHED"}
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [int(row["frame"]) for row in rows] == list(range(1, 8))
    forces = [float(row["force_N"]) for row in rows]
    assert forces[0] == 0.0
    assert max(forces) == forces[3]
    assert forces[2] == pytest.approx(forces[4], rel=0.02)
    assert float(rows[3]["force_z_N"]) > 0.9 * forces[3]
    assert 0.0 < float(rows[3]["area_m2"]) < 0.05**2
    seconds = 4 / bpy.context.scene.render.fps
    assert float(rows[3]["seconds"]) == pytest.approx(seconds)


def test_the_table_agrees_with_the_pressure_and_the_geometry(tapped, tmp_path):
    table, scene = tmp_path / "forces.csv", bpy.context.scene
    assert bpy.ops.palpate.press_frames(forces=str(table)) == {"FINISHED"}
    with table.open(newline="") as file:
        rows = list(csv.DictReader(file))
    opened = part("operators.object.drawn_body").open_body(tapped, scene)
    pressed = part("operators.animation.frames.pressed_frames")
    with part("operators.shape.drawn_shape").closing_shape(tapped, opened) as shape:
        frames = list(
            pressed.press_frames(scene, range(1, 8), pressed.AnimatedPress(tapped, opened, shape))
        )
    touched = 0
    for row, here in zip(rows, frames, strict=True):
        (touch,) = here.fingers
        force = np.array([float(row[f"force_{axis}_N"]) for axis in "xyz"])
        # Without friction the force is the sum of pressure, area and normal.
        spread = -((touch.pressures * touch.areas)[:, None] * touch.normals).sum(axis=0)
        np.testing.assert_allclose(force, spread, rtol=1e-6, atol=1e-9)
        assert float(row["area_m2"]) == pytest.approx(touch.areas.sum(), rel=1e-6)
        largest = touch.pressures.max(initial=0.0)
        assert float(row["largest_pressure_Pa"]) == pytest.approx(largest, rel=1e-6)
        # And the depth is how far the ball is below the flat top.
        depth = 0.025 - (touch.pose.position[2] - touch.tool.radius) if touch.touching else 0.0
        # Its force leans a little, as the tetrahedra do.
        assert float(row["depth_m"]) == pytest.approx(depth, rel=0.03, abs=1e-6)
        touched += touch.touching
    assert 0 < touched < len(rows)


def test_nothing_is_left_of_a_bake_that_is_ended(tapped, tmp_path, monkeypatch):
    folder = part("operators.object.body_store").folder_for_new_files()
    frames = part("operators.animation.all_frames")
    original = frames.press_frames

    def breaking(*arguments):
        for number, here in enumerate(original(*arguments)):
            if number == 3:
                raise part("core.errors").PalpateError("The line is down")
            yield here

    monkeypatch.setattr(frames, "press_frames", breaking)
    assert "The line is down" in error_of(bpy.ops.palpate.press_frames)
    assert not tapped.modifiers
    assert not list(folder.glob("*-animation*"))
    assert bpy.context.scene.frame_current == 2


def test_a_foreign_file_of_the_cache_s_name_is_left_alone(tapped):
    name = f"tapped-{bpy.path.clean_name(tapped.name)}-animation.pc2"
    place = part("operators.object.body_store").folder_for_new_files() / name
    place.parent.mkdir(exist_ok=True)
    place.write_bytes(b"POINTCACHE2\0 of somebody else")
    assert bpy.ops.palpate.press_frames() == {"FINISHED"}
    assert place.read_bytes() == b"POINTCACHE2\0 of somebody else"
    assert tapped.modifiers[0].filepath.endswith("-animation-2.pc2")


def test_an_animated_tool_leaves_a_shape_key_in_every_frame_it_touches(chosen):
    thing, guide = soft_cube(), empty()
    scene = bpy.context.scene
    for frame, height in ((1, 0.05), (4, 0.042), (7, 0.05)):
        guide.location.z = height
        guide.keyframe_insert("location", frame=frame)
    scene.frame_start, scene.frame_end = 1, 7
    scene.frame_set(2)
    chosen.tip, chosen.source, chosen.source_empty = "SPHERE", "EMPTY", guide
    assert bpy.ops.palpate.press_frames(keep="KEYS") == {"FINISHED"}
    assert scene.frame_current == 2
    names = key_names(thing)
    assert "Press at 4" in names
    assert "Press at 1" not in names
    keys = thing.data.shape_keys.key_blocks
    scene.frame_set(4)
    assert keys["Press at 4"].value == pytest.approx(1.0)
    scene.frame_set(1)
    assert sum(key.value for key in keys if key.name.startswith("Press at")) == 0.0
    deepest = key_coordinates(thing, "Press at 4") - key_coordinates(thing, "Basis")
    assert deepest[:, 2].min() < -1e-4
    assert bpy.ops.palpate.press_frames(keep="KEYS") == {"FINISHED"}
    assert key_names(thing) == names


def test_the_current_frame_alone_is_kept_as_a_press(chosen):
    thing, guide = soft_cube(), empty(at=(0.0, 0.0, 0.05))
    scene = bpy.context.scene
    guide.keyframe_insert("location", frame=1)
    guide.location.z = 0.042
    guide.keyframe_insert("location", frame=5)
    scene.frame_start = 1
    scene.frame_set(5)
    chosen.tip, chosen.source, chosen.source_empty = "SPHERE", "EMPTY", guide
    assert bpy.ops.palpate.press_frames(current_only=True) == {"FINISHED"}
    assert layer_names(thing) == ["Press 1"]


def test_animations_without_a_tool_or_a_leader_are_refused(chosen, tmp_path):
    thing, guide = soft_cube(), empty()
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "refused.blend"))
    assert "choose Fingertip" in error_of(bpy.ops.palpate.press_frames)
    chosen.tip = "SPHERE"
    assert "nothing leads the tool" in error_of(bpy.ops.palpate.press_frames)
    chosen.source, chosen.source_empty = "EMPTY", guide
    bpy.context.scene.frame_end = 2
    assert "touches nothing" in error_of(bpy.ops.palpate.press_frames)
    chosen.second, chosen.second_empty = "EMPTY", guide
    assert "both fingers" in error_of(bpy.ops.palpate.press_frames)
    assert key_names(thing) == []


def test_shape_keys_that_others_would_play_too_are_refused(tapped):
    twin = tapped.copy()
    bpy.context.collection.objects.link(twin)
    assert "Single User" in error_of(bpy.ops.palpate.press_frames, keep="KEYS")
    assert key_names(tapped) == []
    assert bpy.ops.palpate.press_frames(keep="CACHE") == {"FINISHED"}
