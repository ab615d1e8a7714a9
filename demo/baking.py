"""Bake by the operators, and the figures of what came out."""

import time
from typing import Any

import bpy
from installed import palpate


def make_soft(thing: bpy.types.Object) -> dict[str, Any]:
    """Press Make Soft: fTetWild and all; figures as `palpate bake --json` prints them."""
    return _bake(thing, bpy.ops.palpate.make_soft)


def rebuild_body(thing: bpy.types.Object) -> dict[str, Any]:
    """Press Rebuild Body: the tetrahedra that are stored in the .blend."""
    return _bake(thing, bpy.ops.palpate.rebuild_body)


def _bake(thing: bpy.types.Object, operator: Any) -> dict[str, Any]:
    bpy.context.view_layer.objects.active = thing
    start = time.perf_counter()
    done = operator()
    waited = time.perf_counter() - start
    if done != {"FINISHED"}:
        raise RuntimeError(f"{operator.idname_py()} on {thing.name} gave {done}")
    body = palpate("operators.body_store").load(thing)
    figures: dict[str, Any] = palpate("cli.body_figures").body_figures(body)
    figures["seconds"] = {"steps": thing.palpate.bake_seconds, "until_pressable": waited}
    return figures
