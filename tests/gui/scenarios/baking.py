"""What the panel says of bakes: before, during and after, at the width a sidebar has."""

from __future__ import annotations

import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import bpy
from mathutils import Vector
from mouse_scene import depth, drag_in, end_press, mouse, open_mouse, start_press, type_key
from shown import all_panels_open, replaced
from stage import Stage, Wait, at_length

from bl_ext.user_default.palpate.addon import known_status
from bl_ext.user_default.palpate.addon.panels import base, sentence
from bl_ext.user_default.palpate.operators.bake import bake_prediction, bake_session, bake_words
from bl_ext.user_default.palpate.operators.object import body_store
from bl_ext.user_default.palpate.operators.session import press_session

GIGABYTE = 1_000_000_000


def the_panel_predicts_a_bake_and_follows_its_settings(stage: Stage) -> Wait:
    with all_panels_open(), _rows_shown() as rows:
        yield from open_mouse(stage)
        yield from stage.until(lambda: "Peak Memory" in rows, "the prediction")
        yield from stage.picture("predicted")
        coarse = dict(rows)
        mouse().palpate.edge_length /= 2
        yield
        yield from stage.until(lambda: rows["Nodes"] != coarse["Nodes"], "other nodes")
        assert float(rows["Nodes"].replace(",", "")) > float(coarse["Nodes"].replace(",", ""))
        mouse().palpate.form = "COMPRESSED"
        mouse().palpate.poisson_ratio = 0.49
        yield
        yield from stage.until(lambda: rows["Compliance"] == "Compressed", "the other form")
        yield from stage.picture("finer")


def too_little_memory_is_said_and_one_click_fits_it(stage: Stage) -> Wait:
    with all_panels_open(), _little_memory(GIGABYTE), _said() as said:
        yield from open_mouse(stage)
        bpy.ops.palpate.remove_softness()
        mouse().palpate.edge_length = 0.012
        yield
        yield from stage.until(partial(_any_has, said, "free"), "the alarm")
        yield from stage.picture("alarm")
        before = mouse().palpate.edge_length
        bpy.ops.palpate.fit_memory(by="COARSER")
        assert mouse().palpate.edge_length > before
        assert known_status.prediction(mouse(), bpy.context.scene).fits
        yield from stage.picture("coarser")


@at_length
def the_panel_says_which_pins_need_no_bake(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    # What earlier runs computed would be known.
    shutil.rmtree(body_store.folder_for_new_files(), ignore_errors=True)
    yield from start_press(stage)
    yield from type_key(stage, "ESC")
    yield from stage.until(lambda: press_session.current() is None, "the body's file")
    with _said() as said:
        mouse().palpate.pin_mode, mouse().palpate.pin_fraction = "BELOW", 0.08
        yield
        yield from stage.until(partial(_any_has, said, "More is pinned"), "the first text")
        yield from stage.picture("more")
        for fraction, words in ((0.12, "More"), (0.08, "computed before"), (0.04, "Less")):
            bpy.ops.palpate.update_pins()
            said.clear()
            mouse().palpate.pin_fraction = fraction
            yield
            yield from stage.until(partial(_any_has, said, words), f"'{words}'")
            yield from stage.picture(f"{100 * fraction:.0f}-percent")


@at_length
def a_compressed_body_is_pressed_like_any_other(stage: Stage) -> Wait:
    with all_panels_open(), _times_left() as left:
        yield from open_mouse(stage)
        # As small a body does not compress to less.
        mouse().palpate.form, mouse().palpate.compression_tolerance = "COMPRESSED", 2.0
        with stage.view():
            bpy.ops.palpate.rebuild_body("INVOKE_DEFAULT")
        yield from stage.until(lambda: left, "the remaining time")
        yield from stage.picture("remaining")
        yield from stage.until(lambda: bake_session.current() is None, "the bake")
        assert mouse().palpate.baked_form == "compressed"
        yield from stage.picture("baked")
    yield from start_press(stage)
    yield from drag_in(stage)
    assert depth() > 0.005
    yield from stage.picture("pressed")
    yield from end_press(stage)


def escape_ends_the_bake_and_its_process_while_the_stiffness_is_inverted(stage: Stage) -> Wait:
    yield from open_mouse(stage)
    with stage.view():
        bpy.ops.palpate.rebuild_body("INVOKE_DEFAULT")
    child = bake_session.current().job._child.pid
    yield from stage.until(
        lambda: bake_session.current().progress.step != "start", "the child's first step"
    )
    yield from type_key(stage, "ESC")
    yield from stage.until(lambda: not Path(f"/proc/{child}").exists(), "the end of the process")
    assert bake_session.current() is None


def _any_has(said: list[str], words: str) -> bool:
    return any(words in text for text in said)


@contextmanager
def _rows_shown() -> Iterator[dict[str, str]]:
    """Names and values of the figures that the panel draws."""
    shown: dict[str, str] = {}
    original = base.draw_rows

    def draw(layout: bpy.types.UILayout, rows: list[tuple[str, str]]) -> None:
        if any(name == "Peak Memory" for name, _ in rows):
            shown.update(rows)
        original(layout, rows)

    with replaced(base, "draw_rows", draw):
        yield shown


@contextmanager
def _said() -> Iterator[list[str]]:
    """The sentences that the panel draws."""
    said: list[str] = []
    original = sentence.wrapped

    def wrapped(text: str, letters: int) -> list[str]:
        said.append(text)
        return original(text, letters)

    with replaced(sentence, "wrapped", wrapped):
        yield said


@contextmanager
def _times_left() -> Iterator[list[str]]:
    """What the panel has said of the time that is left."""
    left: list[str] = []
    original = bake_words.how_far

    def how_far(progress: object) -> str:
        text = original(progress)
        if "left" in text:
            left.append(text)
        return text

    with replaced(bake_words, "how_far", how_far):
        yield left


@contextmanager
def _little_memory(available: int) -> Iterator[None]:
    with replaced(bake_prediction, "available_memory", lambda: available):
        yield


@at_length
def a_coarse_body_is_pressed_while_the_fine_one_is_baked(stage: Stage) -> Wait:
    bpy.ops.object.delete()
    bpy.ops.mesh.primitive_monkey_add(size=0.1)
    bpy.ops.object.shade_smooth()
    with stage.view():
        bpy.ops.view3d.view_selected()
    yield from stage.open_sidebar("Palpate")
    name, begun = bpy.context.object.name, time.monotonic()
    with stage.view():
        bpy.ops.palpate.make_soft("INVOKE_DEFAULT")
    yield from stage.until(lambda: bake_session.current().preview_off, "the preview")
    stage.note(seconds_to_the_preview=time.monotonic() - begun)
    yield from stage.picture("previewed")
    with stage.view():
        bpy.ops.palpate.stroke(
            place=bpy.data.objects[name].matrix_world @ Vector((0, -0.04, 0)), depth=0.01
        )
    assert bpy.data.objects[name].palpate.preview_off > 0.0
    yield from stage.until(lambda: bake_session.current() is None, "the fine body")
    stage.note(seconds_to_the_body=time.monotonic() - begun)
    thing = bpy.data.objects[name]
    assert thing.palpate.preview_off == 0.0
    assert thing.modifiers[-1].name == "Press 1"
    yield from stage.picture("fine")
