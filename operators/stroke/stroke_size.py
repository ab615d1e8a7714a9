"""Radius of the tool, and how much a drag moves: set by a drag in the view."""

from __future__ import annotations

from dataclasses import dataclass

import bpy
import numpy as np

from ...core.errors import PalpateError
from ..place.seen_place import SeenPlace, under_pointer
from ..reporting.acting import Acting
from ..reporting.quantities import scene_length
from ..reporting.translated import shown
from ..scene import viewport
from ..scene.drawn_surface import frame_of, metres_per_unit, size_of
from ..scene.modal_stay import ModalStay
from ..tool.tool_sizes import chosen_sizes

# Pixels over which the strength doubles.
DOUBLING_PIXELS = 100.0
WEAKEST, STRONGEST = 0.05, 20.0
# Of the radius before, at once.
LEAST_SHARE = 0.02


@dataclass(frozen=True, eq=False)
class Sized:
    """Place where the pointer was when a size began to be set, and the radius now, scene units."""

    touched: SeenPlace
    radius: float


_sized: Sized | None = None


def being_set() -> Sized | None:
    """The tool at the place for which a size is being set, while somebody does so."""
    return _sized


def radius_for(scene: bpy.types.Scene, thing: bpy.types.Object) -> float:
    """Radius of the tool for an object, metres.

    Raises
    ------
    PalpateError
        Its transform flattens it.
    """
    return chosen_sizes(scene, size_of(thing, scene)).tip_radius


class PALPATE_OT_stroke_size(Acting, bpy.types.Operator):
    bl_idname = "palpate.stroke_size"
    bl_label = "Size of the Tool"
    bl_description = (
        "Move the pointer to the right for more, to the left for less; click to take it"
    )
    bl_options = {"INTERNAL"}

    what: bpy.props.EnumProperty(
        name="What",
        description="What is set",
        items=[
            ("RADIUS", "Radius", "Radius of the fingertip or patch"),
            ("STRENGTH", "Strength", "How far a drag moves the surface"),
        ],
        options={"SKIP_SAVE"},
    )

    _touched: SeenPlace | None
    _before: float
    _radius: float
    _start: int
    _metres_per_pixel: float

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        return self.guarded(lambda: self._start_in_view(context, event))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}:
            self._follow(context, event.mouse_x - self._start)
            return {"RUNNING_MODAL"}
        if event.value != "PRESS":
            return {"RUNNING_MODAL"}
        if event.type in {"ESC", "RIGHTMOUSE"}:
            setattr(context.scene.palpate, self._property(context), self._before)
            return self._leave(context, "CANCELLED")
        if event.type in {"LEFTMOUSE", "RET", "NUMPAD_ENTER", "F"}:
            return self._leave(context, "FINISHED")
        return {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """End with the operator: another file, unregister, or exit."""
        self._leave(context, "CANCELLED")

    def _start_in_view(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        here = viewport.under_pointer(context.window, event.mouse_x, event.mouse_y)
        thing = context.object
        if here is None or thing is None:
            raise PalpateError("place the pointer in a 3D view with an object to set this")
        touched = under_pointer(context.scene, context.evaluated_depsgraph_get(), here)
        self._touched = touched
        frame = frame_of(thing, context.scene) if touched is None else touched.frame
        place = np.zeros(3) if touched is None else frame.body_from_world(touched.seen)
        view = here.view_at(place, frame)
        self._metres_per_pixel = 0.0 if view is None else view.metres_per_pixel
        self._before = getattr(context.scene.palpate, self._property(context))
        self._radius, self._start = radius_for(context.scene, thing), event.mouse_x
        self._stay = ModalStay()
        self._stay.begin(self, context)
        self._stay.say(context, shown("Move: More or less     [LMB] Take     [Esc] Restore"))
        self._follow(context, 0)
        return {"RUNNING_MODAL"}

    def _follow(self, context: bpy.types.Context, pixels: int) -> None:
        chosen = context.scene.palpate
        if self.what == "STRENGTH":
            changed = self._before * 2.0 ** (pixels / DOUBLING_PIXELS)
            chosen.stroke_strength = min(max(changed, WEAKEST), STRONGEST)
            self._stay.head(context, f"{shown('Strength')}: {chosen.stroke_strength:.2f}")
            self._show(context, self._radius)
            return
        metres = max(self._radius + pixels * self._metres_per_pixel, LEAST_SHARE * self._radius)
        if chosen.own_sizes:
            chosen.tip_radius = metres / metres_per_unit(context.scene)
        else:
            chosen.tip_share = self._before * metres / self._radius
        metres = radius_for(context.scene, context.object)
        length = scene_length(context.scene, metres)
        self._stay.head(context, f"{shown('Radius')}: {length}")
        self._show(context, metres)

    def _show(self, context: bpy.types.Context, metres: float) -> None:
        """Have the circle drawn with a radius where the pointer was, as brushes do."""
        global _sized  # noqa: PLW0603  there is one pointer
        if self._touched is not None:
            _sized = Sized(self._touched, metres / metres_per_unit(context.scene))
            viewport.redraw_views()

    def _property(self, context: bpy.types.Context) -> str:
        """Name of the scene's property that is set."""
        if self.what == "STRENGTH":
            return "stroke_strength"
        return "tip_radius" if context.scene.palpate.own_sizes else "tip_share"

    def _leave(self, context: bpy.types.Context, result: str) -> set[str]:
        global _sized  # noqa: PLW0603  see _show
        _sized = None
        self._stay.end(context)
        return {result}


classes = (PALPATE_OT_stroke_size,)
