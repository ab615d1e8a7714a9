"""Bake as the operators and `blender -c palpate bake` do, and the figures of what came out."""

from typing import Any

import bpy
from installed import palpate


def make_soft(thing: bpy.types.Object) -> dict[str, Any]:
    """What Make Soft does, fTetWild and all; figures as `palpate bake --json` prints them."""
    return _bake(thing, rebuild=False)


def rebuild_body(thing: bpy.types.Object) -> dict[str, Any]:
    """What Rebuild Body does: a bake of the tetrahedra that are stored in the .blend."""
    return _bake(thing, rebuild=True)


def _bake(thing: bpy.types.Object, *, rebuild: bool) -> dict[str, Any]:
    session = palpate("operators.bake.bake_session")
    body, report = session.run(thing, bpy.context.scene, rebuild=rebuild)
    figures: dict[str, Any] = palpate("cli.body.body_figures").body_figures(body)
    return {**figures, "seconds": report.seconds}
