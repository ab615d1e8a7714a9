"""Fingers set down by the pointer, and the one that follows it now."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy
import numpy as np
from bpy_extras import view3d_utils
from mathutils import Vector
from numpy.typing import NDArray

from ...core.contact.tool.pose import resting_on
from ..place import touched_place
from ..place.touched_place import TouchedPlace
from ..scene.body_frame import as_point
from ..scene.drawn_surface import frame_of
from ..scene.package_preferences import preferences
from ..scene.probe_drag import ProbeDrag
from ..scene.viewport import Viewport
from ..tool import tool_turn
from ..tool.tool_turn import Turn
from .press_events import Moment, Move, SetDown
from .press_session import PressSession

Array = NDArray[np.float64]

# Height of a probe above the surface when set down, as a share of the body's size.
SET_DOWN_HEIGHT = 1e-4
# Distance at which a handle is grabbed, unscaled pixels.
GRAB_PIXELS = 24.0


@dataclass(frozen=True, eq=False)
class Held:
    """Finger that was set down: its target, the outward normal there, and how much deeper it may
    go, metres.
    """

    target: Array
    normal: Array
    deeper: float


@dataclass(eq=False)
class PointerHand:
    """Fingers of the pointer by number: one for a press, two for a pinch."""

    session: PressSession
    fingers: tuple[int, ...] = (0,)
    held: dict[int, Held] = field(default_factory=dict)
    _drag: ProbeDrag | None = None
    _finger: int = 0

    @property
    def leads(self) -> int | None:
        """Finger that follows the pointer now, if any."""
        return None if self._drag is None else self._finger

    def press(self, here: Viewport, event: bpy.types.Event) -> None:
        """Handle a pressed button: on a handle, on the surface, or beside both."""
        grabbed = self._handle_near(here)
        if grabbed is not None:
            held = self.held[grabbed]
            if self._begin(here, event, grabbed, held):
                self.session.post(Moment.GRAB)
            return
        thing = self.session.handle.find()
        place = None if thing is None else self._touched(thing, here)
        if place is None:
            return
        finger = self._free_finger(here)
        self.session.touch(place, thing, finger)
        view_axes = np.array(here.region_3d.view_matrix)[:3, :3]
        held, turn = self._at_rest(place.rest, view_axes, finger)
        if self._begin(here, event, finger, held):
            self.held[finger] = held
            self._set_down(finger, turn)

    def _touched(self, thing: bpy.types.Object, here: Viewport) -> TouchedPlace | None:
        """Place of the object under the pointer, as it is seen."""
        origin, along = here.line_of_sight()
        frame = frame_of(thing, self.session.scene)
        return touched_place.under_ray(thing, frame, origin, along)

    def follow(self, event: bpy.types.Event) -> None:
        """Handle pointer motion, wheel and released button."""
        if event.type == "LEFTMOUSE" and event.value == "RELEASE":
            self._drag = None
            self.session.post(Moment.RELEASE)
            return
        if self._drag is None:
            return
        if event.type == "WHEELUPMOUSE":
            self._drag = self._drag.wheeled(1)
        elif event.type == "WHEELDOWNMOUSE":
            self._drag = self._drag.wheeled(-1)
        elif event.type in {"MOUSEMOVE", "INBETWEEN_MOUSEMOVE"}:
            self._drag = self._drag.dragged((event.mouse_x, event.mouse_y), _pressure(event))
        else:
            return
        drag, target = self._drag, self._drag.target
        self.held[self._finger] = Held(target, drag.normal, drag.deepest - drag.depth)
        self.session.post(Move(as_point(target), self._finger))

    def place_on_both_sides(self, region_3d: bpy.types.RegionView3D) -> None:
        """Set two fingers down at the left and right of the object as it is seen."""
        thing = self.session.handle.find()
        if thing is None:
            return
        axes = np.array(region_3d.view_matrix)[:3, :3]
        corners = np.array([thing.matrix_world @ Vector(corner) for corner in thing.bound_box])
        middle = 0.5 * (corners.min(axis=0) + corners.max(axis=0))
        reach = float(np.linalg.norm(np.ptp(corners, axis=0)))
        frame = frame_of(thing, self.session.scene)
        for finger, side in zip(self.fingers, (-axes[0], axes[0]), strict=False):
            place = touched_place.under_ray(thing, frame, middle + reach * side, -side)
            if place is None:
                # No surface, as in a ring: a click sets it down.
                continue
            self.session.touch(place, thing, finger)
            self.held[finger], turn = self._at_rest(place.rest, axes, finger)
            self._set_down(finger, turn)
            self.session.post(Moment.RELEASE)

    def _at_rest(self, near: Array, view_axes: Array, finger: int) -> tuple[Held, Turn | None]:
        """A finger just out of contact with the place nearest to a point (3,), metres, and the
        rotation of its tool.
        """
        session = self.session
        point, normal = session.drawn.surface_place(near)
        tool = session.tip.tool
        to_hand = session.frames[finger].pose_in(session.hands[finger])
        outward = to_hand.rotation @ normal
        # Out of how an object that nobody holds bulges where it rests.
        point = point + session.air * normal
        if tool is None:
            start = point + SET_DOWN_HEIGHT * session.drawn.size * normal
            return Held(to_hand.to_world(start), outward, session.tip.deepest), None
        rotation = tool_turn.rotation(session.scene, session.frames[finger], normal, view_axes)
        pose = resting_on(tool, rotation, point, normal, session.seen.surface_samples)
        held = Held(to_hand.to_world(pose.position), outward, session.tip.deepest)
        return held, tool_turn.as_rows(to_hand.rotation @ rotation)

    def _begin(self, here: Viewport, event: bpy.types.Event, finger: int, held: Held) -> bool:
        """Start to drag a finger; False behind the viewer, where there is no scale."""
        view = here.view_at(held.target, self.session.hands[finger])
        if view is None:
            return False
        cursor = (event.mouse_x, event.mouse_y)
        drag = ProbeDrag(
            point=held.target,
            normal=held.normal,
            view=view,
            size=self.session.drawn.size,
            start=cursor,
            sensitivity=preferences().sensitivity,
            deepest=held.deeper,
        )
        self._drag, self._finger = drag.dragged(cursor, _pressure(event)), finger
        return True

    def _set_down(self, finger: int, turn: Turn | None) -> None:
        self.session.post(SetDown(as_point(self.held[finger].target), finger, turn))

    def _free_finger(self, here: Viewport) -> int:
        """Finger not set down yet, else the nearest on the screen."""
        for finger in self.fingers:
            if finger not in self.held:
                return finger
        return min(self.fingers, key=lambda finger: self._pixels_away(here, finger))

    def _handle_near(self, here: Viewport) -> int | None:
        """Handle of a pinch under the pointer; none for a press, which begins anew anywhere."""
        if len(self.fingers) == 1 or not self.held:
            return None
        nearest = min(self.held, key=lambda finger: self._pixels_away(here, finger))
        scale = bpy.context.preferences.system.ui_scale
        return nearest if self._pixels_away(here, nearest) <= GRAB_PIXELS * scale else None

    def _pixels_away(self, here: Viewport, finger: int) -> float:
        place = self.session.hands[finger].world_from_body(self.held[finger].target)
        seen = view3d_utils.location_3d_to_region_2d(here.region, here.region_3d, Vector(place))
        return np.inf if seen is None else float(np.hypot(*np.subtract(seen, here.cursor)))


def _pressure(event: bpy.types.Event) -> float:
    return event.pressure if event.is_tablet else 0.0
