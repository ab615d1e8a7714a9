"""Hollow meshes are taken apart into convex tools that fill them."""

import importlib.util

import numpy as np
import pytest
import trimesh

from palpate.core.contact.tool import convex_parts as taking_apart
from palpate.core.contact.tool.convex_parts import MOST_PARTS, convex_parts, forget
from palpate.core.errors import PalpateError

# An L of two boards, metres: a corner of the outline is left out.
OUTLINE = np.array([(0, 0), (0.1, 0), (0.1, 0.03), (0.03, 0.03), (0.03, 0.1), (0, 0.1)])
FAN = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 5)])


def bracket():
    """A closed L, 20 mm thick: vertices and triangles."""
    low, high = (np.column_stack([OUTLINE, np.full(6, z)]) for z in (0.0, 0.02))
    sides = [
        face
        for one, other in zip(range(6), [1, 2, 3, 4, 5, 0], strict=True)
        for face in ((one, other, other + 6), (one, other + 6, one + 6))
    ]
    return np.concatenate([low, high]), np.concatenate([FAN[:, ::-1], FAN + 6, sides])


def table():
    """A board on four legs, each a mesh of its own."""
    legs = [(x, y, -0.05) for x in (-0.1, 0.1) for y in (-0.08, 0.08)]
    boxes = [trimesh.creation.box((0.26, 0.2, 0.02))]
    boxes += [trimesh.creation.box((0.02, 0.02, 0.08)).apply_translation(leg) for leg in legs]
    whole = trimesh.util.concatenate(boxes)
    return whole.vertices, whole.faces


def filled(tools, places):
    """Whether any tool holds each place, by the planes of its core."""
    inside = np.zeros(len(places), dtype=bool)
    for tool in tools:
        depth = places @ tool.planes[:, :3].T + tool.planes[:, 3]
        inside |= depth.max(axis=1) < tool.radius
    return inside


def test_a_bracket_is_filled_and_its_corner_left_free():
    tools = convex_parts(*bracket(), "Bracket")
    assert 2 <= len(tools) <= MOST_PARTS
    held = np.array([(0.015, 0.08, 0.01), (0.08, 0.015, 0.01), (0.015, 0.015, 0.01)])
    free = np.array([(0.08, 0.08, 0.01), (0.05, 0.05, 0.01), (0.035, 0.09, 0.01)])
    assert filled(tools, held).all()
    assert not filled(tools, free).any()


def test_the_same_mesh_gives_the_same_tools_and_the_second_time_at_once(monkeypatch):
    first = convex_parts(*bracket(), "Bracket")
    forget()
    second = convex_parts(*bracket(), "Bracket")
    for one, other in zip(first, second, strict=True):
        np.testing.assert_array_equal(one.core, other.core)
    monkeypatch.setattr(taking_apart.subprocess, "Popen", None)
    assert len(convex_parts(*bracket(), "Bracket")) == len(first)


def test_loose_convex_parts_are_taken_as_they_are(monkeypatch):
    monkeypatch.setattr(taking_apart.subprocess, "Popen", None)
    tools = convex_parts(*table(), "Table")
    assert len(tools) == 5
    assert not filled(tools, np.array([[0.0, 0.0, -0.05]])).any()


def test_what_is_open_or_in_too_many_parts_is_refused_with_the_remedy():
    vertices, triangles = bracket()
    with pytest.raises(PalpateError, match=r"Sheet is hollow.*Solidify"):
        convex_parts(vertices, triangles[1:], "Sheet")
    many = [
        trimesh.creation.box((0.01,) * 3).apply_translation((0.02 * n, 0, 0)) for n in range(13)
    ]
    whole = trimesh.util.concatenate(many)
    with pytest.raises(PalpateError, match="13 loose parts, and at most 12"):
        convex_parts(whole.vertices, whole.faces, "Comb")


def test_a_library_that_is_absent_dies_or_does_not_end_is_told(monkeypatch, tmp_path):
    forget()
    for text in ("import os; os.abort()", "import time; time.sleep(60)"):
        program = tmp_path / "child.py"
        program.write_text(text)
        monkeypatch.setattr(taking_apart.run_module, "command", lambda _, at=program: [str(at)])
        monkeypatch.setattr(taking_apart, "LONGEST", 0.3)
        with pytest.raises(PalpateError, match="Bracket cannot be taken apart"):
            convex_parts(*bracket(), "Bracket")
    monkeypatch.setattr(importlib.util, "find_spec", lambda _: None)
    with pytest.raises(PalpateError, match="not built for this system"):
        convex_parts(*bracket(), "Bracket")


def test_a_library_that_cannot_be_loaded_is_told(monkeypatch, tmp_path):
    forget()
    (tmp_path / "coacd.py").write_text("raise OSError('lib_coacd.dll: no vcomp140.dll')")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(PalpateError, match="cannot be loaded; reinstall Palpate"):
        convex_parts(*bracket(), "Bracket")
