"""Settle: let an object that nobody holds come to rest."""

from __future__ import annotations

import bpy
import numpy as np

from ...core.errors import PalpateError
from ..object import soft_object
from ..object.drawn_body import open_body
from ..played import mesh_cache
from ..reporting.acting import Acting
from ..reporting.translated import reported
from ..reporting.wait_cursor import wait_cursor
from ..session import press_session
from . import rest_layer
from .free_body import Lying, lie, supports_under
from .laid import is_animated, lay


class PALPATE_OT_settle(Acting, bpy.types.Operator):
    bl_idname = "palpate.settle"
    bl_label = "Settle"
    bl_description = (
        "Let the soft object come to rest on its floor and colliders: it moves, turns and sags as "
        "it would lie there. The mesh stays as it is; Reset brings all back"
    )
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        if press_session.current() is not None:
            return "A press is going on; Enter keeps the shape, Escape restores it"
        return soft_object.refusal_unbaked(context.object)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        with wait_cursor(context):
            return self.execute(context)

    def act(self, context: bpy.types.Context) -> None:
        thing = context.object
        lying = settle(thing, context.evaluated_depsgraph_get())
        strongest = max(float(np.linalg.norm(one.force)) for one in lying.rest.supports)
        self.report(
            {"INFO"},
            reported(
                "{name} rests: {force:.3g} N on what bears it most",
                name=thing.name,
                force=strongest,
            ),
        )


def settle(thing: bpy.types.Object, graph: bpy.types.Depsgraph) -> Lying:
    """Let an object come to rest where it is; where it lies then.

    Raises
    ------
    PalpateError
        It is pinned or cannot move by itself, nothing bears it, or it does not come to rest.
    """
    refuse_played(thing)
    drawn = open_body(thing, graph.scene)
    supports = supports_under(thing, drawn, graph)
    lying = lie(thing, drawn, supports).come_down()
    show(thing, lying, supports.floor)
    return lying


def show(thing: bpy.types.Object, lying: Lying, floor: float | None) -> None:
    """Move an object to where it lies, and have it sag there."""
    lay(thing, lying.frame, floor)
    rest_layer.show(thing, lying.moved)


def refuse_played(thing: bpy.types.Object) -> None:
    """Refuse an object that an animation places.

    Raises
    ------
    PalpateError
        It plays a baked animation, or has keyframes.
    """
    if mesh_cache.plays(thing) or is_animated(thing):
        raise PalpateError(
            "{name} is placed by its animation; Reset ends one that was baked, other keyframes of "
            "its place are to be cleared",
            name=thing.name,
        )


classes = (PALPATE_OT_settle,)
