"""Settle: let an object that nobody holds come to rest; in the window it is seen on its way."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..lying.before import Before
from ..lying.coming_down import begun, settle, show
from ..lying.free_body import FreeBody, Lying
from ..object import soft_object
from ..reporting.acting import Acting
from ..reporting.translated import reported, shown
from ..reporting.wait_cursor import wait_cursor
from ..scene.modal_stay import ModalStay
from ..scene.object_handle import ObjectHandle
from ..session import press_session

# Between pictures, seconds, it goes on by so many ticks, of so many seconds.
PACE, TICKS, TICK = 1.0 / 30.0, 10, 4e-3
# At most so many times its size over what bears it an object is seen to fall.
SEEN_FALLING = 1.0
# It lies still when it goes by less than this share of its size in so many pictures; then all is
# brought to rest at once, and after so many pictures anyhow.
STILL, STILL_PICTURES, MOST_PICTURES = 1e-4, 5, 300
VIEW_KEYS = {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN", "TRACKPADZOOM"}


class PALPATE_OT_settle(Acting, bpy.types.Operator):
    bl_idname = "palpate.settle"
    bl_label = "Settle"
    bl_description = (
        "Let the soft object come to rest on its floor and colliders: it moves, turns and sags as "
        "it would lie there. The mesh stays as it is; Reset brings all back"
    )
    bl_options = {"REGISTER", "UNDO"}

    _handle: ObjectHandle
    _before: Before
    _free: FreeBody
    _pictures: int
    _still: int
    _place: NDArray[np.float64]

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        return press_session.refusal() or soft_object.refusal_unbaked(context.object)

    def act(self, context: bpy.types.Context) -> None:
        thing = context.object
        self._tell(thing, settle(thing, context.evaluated_depsgraph_get()))

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        return self.guarded(lambda: self._start(context))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS":
            self.cancel(context)
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"} if event.type in VIEW_KEYS else {"RUNNING_MODAL"}
        try:
            is_done = self._go_on(context)
        except PalpateError as problem:
            self.cancel(context)
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        except BaseException:
            # A bug must not leave the object somewhere on its way.
            self.cancel(context)
            raise
        return {"FINISHED"} if is_done else {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Give the object back; also with the operator: another file, unregister, or exit."""
        thing = self._handle.find()
        if thing is not None:
            self._before.give_back(thing)
        self._stay.end(context)

    def _start(self, context: bpy.types.Context) -> set[str]:
        thing = context.object
        with wait_cursor(context):
            self._free = begun(thing, context.evaluated_depsgraph_get())
            self._free.drop(SEEN_FALLING * self._free.drawn.size)
        self._handle, self._before = ObjectHandle.of(thing), Before.of(thing)
        self._pictures, self._still = 0, 0
        self._place = np.zeros(12)
        self._stay = ModalStay()
        self._stay.begin(self, context, PACE)
        self._stay.say(context, f"Palpate: {shown('Coming to rest     [Esc] Restore')}")
        return {"RUNNING_MODAL"}

    def _go_on(self, context: bpy.types.Context) -> bool:
        """Show the object a picture later; whether it rests."""
        thing, free = self._handle.find(), self._free
        if thing is None:
            raise PalpateError("{name} is gone; choose another object", name=self._handle.name)
        for _ in range(TICKS):
            free.resting.tick(TICK, hurried=True)
        lying = free.now()
        here = np.append(lying.rest.placement.position / free.drawn.size, lying.frame.rotation)
        self._still = self._still + 1 if np.abs(here - self._place).max() < STILL else 0
        self._place, self._pictures = here, self._pictures + 1
        is_done = self._still == STILL_PICTURES or self._pictures == MOST_PICTURES
        if is_done:
            lying = free.come_down()
        show(thing, lying, free.supports.floor)
        if is_done:
            self._stay.end(context)
            self._tell(thing, lying)
        return is_done

    def _tell(self, thing: bpy.types.Object, lying: Lying) -> None:
        strongest = max(float(np.linalg.norm(one.force)) for one in lying.rest.supports)
        self.report(
            {"INFO"},
            reported(
                "{name} rests: {force:.3g} N on what bears it most",
                name=thing.name,
                force=strongest,
            ),
        )


classes = (PALPATE_OT_settle,)
