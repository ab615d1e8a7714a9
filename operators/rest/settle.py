"""Settle: let objects that nobody holds come to rest; in the window they are seen on their way."""

from __future__ import annotations

import time
from collections.abc import Sequence

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..lying.before import Before
from ..lying.coming_down import Alone, begun, settle, show
from ..lying.free_body import Lying
from ..lying.free_pile import FreePile
from ..lying.together import together
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
# It lies still when it goes by less than this share of its size in so many pictures; then it is
# brought to rest exactly, and after so many pictures anyhow, so many ticks at a time between two
# looks at the clock.
STILL, STILL_PICTURES, MOST_PICTURES = 1e-4, 5, 300
SETTLING_TICKS = 5
VIEW_KEYS = {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE", "TRACKPADPAN", "TRACKPADZOOM"}


class PALPATE_OT_settle(Acting, bpy.types.Operator):
    bl_idname = "palpate.settle"
    bl_label = "Settle"
    bl_description = (
        "Let the soft object come to rest on its floor and colliders: it moves, turns and sags as "
        "it would lie there, with all soft objects that are selected or that it rests on, which "
        "give way. The meshes stay as they are; Reset brings all back"
    )
    bl_options = {"REGISTER", "UNDO"}

    _handles: list[ObjectHandle]
    _before: list[Before]
    _coming: Alone | FreePile
    _pictures: int
    _still: int
    _is_still: bool
    _place: NDArray[np.float64]

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        return press_session.refusal() or soft_object.refusal_unbaked(context.object)

    def act(self, context: bpy.types.Context) -> None:
        things = together(context.object, context.selected_objects)
        self._tell(things, settle(things, context.evaluated_depsgraph_get()))

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
        """Give the objects back; also with the operator: another file, unregister, or exit."""
        for handle, before in zip(self._handles, self._before, strict=True):
            thing = handle.find()
            if thing is not None:
                before.give_back(thing)
        self._stay.end(context)

    def _start(self, context: bpy.types.Context) -> set[str]:
        things = together(context.object, context.selected_objects)
        with wait_cursor(context):
            self._coming = begun(things, context.evaluated_depsgraph_get(), SEEN_FALLING)
        self._handles = [ObjectHandle.of(thing) for thing in things]
        self._before = [Before.of(thing) for thing in things]
        self._pictures, self._still, self._is_still = 0, 0, False
        self._place = np.zeros((len(things), 4, 3))
        self._stay = ModalStay()
        self._stay.begin(self, context, PACE)
        self._stay.say(context, f"Palpate: {shown('Coming to rest     [Esc] Restore')}")
        return {"RUNNING_MODAL"}

    def _go_on(self, context: bpy.types.Context) -> bool:
        """Show the objects a picture later; whether all rest."""
        things, coming = [self._found(handle) for handle in self._handles], self._coming
        is_done = self._is_still and _settled(coming)
        if not self._is_still:
            for _ in range(TICKS):
                coming.tick(TICK)
        lying = coming.now()
        placements = [one.rest.placement for one in lying]
        here = np.array([[one.position / coming.size, *one.rotation] for one in placements])
        self._still = self._still + 1 if np.abs(here - self._place).max() < STILL else 0
        self._place, self._pictures = here, self._pictures + 1
        is_long = self._pictures >= MOST_PICTURES
        self._is_still = self._is_still or is_long or self._still == STILL_PICTURES
        show(things, lying, coming.supports.floor)
        if is_done:
            self._stay.end(context)
            self._tell(things, lying)
        return is_done

    def _found(self, handle: ObjectHandle) -> bpy.types.Object:
        thing = handle.find()
        if thing is None:
            raise PalpateError("{name} is gone; choose another object", name=handle.name)
        return thing

    def _tell(self, things: Sequence[bpy.types.Object], lying: Sequence[Lying]) -> None:
        bearing = [touch for one in lying for touch in (*one.rest.supports, *one.rest.others)]
        strongest = max(float(np.linalg.norm(touch.force)) for touch in bearing)
        if len(things) > 1:
            self.report(
                {"INFO"},
                reported(
                    "{count} objects rest: {force:.3g} N where one bears most",
                    count=len(things),
                    force=strongest,
                ),
            )
            return
        (thing,) = things
        self.report(
            {"INFO"},
            reported(
                "{name} rests: {force:.3g} N on what bears it most",
                name=thing.name,
                force=strongest,
            ),
        )


def _settled(coming: Alone | FreePile) -> bool:
    """Go on to exact rest for as long as a picture stands; whether all rest."""
    end = time.monotonic() + PACE
    while time.monotonic() < end:
        if coming.settle_on(SETTLING_TICKS):
            return True
    return False


classes = (PALPATE_OT_settle,)
