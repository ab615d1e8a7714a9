"""Stroke: hold and drag on a soft object; what is let go stays."""

from __future__ import annotations

from dataclasses import replace

import bpy
import numpy as np

from ...core.errors import PalpateError
from ..imprint import kept_imprint
from ..imprint.kept_imprint import NothingStaysError
from ..layer import live_layer, place_marks
from ..object import soft_object
from ..object.drawn_body import open_body
from ..place import touched_place
from ..place.seen_place import under_pointer
from ..place.touched_place import TouchedPlace
from ..reporting.acting import Acting
from ..reporting.translated import reported, shown
from ..reporting.wait_cursor import wait_cursor
from ..scene import viewport
from ..scene.active_object import make_active
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import metres_per_unit
from ..scene.modal_stay import ModalStay
from ..scene.object_handle import ObjectHandle
from ..scene.probe_drag import View
from ..session import press_session
from ..tool.tool_sizes import chosen_sizes
from . import stroke_words
from .answer.free_stroke import FreeStroke, stroke_of
from .answer.grips import grips_at
from .answer.motion import Asked, Motion
from .answer.stroke import Stroke
from .answer.stroked import Stroked
from .stroke_drag import StrokeDrag
from .stroke_drawing import draw
from .stroke_properties import StrokeProperties
from .typed_amount import TypedAmount


class PALPATE_OT_stroke(StrokeProperties, Acting, bpy.types.Operator):
    bl_idname = "palpate.stroke"
    bl_label = "Stroke"
    bl_description = (
        "Push, pull, grab, twist or pinch the soft object under the pointer: hold, drag, let go. "
        "Every stroke stays, and the next goes on from it"
    )
    bl_options = {"REGISTER", "UNDO"}

    _handle: ObjectHandle
    _stroke: Stroke | FreeStroke
    _touched: TouchedPlace
    # Of the object, or of its instance that was touched.
    _frame: BodyFrame
    _drag: StrokeDrag
    _typed: TypedAmount
    # What was asked last and could be done.
    _last: tuple[Asked, Stroked]

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        reason = press_session.refusal()
        if not reason and context.mode != "OBJECT":
            reason = "Strokes are for Object Mode; leave this mode first"
        return reason

    def act(self, context: bpy.types.Context) -> None:
        thing, scene = self.remembered(context), context.scene
        reason = soft_object.refusal_unbaked(thing)
        if reason:
            raise PalpateError(reason)
        frame = self.remembered_frame(thing, scene)
        with place_marks.marked(thing):
            touched = touched_place.nearest(thing, frame, np.array(self.place))
        self._begin(thing, scene, frame, touched)
        wanted = self.asked(self._frame, self._touched.turn)
        if wanted.nothing:
            raise PalpateError(
                "stroke: it moves nothing; give it a depth, a way, an angle or a share"
            )
        self._hang(thing)
        try:
            asked, stroked = self._stroke.stroked(wanted)
            if stroked.springs_back:
                asked, stroked = self._stroke.ended(asked, stroked)
            draw(thing, self._stroke, stroked)
            self._keep(scene, thing, asked, stroked)
            if stroked.ends:
                self.tell(asked, self._frame, self._touched.turn)
                self.report({"WARNING"}, reported(stroked.ends))
        except BaseException:
            self._give_up(thing)
            raise
        finally:
            self._stroke.close()
        if context.object != thing:
            make_active(context.view_layer, thing)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        return self.guarded(lambda: self._start(context, event))

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        try:
            return self._handle_event(context, event)
        except PalpateError as problem:
            self._leave(context, give_up=True)
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        except BaseException:
            # A bug must not leave a layer that nobody removes.
            self._leave(context, give_up=True)
            raise

    def cancel(self, context: bpy.types.Context) -> None:
        """End with the operator: another file, unregister, or exit."""
        self._leave(context, give_up=True)

    def _start(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        here = viewport.under_pointer(context.window, event.mouse_x, event.mouse_y)
        if here is None:
            return {"PASS_THROUGH"}
        scene = context.scene
        seen = under_pointer(scene, context.evaluated_depsgraph_get(), here)
        if seen is None:
            return {"PASS_THROUGH"}
        thing, frame = seen.thing, seen.frame
        reason = soft_object.refusal(thing)
        if reason:
            raise PalpateError(reason)
        if not self.properties.is_property_set("motion"):
            self.motion = scene.palpate.stroke
        if not self.properties.is_property_set("mirrored"):
            self.mirrored = scene.palpate.stroke_mirrored
        self.remember(seen)
        with wait_cursor(context):
            with place_marks.marked(thing):
                touched = touched_place.touched(seen, *here.line_of_sight())
            view = here.view_at(touched.seen, frame)
            if view is None:
                return {"PASS_THROUGH"}
            self._begin(thing, scene, frame, touched)
            self._drag = self._drag_from(event, view, scene)
            # What takes time is prepared before anything is changed, and a pinned place refused.
            self._last = self._stroke.stroked(self._drag.asked(touched.turn))
        if context.object != thing:
            make_active(context.view_layer, thing)
        self._typed = TypedAmount(self._drag.motion)
        self._hang(thing)
        self._stay = ModalStay()
        self._stay.begin(self, context, self._stroke.pace)
        self._stay.say(context, stroke_words.status(self._drag.motion))
        return {"RUNNING_MODAL"}

    def _drag_from(self, event: bpy.types.Event, view: View, scene: bpy.types.Scene) -> StrokeDrag:
        chosen, cursor = scene.palpate, (event.mouse_x, event.mouse_y)
        return StrokeDrag(
            motion=Motion[self.motion],
            sign=-1.0 if self.outward != chosen.stroke_outward else 1.0,
            view=view,
            radius=self._stroke.grips[0].radius,
            size=self._stroke.drawn.size,
            strength=chosen.stroke_strength,
            start=cursor,
            cursor=cursor,
        )

    def _begin(
        self,
        thing: bpy.types.Object,
        scene: bpy.types.Scene,
        frame: BodyFrame,
        touched: TouchedPlace,
    ) -> None:
        """Take hold of the body at a place."""
        drawn = open_body(thing, scene)
        metres = metres_per_unit(scene)
        radius = metres * self.radius or chosen_sizes(scene, drawn.size).tip_radius
        self.radius = radius / metres
        grips = grips_at(drawn, touched.rest, radius, tuple(self.mirrored))
        self._touched, self._frame, self._handle = touched, frame, ObjectHandle.of(thing)
        self._stroke = stroke_of(thing, drawn, grips)

    def _hang(self, thing: bpy.types.Object) -> None:
        """Make all that the stroke changes ready."""
        self._stroke.make_ready(thing)
        live_layer.hang(thing)

    def _give_up(self, thing: bpy.types.Object) -> None:
        """Have the object as it was."""
        live_layer.remove(thing)
        self._stroke.give_back(thing)

    def _handle_event(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        pressed = event.value == "PRESS"
        if pressed and event.type in {"ESC", "RIGHTMOUSE"}:
            self._leave(context, give_up=True)
            return {"CANCELLED"}
        released = event.type == "LEFTMOUSE" and event.value == "RELEASE"
        if released or (pressed and event.type in {"RET", "NUMPAD_ENTER"}):
            return self._finish(context)
        typed = self._typed.after(event)
        if typed is not None:
            self._typed = typed
        if typed is not None or event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}:
            pressure = event.pressure if event.is_tablet else 0.0
            cursor = event.mouse_x, event.mouse_y
            drag = self._drag.dragged(cursor, pressure, sliding=event.ctrl)
            self._drag = replace(drag, typed=self._typed.value(context.scene))
            self._follow(context)
        elif event.type == "TIMER" and self._stroke.moves:
            self._follow(context)
        return {"RUNNING_MODAL"}

    def _follow(self, context: bpy.types.Context) -> None:
        """Draw the stroke as the pointer or the keyboard has it now."""
        scene, thing = context.scene, self._thing()
        wanted = self._drag.asked(self._touched.turn)
        problem = ""
        try:
            self._last = self._stroke.towards(wanted)
            if self._last[1].ends:
                problem = f"   {shown(self._last[1].ends)}"
        except PalpateError as refused:
            # As far as it went; back from there the stroke goes on.
            problem = f"   {shown(refused)}"
        asked, stroked = self._last
        draw(thing, self._stroke, stroked)
        text = f"{stroke_words.figures(scene, asked, stroked)}{problem}"
        if self._typed.text:
            text = f"[{self._typed.text}|]   {text}"
        self._stay.head(context, text)

    def _finish(self, context: bpy.types.Context) -> set[str]:
        if self._last[0].nothing:
            # A click moves nothing, and leaves nothing.
            self._leave(context, give_up=True)
            return {"CANCELLED"}
        scene, thing = context.scene, self._thing()
        with wait_cursor(context):
            asked, stroked = self._ended(thing)
        self.tell(asked, self._frame, self._touched.turn)
        try:
            self._keep(scene, thing, asked, stroked)
        except NothingStaysError as problem:
            self._leave(context, give_up=True)
            self.report({"INFO"}, reported(problem))
            return {"CANCELLED"}
        self._leave(context, give_up=False)
        return {"FINISHED"}

    def _keep(
        self, scene: bpy.types.Scene, thing: bpy.types.Object, asked: Asked, stroked: Stroked
    ) -> None:
        self.force = stroked.force
        figures = stroke_words.figures(scene, asked, stroked)
        if stroked.springs_back and stroked.lying is not None:
            live_layer.remove(thing)
            self._stroke.leave(thing, stroked)
            self.report({"INFO"}, reported("{figures}, let go and at rest", figures=figures))
            return
        name = kept_imprint.keep(thing, scene, self._stroke.drawn.frame)
        self.report({"INFO"}, reported("{figures}, kept as '{name}'", figures=figures, name=name))

    def _ended(self, thing: bpy.types.Object) -> tuple[Asked, Stroked]:
        """What came of the stroke once all is at rest."""
        asked, stroked = self._stroke.ended(*self._last)
        if stroked is not self._last[1]:
            draw(thing, self._stroke, stroked)
        return asked, stroked

    def _leave(self, context: bpy.types.Context, *, give_up: bool) -> None:
        thing = self._handle.find()
        if give_up and thing is not None:
            self._give_up(thing)
        self._stroke.close()
        self._stay.end(context)

    def _thing(self) -> bpy.types.Object:
        thing = self._handle.find()
        if thing is None:
            raise PalpateError("{name} is gone; choose another object", name=self._handle.name)
        if live_layer.find(thing) is None:
            # A script, undo or another tool took it.
            raise PalpateError("{name} has lost its live layer; stroke again", name=thing.name)
        return thing


classes = (PALPATE_OT_stroke,)
