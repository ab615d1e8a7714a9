"""A stroke after another does not look for the drawn vertices' places again."""

from __future__ import annotations

from functools import partial

import bpy
from soft_scene import TOP, part


def test_the_map_is_kept_between_strokes_and_made_anew_for_another_mesh(thing):
    open_body = part("operators.object.drawn_body").open_body
    first = open_body(thing, bpy.context.scene).hung
    bpy.ops.palpate.stroke(motion="PUSH", place=TOP, radius=0.02, depth=0.003)
    assert open_body(thing, bpy.context.scene).hung is first
    part("operators.object.kept_body").forget()
    assert open_body(thing, bpy.context.scene).hung is not first


def test_the_next_stroke_finds_the_same_body_also_where_its_table_is_mapped(thing, monkeypatch):
    open_body = part("operators.object.drawn_body").open_body
    file = part("core.body.body_file")
    part("operators.object.kept_body").forget()
    monkeypatch.setattr(file, "load", partial(file.load, mapped_from_bytes=0))
    first, again = (open_body(thing, bpy.context.scene).body for _ in range(2))
    assert type(first.compliance).__name__ == "MappedCompliance"
    # What takes seconds to prepare is kept with it.
    assert again is first
    assert bpy.ops.palpate.rebuild_body() == {"FINISHED"}
