"""How presses with each shape end, and what the files of their tables are worth."""

from __future__ import annotations

import shutil
from pathlib import Path

import bpy
import numpy as np
import pytest
from soft_scene import (
    BESIDE,
    DEPTH,
    begin_pressed,
    layer_names,
    locate,
    mesh_state,
    moved,
    part,
    press_down,
    wait,
)

SHAPES = ("LINEAR", "TABLE", "ROTATION_STRAIN")


def table_file(thing, kind):
    file = locate(thing)
    return part("core.shape.paper.table_file").table_path(Path(file), kind)


@pytest.mark.parametrize("way", ["escape", "undo"])
@pytest.mark.parametrize("name", SHAPES)
def test_every_shape_leaves_the_mesh_as_it_was(sessions, states, name, way, thing, before):
    thing.palpate.shape = name
    session = begin_pressed(sessions, states, thing)
    wait(session, lambda: session.seen.shape.ready == 1.0)
    assert not session.seen.shape.problem
    assert mesh_state(thing) != before
    if way == "escape":
        session.post(states.Moment.CANCEL)
    else:
        part("addon.handlers")._before_undo()
    assert sessions.current() is None
    assert mesh_state(thing) == before


@pytest.mark.parametrize("name", SHAPES)
def test_enter_keeps_what_every_shape_drew(sessions, states, name, thing):
    thing.palpate.shape = name
    session = begin_pressed(sessions, states, thing)
    wait(session, lambda: session.seen.shape.ready == 1.0 and session.seen.drawn_contact)
    drawn = moved(thing, "Palpate Live")
    session.post(states.Keep())
    assert layer_names(thing) == ["Press 1"]
    kept = moved(thing, "Press 1")
    assert kept.any()
    np.testing.assert_array_equal(kept, drawn)


@pytest.mark.parametrize(
    "trouble",
    [
        "damaged",
        *(
            pytest.param(one, marks=pytest.mark.at_length)
            for one in ("missing", "foreign", "no table")
        ),
    ],
)
def test_a_table_file_that_is_no_good_is_told_once_and_made_anew(sessions, states, trouble, thing):
    thing.palpate.shape = "TABLE"
    press_down(thing, depth=DEPTH)
    first = moved(thing, "Press 1")
    file = table_file(thing, "newton-table")
    good = file.read_bytes()
    match trouble:
        case "missing":
            file.unlink()
        case "damaged":
            file.write_bytes(good[: len(good) // 2])
        case "foreign":
            arrays = part("core.files.npz_archive").read_arrays(file)
            write = part("core.files.npz_archive").write_arrays
            with file.open("wb") as out:
                write(out, arrays | {"key": np.array("0" * 64)})
        case "no table":
            shutil.copyfile(locate(thing), file)
    part("operators.layer.layers").remove(thing, thing.modifiers["Press 1"])
    session = begin_pressed(sessions, states, thing)
    wait(session, lambda: session.seen.shape.ready == 1.0)
    for _ in range(5):
        session.tick()
    told = [said.text for said in session.said if said.warning]
    assert len(told) == (0 if trouble == "missing" else 1)
    assert all(str(file) in text and "computed anew" in text for text in told)
    sessions.give_way("")
    press_down(thing, depth=DEPTH)
    np.testing.assert_allclose(moved(thing, "Press 1"), first, rtol=0, atol=1e-7)


@pytest.mark.at_length
def test_a_table_that_cannot_be_used_is_a_warning_of_the_operator(
    palpate, monkeypatch, thing, table
):
    thing.palpate.shape, file = "TABLE", table
    # That of the test before may still hold something else.
    file.unlink(missing_ok=True)
    once = part("operators.press.press_once").press_once
    once(thing, bpy.context.scene, BESIDE, (0.0, 0.0, -DEPTH), keep=False)
    file.write_bytes(file.read_bytes()[:1000])
    pressed = once(thing, bpy.context.scene, BESIDE, (0.0, 0.0, -DEPTH), keep=False)
    assert len(pressed.remarks) == 1
    assert str(file) in pressed.remarks[0]
    # By now it is whole again.
    pressed = once(thing, bpy.context.scene, BESIDE, (0.0, 0.0, -DEPTH), keep=False)
    assert pressed.remarks == ()
    # What is not Palpate's stays, and is told each time.
    file.write_bytes(b"nothing")
    pressed = once(thing, bpy.context.scene, BESIDE, (0.0, 0.0, -DEPTH), keep=False)
    assert pressed.remarks
    assert file.read_bytes() == b"nothing"


@pytest.fixture
def table(thing):
    """Place of a table of a body that other tests have too, so nothing is left there."""
    file = table_file(thing, "newton-table")
    yield file
    file.unlink(missing_ok=True)


def test_a_trouble_is_told_once(sessions, states, thing, table):
    file = table
    file.write_bytes(b"nothing")
    thing.palpate.shape = "TABLE"
    session = begin_pressed(sessions, states, thing)
    wait(session, lambda: session.seen.shape.ready == 1.0)
    for _ in range(5):
        session.tick()
    (told,) = [said.text for said in session.said if said.warning]
    assert str(file) in told
