"""Bakes of the demo, as by the operators, with figures of the result."""

from typing import Any

import bpy
from installed import palpate


def make_soft(thing: bpy.types.Object) -> dict[str, Any]:
    """Bake as Make Soft does; figures as printed by `palpate bake --json`."""
    return _bake(thing, rebuild=False)


def rebuild_body(thing: bpy.types.Object) -> dict[str, Any]:
    """Bake as Rebuild Body does, from the tetrahedra in the .blend."""
    return _bake(thing, rebuild=True)


def _bake(thing: bpy.types.Object, *, rebuild: bool) -> dict[str, Any]:
    session = palpate("operators.bake.bake_session")
    body, report = session.run(thing, bpy.context.scene, rebuild=rebuild)
    figures: dict[str, Any] = palpate("cli.body.body_figures").body_figures(body)
    return {**figures, "seconds": report.seconds}
