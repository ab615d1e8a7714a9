"""Press: touch a soft object with pointer, pen or device, then keep the shape or restore it."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ..core.errors import PalpateError
from . import press_session, ray, soft_object, viewport
from .package_preferences import preferences
from .press_once import press_once
from .press_session import PressSession
from .press_state import Cancel, Keep, Move, Phase, Point, Release, SetDown, Source
from .probe_drag import ProbeDrag
from .viewport import Viewport, redraw_views

FRAMES_PER_SECOND = 60
# The probe is set down this far above the surface, as a share of the body's size: from outside.
SET_DOWN_HEIGHT = 1e-4

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


class PALPATE_OT_press(bpy.types.Operator):
    bl_idname = "palpate.press"
    bl_label = "Press"
    bl_description = (
        "Press the soft object with the pointer or a device. Enter keeps the shape, Escape "
        "restores it. From scripts: EXEC_DEFAULT with at and by"
    )
    bl_options = {"UNDO"}

    at: bpy.props.FloatVectorProperty(
        name="At",
        description="The surface point nearest to this is touched, world coordinates",
        subtype="TRANSLATION",
        options={"SKIP_SAVE"},
    )
    by: bpy.props.FloatVectorProperty(
        name="By",
        description="How far it is moved, world axes",
        subtype="TRANSLATION",
        options={"SKIP_SAVE"},
    )
    keep: bpy.props.BoolProperty(
        name="Keep",
        description="Keep the shape as a shape key",
        default=True,
        options={"SKIP_SAVE"},
    )

    _session: PressSession
    _timer: bpy.types.Timer | None = None
    _drag: ProbeDrag | None = None
    _status = ""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        thing = context.object
        reason = soft_object.refusal(thing)
        if not reason and press_session.current() is not None:
            reason = "A press is going on; Enter keeps the shape, Escape restores it"
        if not reason and not thing.palpate.body_key:
            reason = f"{thing.name} is not soft yet; press Make Soft first"
        if reason:
            cls.poll_message_set(reason)
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not any(self.by):
            self.report({"ERROR"}, "press: 'by' is zero; say how far to press, in world units")
            return {"CANCELLED"}
        try:
            pressed = press_once(context.object, context.scene, self.at, self.by, keep=self.keep)
        except PalpateError as problem:
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        newton = float(np.linalg.norm(pressed.force))
        self.report({"INFO"}, f"{newton:.3g} N at {1000 * pressed.depth:.3g} mm")
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        thing = context.object
        if not thing.visible_get():
            self.report(
                {"ERROR"}, f"{thing.name} is hidden; show it (Object > Show/Hide) to press it"
            )
            return {"CANCELLED"}
        source = Source.POINTER if context.scene.palpate.source == "POINTER" else Source.DEVICE
        # A missing body file is computed again first, which may take a few seconds.
        context.window.cursor_modal_set("WAIT")
        try:
            self._session = press_session.begin(thing, context.scene, source)
        except PalpateError as problem:
            self.report({"ERROR"}, str(problem))
            redraw_views()
            return {"CANCELLED"}
        finally:
            context.window.cursor_modal_restore()
        manager = context.window_manager
        self._timer = manager.event_timer_add(1 / FRAMES_PER_SECOND, window=context.window)
        manager.modal_handler_add(self)
        self._show(context)
        redraw_views()
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        try:
            passed = self._handle(context, event)
        except PalpateError as problem:
            press_session.give_way("")
            self._leave(context)
            self.report({"ERROR"}, str(problem))
            return {"CANCELLED"}
        except BaseException:
            # A fault of ours must not leave a servo running and a live key in the mesh.
            press_session.give_way("Pressing has ended because of an error")
            self._leave(context)
            raise
        for said in self._session.said:
            self.report({"WARNING" if said.warning else "INFO"}, said.text)
        self._session.said.clear()
        if self._session.state.phase is not Phase.ENDED:
            self._show(context)
            return {"PASS_THROUGH"} if passed else {"RUNNING_MODAL"}
        self._leave(context)
        if not self._session.kept_name:
            return {"CANCELLED"}
        self.report({"INFO"}, f"Kept as shape key '{self._session.kept_name}'")
        return {"FINISHED"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: another file, unregister, or exit."""
        press_session.give_way("")
        self._leave(context)

    def _handle(self, context: bpy.types.Context, event: bpy.types.Event) -> bool:
        """Act on an event; True if Blender shall have it too."""
        session = self._session
        if event.type == "TIMER":
            if session.tick():
                redraw_views()
            return True
        # First of all, wherever the pointer is.
        if _strikes_force_key(event) and session.state.source is Source.DEVICE:
            session.switch_force()
            return False
        if _is_blenders(event) or viewport.over_file_browser(context.window, event):
            return True
        here = viewport.under_pointer(context.window, event.mouse_x, event.mouse_y)
        last = _ending(event, over_view=here is not None, dented=session.displacements is not None)
        if last is not None:
            session.post(last)
        elif session.state.phase is Phase.DRAGGING:
            self._follow(event)
        elif here is None or self._is_navigation(event, here):
            return True
        elif event.type == "LEFTMOUSE" and event.value == "PRESS":
            self._set_down(here, event)
        return False

    def _is_navigation(self, event: bpy.types.Event, here: Viewport) -> bool:
        if event.type in NAVIGATION or event.type.startswith("NDOF"):
            return True
        if event.type != "LEFTMOUSE":
            return event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}
        return event.alt or here.over_gizmos()

    def _set_down(self, here: Viewport, event: bpy.types.Event) -> None:
        session = self._session
        if session.state.source is not Source.POINTER:
            return
        drawn = session.drawn
        triangles = drawn.body.mesh.surface_triangles
        origin, direction = here.ray(drawn.frame)
        hit = ray.first_hit(origin, direction, session.surface_now(), triangles)
        if hit is None:
            return
        corners = triangles[hit.triangle]
        nodes = drawn.body.mesh.nodes
        point = hit.alpha @ nodes[corners]
        normal = hit.alpha @ ray.node_normals(nodes, triangles)[corners]
        normal /= np.linalg.norm(normal)
        view = here.view_at(point, drawn.frame)
        if view is None:
            return
        self._drag = ProbeDrag(
            point=point,
            normal=normal,
            view=view,
            size=drawn.size,
            start=(event.mouse_x, event.mouse_y),
            sensitivity=preferences().sensitivity,
        )
        self._drag = self._drag.dragged(self._drag.start, _pressure(event))
        session.post(SetDown(_tuple(point + SET_DOWN_HEIGHT * drawn.size * normal)))

    def _follow(self, event: bpy.types.Event) -> None:
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self._session.post(Release())
            return
        if self._drag is None:
            # Not set down yet: there is nothing to lead.
            return
        if event.type == "WHEELUPMOUSE":
            self._drag = self._drag.wheeled(1)
        elif event.type == "WHEELDOWNMOUSE":
            self._drag = self._drag.wheeled(-1)
        elif event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}:
            cursor = (event.mouse_x, event.mouse_y)
            self._drag = self._drag.dragged(cursor, _pressure(event))
        else:
            return
        self._session.post(Move(_tuple(self._drag.target)))

    def _show(self, context: bpy.types.Context) -> None:
        status = f"Palpate: {STATUS.get(self._session.state.phase, '')}"
        if status != self._status:
            self._status = status
            context.workspace.status_text_set(status)

    def _leave(self, context: bpy.types.Context) -> None:
        if self._timer is not None:
            context.window_manager.event_timer_remove(self._timer)
            self._timer = None
        if context.workspace is not None:
            context.workspace.status_text_set(None)
        redraw_views()


def _is_blenders(event: bpy.types.Event) -> bool:
    """What Blender tells itself (smooth view, playback, banners), and saving, opening, quitting."""
    internal = event.type.startswith("TIMER") or event.type in {"NONE", "WINDOW_DEACTIVATE"}
    return internal or (event.type in FILE_KEYS and (event.ctrl or event.oskey))


def _strikes_force_key(event: bpy.types.Event) -> bool:
    """A first strike; a key that is held goes on striking."""
    return event.type == "SPACE" and event.value == "PRESS" and not event.is_repeat


def _ending(event: bpy.types.Event, *, over_view: bool, dented: bool) -> Cancel | Keep | None:
    """How an event ends the press, if it does."""
    if event.value != "PRESS":
        return None
    undoes = event.type == "Z" and (event.ctrl or event.oskey)
    if event.type == "ESC" or undoes or (event.type == "RIGHTMOUSE" and over_view):
        return Cancel()
    return Keep(dented) if event.type in {"RET", "NUMPAD_ENTER"} else None


def _pressure(event: bpy.types.Event) -> float:
    return event.pressure if event.is_tablet else 0.0


def _tuple(vector: NDArray[np.float64]) -> Point:
    x, y, z = vector.tolist()
    return (x, y, z)


classes = (PALPATE_OT_press,)
