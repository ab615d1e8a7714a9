"""Base of the modal operators Press and Pinch: from window events to a running press."""

from __future__ import annotations

import bpy

from ...core.errors import PalpateError
from ..object import soft_object
from ..reporting.acting import Acting
from ..reporting.translated import reported, shown
from ..reporting.wait_cursor import wait_cursor
from ..scene import viewport
from ..scene.modal_stay import ModalStay
from ..scene.viewport import Viewport, redraw_views
from ..session import press_session
from ..session.pointer_hand import PointerHand
from ..session.press_events import Keep, Moment, Source
from ..session.press_session import PressSession
from ..session.press_state import Phase

FRAMES_PER_SECOND = 60

NAVIGATION = {
    "MIDDLEMOUSE",
    "WHEELUPMOUSE",
    "WHEELDOWNMOUSE",
    "WHEELINMOUSE",
    "WHEELOUTMOUSE",
    "TRACKPADPAN",
    "TRACKPADZOOM",
    "MOUSEROTATE",
    "MOUSESMARTZOOM",
    "HOME",
    "ACCENT_GRAVE",
    "N",
    *(f"NUMPAD_{key}" for key in (*range(10), "PERIOD", "PLUS", "MINUS", "SLASH")),
}
FILE_KEYS = {"S", "O", "Q"}
STATUS = {
    Phase.READY: "Drag on the surface: Press     [Enter] Keep     [Esc] Restore",
    Phase.DRAGGING: "Drag: In and along     [Wheel] Deeper",
    Phase.HOLDING: "Drag on the surface: Press again     [Enter] Keep     [Esc] Restore",
    Phase.FEELING: "The device presses     [Space] Force Off/On     [Enter] Keep     [Esc] Restore",
    Phase.LOST: "The device is away     [Space] Force Off/On     [Esc] Restore",
}
PINCH_STATUS = {
    Phase.READY: "Drag a handle: Pinch     [Enter] Keep     [Esc] Restore",
    Phase.HOLDING: "Drag a handle: Pinch     [Enter] Keep     [Esc] Restore",
}
EMPTY_STATUS = {
    Phase.FEELING: "Move the Empty or play the animation     [Enter] Keep     [Esc] Restore",
}


class Pressing(Acting):
    """Operator that presses the active object."""

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        reason = soft_object.refusal(context.object) or press_session.refusal()
        if not reason and _strokes(context):
            reason = "A stroke is going on; let go of the button first"
        return reason or soft_object.refusal_unbaked(context.object)


class ModalPress(Pressing):
    """Modal part of a pressing operator; mixin of Press and Pinch."""

    _session: PressSession
    _hand: PointerHand
    _stay: ModalStay
    _status = ""

    def start(self, context: bpy.types.Context, source: Source, *, pinch: bool) -> set[str]:
        """Start to press the active object and to receive events.

        Raises
        ------
        PalpateError
            It is hidden; as of :func:`press_session.begin`.
        """
        thing = context.object
        if not thing.visible_get():
            raise PalpateError(
                "{name} is hidden; show it (Object > Show/Hide) to press it", name=thing.name
            )
        # A missing body file is recomputed first, which may take a few seconds.
        with wait_cursor(context):
            try:
                self._session = press_session.begin(thing, context.scene, source, pinch=pinch)
                self._hand = PointerHand(self._session, (0, 1) if pinch else (0,))
                if context.area is not None and context.area.type == "VIEW_3D":
                    self._session.area = context.area.as_pointer()
                if pinch:
                    self._hand.place_on_both_sides(context.space_data.region_3d)
            except PalpateError:
                press_session.give_way("")
                redraw_views()
                raise
        self._stay = ModalStay()
        self._stay.begin(self, context, 1 / FRAMES_PER_SECOND)
        self._show(context)
        redraw_views()
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        try:
            passed = self._handle(context, event)
        except PalpateError as problem:
            press_session.give_way("")
            self._stay.end(context)
            self.report({"ERROR"}, reported(problem))
            return {"CANCELLED"}
        except BaseException:
            # A bug must not leave a running servo and a live layer on the mesh.
            press_session.give_way("Pressing has ended because of an error")
            self._stay.end(context)
            raise
        for said in self._session.said:
            self.report({"WARNING" if said.warning else "INFO"}, reported(said.text))
        self._session.said.clear()
        if self._session.state.phase is not Phase.ENDED:
            self._show(context)
            return {"PASS_THROUGH"} if passed else {"RUNNING_MODAL"}
        self._stay.end(context)
        if not self._session.kept:
            return {"CANCELLED"}
        if self._session.kept_name:
            name = self._session.kept_name
            self.report({"INFO"}, reported("Kept as layer '{layer}'", layer=name))
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """End with the operator: another file, unregister, or exit."""
        press_session.give_way("")
        self._stay.end(context)

    def _handle(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Handle an event; True to pass it on to Blender."""
        session = self._session
        if event.type == "TIMER":
            if session.tick():
                redraw_views()
            return True
        # First of all, wherever the pointer is.
        if _strikes_force_key(event) and session.state.has_device:
            session.switch_force()
            return False
        if _is_blenders(event) or viewport.over_file_browser(context.window, event):
            return True
        here = viewport.under_pointer(context.window, event.mouse_x, event.mouse_y)
        empties = session.state.source is Source.EMPTY
        thing = session.handle.find()
        dented = thing is not None and session.seen.stays(thing)
        # The right button still opens menus while an Empty is moved by hand.
        last = _ending(event, over_view=here is not None and not empties, dented=dented)
        if last is not None:
            session.post(last)
        elif session.state.phase is Phase.DRAGGING:
            self._hand.follow(event)
        elif here is None or empties or self._is_navigation(event, here):
            return True
        elif _strikes_button(event) and session.state.source is Source.POINTER:
            self._hand.press(here, event)
        return False

    def _is_navigation(self, event: bpy.types.Event, here: Viewport) -> bool:
        if event.type in NAVIGATION or event.type.startswith("NDOF"):
            return True
        if event.type != "LEFTMOUSE":
            return event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}
        return event.alt or here.over_gizmos()

    def _show(self, context: bpy.types.Context) -> None:
        state = self._session.state
        words = STATUS
        if self._session.pinches:
            words = STATUS | PINCH_STATUS
        elif state.source is Source.EMPTY:
            words = STATUS | EMPTY_STATUS
        status = f"Palpate: {shown(words.get(state.phase, ''))}"
        if status != self._status:
            self._status = status
            self._stay.say(context, status)


def _strokes(context: bpy.types.Context) -> bool:
    """Whether a stroke is being dragged: a script may ask for a press meanwhile."""
    running = context.window.modal_operators if context.window is not None else ()
    return any(operator.bl_idname == "PALPATE_OT_stroke" for operator in running)


def _is_blenders(event: bpy.types.Event) -> bool:
    """Whether an event is Blender's own: smooth view, playback, banners, save, open, quit."""
    internal = event.type.startswith("TIMER") or event.type in {"NONE", "WINDOW_DEACTIVATE"}
    return internal or (event.type in FILE_KEYS and (event.ctrl or event.oskey))


def _strikes_force_key(event: bpy.types.Event) -> bool:
    """Whether the force key is struck, not repeated by being held."""
    return event.type == "SPACE" and event.value == "PRESS" and not event.is_repeat


def _strikes_button(event: bpy.types.Event) -> bool:
    return event.type == "LEFTMOUSE" and event.value == "PRESS"


def _ending(event: bpy.types.Event, *, over_view: bool, dented: bool) -> Moment | Keep | None:
    """End of the press by an event, if it is one."""
    if event.value != "PRESS":
        return None
    undoes = event.type == "Z" and (event.ctrl or event.oskey)
    if event.type == "ESC" or undoes or (event.type == "RIGHTMOUSE" and over_view):
        return Moment.CANCEL
    return Keep(dented) if event.type in {"RET", "NUMPAD_ENTER"} else None
