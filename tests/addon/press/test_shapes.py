"""Shapes of large deformation: chosen, switched while pressing, filled, kept, given up."""

from __future__ import annotations

import threading
import time
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from soft_scene import (
    BESIDE,
    DEPTH,
    begin_pressed,
    depth,
    hide_layers,
    layer_names,
    locate,
    mesh_state,
    moved,
    part,
    press_down,
    rest_places,
    soft_cube,
    wait,
)

NAMES = {
    "LINEAR": "linear",
    "TABLE": "paper",
    "ROTATION_STRAIN": "real",
}


@pytest.fixture
def shapes(palpate):
    return part("core.shape.shapes")


class Narrower:
    """Nine tenths of the linear shape: nothing a body would do, but easy to tell."""

    notice = ""

    def __init__(self, body, file):
        self.body, self.file, self.closed = body, file, threading.Event()
        self.ready = 1.0

    def displacements(self, nodes, nodal_forces, young_modulus=None):
        share = 1.0 if self.ready < 1.0 else 0.9
        return share * self.body.deform(nodes, nodal_forces, young_modulus)

    def wait_for(self, nodes):
        self.asked, self.ready = nodes, 1.0

    def close(self):
        self.closed.set()


def drawn_depth(thing, key="Palpate Live"):
    return BESIDE[2] - (rest_places(thing) + moved(thing, key))[:, 2].max()


def test_the_panel_offers_every_shape_with_its_sentence(palpate, shapes):
    items = bpy.context.object.palpate.bl_rna.properties["shape"].enum_items
    assert {item.identifier for item in items} == {*NAMES, "SERIES"}
    # Older files hold these numbers.
    assert [items[name].value for name in ("LINEAR", "TABLE", "SERIES", "ROTATION_STRAIN")] == [
        *range(4)
    ]
    assert tuple(NAMES.values()) == shapes.SHAPES
    for name, explained in NAMES.items():
        assert items[name].description == shapes.EXPLANATIONS[explained]


def test_scripts_that_name_the_former_series_get_paper_and_are_told(palpate, shapes, thing):
    once, keys = part("operators.press.press_once").press_once, {}
    for name in ("TABLE", "SERIES"):
        hide_layers(thing)
        thing.palpate.shape = name
        pressed = once(thing, bpy.context.scene, BESIDE, (0.0, 0.0, -DEPTH), keep=True)
        assert pressed.remarks == ((shapes.SERIES_IS_PAPER,) if name == "SERIES" else ())
        keys[name] = moved(thing, pressed.layer)
    np.testing.assert_array_equal(keys["SERIES"], keys["TABLE"])
    assert part("addon.panels.shape").cost_now(thing).table_seconds > 0.0


@pytest.mark.parametrize("name", NAMES)
def test_costs_are_told_before_and_grow_with_the_body(palpate, name):
    cost = part("core.shape.shape_cost")
    thing = soft_cube()
    thing.palpate.shape = name
    now = part("addon.panels.shape").cost_now(thing)
    large = cost.shape_cost(NAMES[name], cost.BodySize(20_000, 80_000, 6_400))
    assert 0.0 < now.frame_seconds < large.frame_seconds
    assert now.memory_bytes <= large.memory_bytes
    assert (large.table_seconds > 10.0) == (name == "TABLE")
    assert now.first_seconds <= large.first_seconds
    thing.palpate.free_surface_count = 0
    assert part("addon.panels.shape").cost_now(thing) is None


@pytest.mark.parametrize("name", NAMES)
def test_a_script_keeps_the_shape_that_is_chosen(palpate, name, thing):
    press_down(thing, depth=DEPTH)
    hide_layers(thing)
    thing.palpate.shape = name
    press_down(thing, depth=DEPTH)
    linear, chosen = (moved(thing, key) for key in ("Press 1", "Press 2"))
    largest = np.abs(linear).max()
    assert np.abs(chosen - linear).max() < largest
    assert np.array_equal(chosen, linear) == (name == "LINEAR")


def test_real_is_felt_as_it_is_seen(sessions, states, thing):
    session = begin_pressed(sessions, states, thing)
    linear = np.linalg.norm(session.snapshot.contact_force)
    thing.palpate.shape = "ROTATION_STRAIN"
    wait(session, lambda: abs(session.snapshot.firmness - 1.0) > 1e-3)
    firm = session.snapshot
    assert np.linalg.norm(firm.contact_force) == pytest.approx(firm.firmness * linear, rel=1e-3)
    thing.palpate.shape = "LINEAR"
    wait(session, lambda: abs(session.snapshot.firmness - 1.0) < 1e-6)
    session.post(states.Moment.CANCEL)


@pytest.mark.parametrize("name", ["TABLE", "ROTATION_STRAIN"])
def test_a_shape_is_switched_while_pressing_and_nothing_is_lost(
    sessions, states, name, thing, before
):
    session = begin_pressed(sessions, states, thing)
    linear = session.seen.displacements
    thing.palpate.shape = name
    wait(
        session,
        lambda: (
            session.seen.shape.ready == 1.0
            and not np.array_equal(session.seen.displacements, linear)
        ),
    )
    assert not session.seen.shape.problem
    assert session.snapshot.touching
    assert depth(session) == pytest.approx(DEPTH, rel=0.01)
    assert not np.array_equal(session.seen.displacements, linear)
    # Where the linear body is under less force by its firmness.
    np.testing.assert_allclose(session.seen.linear, linear, rtol=1e-9, atol=1e-12)
    thing.palpate.shape = "LINEAR"
    wait(session, lambda: np.array_equal(session.seen.displacements, linear))
    session.post(states.Moment.CANCEL)
    thing.palpate.shape = "LINEAR"
    assert mesh_state(thing) == before


def test_until_it_is_made_and_filled_the_linear_shape_is_drawn(
    sessions, states, shapes, monkeypatch
):
    thing, allowed, made = soft_cube(), threading.Event(), []

    def slowly(body, file):
        allowed.wait(5.0)
        made.append(Narrower(body, file))
        made[0].ready = 0.37
        return made[0]

    monkeypatch.setitem(shapes.MAKERS, "paper", slowly)
    thing.palpate.shape = "TABLE"
    session = begin_pressed(sessions, states, thing)
    linear = drawn_depth(thing)
    assert session.seen.shape.ready == 0.0
    allowed.set()
    wait(session, lambda: session.seen.shape.ready == 0.37)
    assert drawn_depth(thing) == pytest.approx(linear, abs=1e-6)
    said = [line.text for line in part("addon.overlay.hud")._shape_lines(session)]
    assert said == ["Shape 37 %"]
    assert made[0].file == locate(thing)
    made[0].ready = 1.0
    wait(session, lambda: session.seen.displacements is not session.seen.linear)
    assert not part("addon.overlay.hud")._shape_lines(session)


def test_what_is_kept_waits_a_little_and_says_what_it_lacks(sessions, states, shapes, monkeypatch):
    thing, made = soft_cube(), []

    def half(body, file):
        made.append(Narrower(body, file))
        made[0].ready = 0.5
        return made[0]

    monkeypatch.setitem(shapes.MAKERS, "paper", half)
    monkeypatch.setattr(part("operators.shape.drawn_shape"), "PATIENCE", 0.2)
    thing.palpate.shape = "TABLE"
    session = begin_pressed(sessions, states, thing)
    wait(session, lambda: session.seen.shape.ready == 0.5)
    session.post(states.Keep())
    assert layer_names(thing)[-1] == "Press 1"
    assert [said.text for said in session.said] == ["It is kept as far as it was computed, 50 %"]
    assert made[0].closed.wait(5.0)


def test_a_shape_that_cannot_be_made_is_told_once_and_the_press_goes_on(
    sessions, states, shapes, monkeypatch
):
    def refuse(body, file):
        raise part("core.errors").PalpateError("shape: no room; choose another")

    monkeypatch.setitem(shapes.MAKERS, "paper", refuse)
    thing = soft_cube()
    thing.palpate.shape = "TABLE"
    session = begin_pressed(sessions, states, thing)
    wait(session, lambda: bool(session.seen.shape.problem))
    for _ in range(5):
        session.tick()
    assert [said.text for said in session.said] == ["shape: no room; choose another"]
    assert session.state.phase is states.Phase.HOLDING
    np.testing.assert_array_equal(session.seen.displacements, session.seen.linear)
    sessions.give_way("")
    # Without a clock there is nobody to look at the linear one instead.
    with pytest.raises(RuntimeError, match="no room; choose another"):
        press_down(thing)


@pytest.mark.parametrize("way", ["cancel", "deletion", "another file", "undo"])
def test_the_end_of_a_press_ends_the_work_behind_it(sessions, states, shapes, monkeypatch, way):
    thing, made = soft_cube(), []
    monkeypatch.setitem(
        shapes.MAKERS,
        "paper",
        lambda body, file: made.append(Narrower(body, file)) or made[0],
    )
    thing.palpate.shape = "TABLE"
    session = begin_pressed(sessions, states, thing)
    wait(session, lambda: session.seen.shape.ready == 1.0 and bool(made))
    if way == "cancel":
        session.post(states.Moment.CANCEL)
    elif way == "deletion":
        bpy.data.objects.remove(thing)
        session.tick()
    elif way == "another file":
        bpy.ops.wm.read_homefile(use_factory_startup=True)
    else:
        part("addon.handlers")._before_undo()
    assert made[0].closed.wait(5.0)
    assert sessions.current() is None


def test_a_shape_still_being_made_is_closed_when_it_is_there(sessions, states, shapes, monkeypatch):
    thing, allowed, made = soft_cube(), threading.Event(), []

    def slowly(body, file):
        allowed.wait(5.0)
        made.append(Narrower(body, file))
        return made[0]

    monkeypatch.setitem(shapes.MAKERS, "paper", slowly)
    thing.palpate.shape = "TABLE"
    session = begin_pressed(sessions, states, thing)
    session.post(states.Moment.CANCEL)
    allowed.set()
    end = time.monotonic() + 5.0
    while not made and time.monotonic() < end:
        time.sleep(0.005)
    assert made[0].closed.wait(5.0)


def test_pressure_is_drawn_on_the_shape_that_is_seen(palpate):
    reading = part("addon.overlay.reading")
    thing = soft_cube()
    drawn = part("operators.object.drawn_body").open_body(thing, bpy.context.scene)
    mesh = drawn.body.mesh

    class Seen:
        linear = np.zeros((drawn.body.compliance.node_count, 3))
        displacements = linear + np.array([0.0, 0.0, 0.002])

    class Finger:
        nodes = np.searchsorted(mesh.surface_nodes, drawn.body.compliance.free_surface[:6])

    session = SimpleNamespace(drawn=drawn, seen=Seen)
    points = mesh.nodes[drawn.body.compliance.free_surface[:3]]
    moved = reading._as_drawn(session, Finger, points)
    np.testing.assert_allclose(moved, points + np.array([0.0, 0.0, 0.002]), atol=1e-12)
