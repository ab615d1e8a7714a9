"""The headless command, called as Blender calls it."""

from __future__ import annotations

import json

import bpy
import pytest
from soft_scene import body_of, cube, empty, part, seen_places


@pytest.fixture
def scene(palpate, tmp_path):
    """A saved file with a cube that is not soft yet."""
    cube().name = "Prop"
    path = tmp_path / "scene.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    return path


@pytest.fixture
def command(scene):
    """Run a line in which {scene} stands for the scene's path."""
    return lambda line: part("addon.command").run(
        [word.format(scene=scene) for word in line.split()]
    )


@pytest.fixture
def figures_of(command, capfd):
    """Run a line that succeeds and return its figures."""

    def run(line):
        assert command(f"{line} --json") == 0
        return json.loads(capfd.readouterr().out.splitlines()[-1])

    return run


PRESS = "press {scene} --object Prop --at 0 0 0.025 --by 0 0 -5e-3"


def test_bake_saves_a_file_that_can_be_pressed(figures_of, scene):
    figures = figures_of("bake {scene} --object Prop --edge-length 0.2")
    assert figures["nodes"] > figures["free_surface_nodes"] > 0
    assert len(list((scene.parent / "palpate").iterdir())) == 1
    bent = figures_of(PRESS)
    assert figures_of(f"{PRESS} --shape rotation-strain")["force"] == bent["force"]
    pressed = figures_of(f"{PRESS} --keep --shape linear")
    # The fibres of plush stiffen.
    assert 0 < pressed["force"][2] < bent["force"][2] < 1.5 * pressed["force"][2]
    assert pressed["force"][2] != bent["force"][2]
    assert (bent["shape"], pressed["shape"]) == ("real", "linear")
    assert bent["max_displacement"] != pressed["max_displacement"]
    bpy.ops.wm.open_mainfile(filepath=str(scene))
    assert bpy.data.objects["Prop"].modifiers.keys() == [pressed["layer"]] == ["Press 1"]


def test_an_animation_is_baked_by_a_process_of_its_own(figures_of, command, scene, capfd):
    figures_of("bake {scene} --object Prop --edge-length 0.2")
    line = "animate {scene} --object Prop --frame-end 3"
    assert command(line) == 2
    assert "Prop: " in capfd.readouterr().err
    bpy.ops.wm.open_mainfile(filepath=str(scene))
    settings = bpy.context.scene.palpate
    settings.tip, settings.tip_radius = "SPHERE", 0.02
    settings.source, settings.source_empty = "EMPTY", empty()
    for frame, height in ((1, 0.05), (3, 0.042)):
        settings.source_empty.location.z = height
        settings.source_empty.keyframe_insert("location", frame=frame)
    bpy.ops.wm.save_mainfile()
    figures = figures_of(f"{line} --forces //forces.csv")
    assert figures["modifiers"] == ["Palpate Animation"]
    assert len((scene.parent / "forces.csv").read_text().splitlines()) == 1 + 3
    bpy.ops.wm.open_mainfile(filepath=str(scene))
    heights = []
    for frame in (1, 3):
        bpy.context.scene.frame_set(frame)
        heights.append(seen_places(bpy.data.objects["Prop"])[:, 2].max())
    assert heights[1] < heights[0] - 5e-5


def test_form_formulation_and_stiff_region_are_chosen_by_options(figures_of, scene):
    bpy.ops.wm.open_mainfile(filepath=str(scene))
    prop = bpy.data.objects["Prop"]
    prop.vertex_groups.new(name="Hard").add(range(8), 1.0, "REPLACE")
    bpy.ops.wm.save_mainfile()
    figures = figures_of(
        "bake {scene} --object Prop --edge-length 0.1 --formulation smoothed --form compressed"
        " --tolerance 0.02 --stiff-group Hard --stiff-factor 5"
    )
    assert (figures["formulation"], figures["form"]) == ("smoothed", "compressed")
    assert 0 < figures["column_error"] <= 0.02
    baked = bpy.data.objects["Prop"].palpate
    assert baked.baked_formulation == "smoothed"
    assert baked.column_error <= 2.0
    scale = body_of(bpy.data.objects["Prop"]).young_scale
    assert scale.max() == pytest.approx(5.0, rel=1e-5)
    assert figures_of(PRESS)["force"][2] > 0


def test_a_bake_whose_scene_cannot_be_saved_leaves_no_body(command, scene, capfd):
    # Blender writes beside the file first, under this name.
    (scene.parent / f"{scene.name}@").mkdir()
    before = sorted(scene.parent.iterdir())
    content = scene.read_bytes()
    assert command("bake {scene} --object Prop --edge-length 0.2") == 2
    assert "cannot save" in capfd.readouterr().err
    assert scene.read_bytes() == content
    assert sorted(scene.parent.iterdir()) == before


@pytest.mark.parametrize(("tolerance", "percent"), [(1e-5, 0.001), (0.05, 5.0)])
def test_the_ends_of_a_range_belong_to_it(palpate, tolerance, percent):
    within = part("addon.command_options").within
    settings = bpy.context.object.palpate
    found = within(settings, "compression_tolerance", "tolerance", tolerance, 0.01)
    assert found == pytest.approx(percent)


@pytest.mark.parametrize(
    ("line", "reason"),
    [
        ("bake /nowhere.blend --object Prop", "no such file"),
        ("bake {scene} --object Nobody", "Prop"),
        ("bake {scene} --object Prop --poisson 0.7", "out of range"),
        ("bake {scene} --object Prop --tolerance 0.5", "to 0.05"),
        ("bake {scene} --object Prop --form tiny", "compressed"),
        ("bake {scene} --object Prop --stiff-factor 5", "--stiff-group"),
        ("bake {scene} --object Prop --stiff-group None", "vertex group"),
        ("bake {scene} --object Prop --pin-group None", "vertex group"),
        ("press {scene} --object Prop --at 0 0 0 --by 0 0 1", "not soft"),
        ("press {scene} --object Prop", "--at"),
        ("squeeze", "squeeze"),
    ],
)
def test_errors_are_one_line_and_leave_nothing(command, scene, capfd, line, reason):
    before = scene.read_bytes()
    assert command(line) == 2
    lines = [line for line in capfd.readouterr().err.splitlines() if line.startswith("palpate: ")]
    assert len(lines) == 1
    assert reason in lines[0]
    assert scene.read_bytes() == before
    assert [path.name for path in scene.parent.iterdir()] == [scene.name]
