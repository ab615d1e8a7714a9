"""Base of the operators that measure softness: when they may run, and where."""

from __future__ import annotations

from typing import TYPE_CHECKING

import bpy

from ..bake.bake_session import OnSoft
from ..layer import place_marks
from ..object.drawn_body import DrawnBody
from ..place import touched_place
from ..reporting.translated import reported, shown
from ..scene import viewport
from ..scene.body_frame import Point, as_point
from ..scene.modal_stay import ModalStay
from ..shape.held_body import open_held

if TYPE_CHECKING:

    class _Operator(bpy.types.Operator):
        pass
else:

    class _Operator:
        """Empty base: Blender registers subclasses of its own class, not what they share."""


class SoftnessOperator(OnSoft, _Operator):
    """Operator on the body of the active object, by :meth:`measure`, whose
    :class:`PalpateError` is reported. One for a single place has ``at`` and ``pick``.
    """

    bl_options = {"REGISTER", "UNDO"}
    asks_everywhere = False

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.asks_everywhere or not self.properties.pick:
            return self.execute(context)
        return self.guarded(lambda: self._pick(context))

    def _pick(self, context: bpy.types.Context) -> set[str]:
        self._drawn = open_held(context.object, context.scene)
        context.window.cursor_modal_set("EYEDROPPER")
        self._stay = ModalStay()
        self._stay.begin(self, context)
        self._stay.say(context, shown("Click the place on the object; right click to leave"))
        return MODAL

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in {"RIGHTMOUSE", "ESC"}:
            self.cancel(context)
            return {"CANCELLED"}
        if event.type != "LEFTMOUSE" or event.value != "PRESS":
            return {"PASS_THROUGH"} if event.type.startswith(("WHEEL", "MIDDLE")) else MODAL
        self.cancel(context)
        here = viewport.under_pointer(context.window, event.mouse_x, event.mouse_y)
        place = None if here is None else _met(context, self._drawn, here)
        if place is None:
            self.report(
                {"WARNING"},
                reported("{name} is not there; nothing was measured", name=context.object.name),
            )
            return {"CANCELLED"}
        self.properties.at = place
        return self.execute(context)

    def act(self, context: bpy.types.Context) -> None:
        self.measure(context, open_held(context.object, context.scene))

    def measure(self, context: bpy.types.Context, drawn: DrawnBody) -> None:
        """Measure, store and report."""
        raise NotImplementedError

    def cancel(self, context: bpy.types.Context) -> None:
        """Stop asking for a place: it was clicked, or another file, unregister, exit."""
        if context.window is not None:
            context.window.cursor_modal_restore()
        self._stay.end(context)


MODAL = {"RUNNING_MODAL"}


def _met(context: bpy.types.Context, drawn: DrawnBody, here: viewport.Viewport) -> Point | None:
    """Point of the object, as it is seen, under the pointer, world units."""
    thing = context.object
    with place_marks.marked(thing):
        place = touched_place.under_ray(thing, drawn.frame, *here.line_of_sight())
    return None if place is None else as_point(drawn.frame.world_from_body(place.seen))
