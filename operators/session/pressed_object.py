"""Object under a press: whether it is still what the press began with, where its places are, and
the hands on it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.sentence import Sentence
from ...core.servo.session import Snapshot
from ..device.device_source import DeviceFrame
from ..layer import layers, live_layer, place_marks
from ..lying.pressed.pressed_prop import PressedProp
from ..object.drawn_body import DrawnBody
from ..place import touched_place
from ..place.touched_place import TouchedPlace
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import frame_of
from ..scene.object_handle import ObjectHandle
from .finger_leads import BOTH_POINTER, FingerLead, Lead
from .led_loop import free_places

Array = NDArray[np.float64]


def reason_to_end(thing: bpy.types.Object | None, drawn: DrawnBody, *, withdrawn: bool) -> str:
    """Reason why a press cannot continue on an object, {name} for its name; empty if it can."""
    if thing is None:
        return "{name} was deleted; pressing has ended"
    if thing.mode != "OBJECT":
        return "{name} is being edited; pressing has ended"
    if 3 * len(layers.drawn_mesh(thing).vertices) != len(drawn.rest):
        return "{name} was edited; press Make Soft to bake it again"
    if not withdrawn and live_layer.find(thing) is None:
        return "{name} has lost its live layer; pressing has ended"
    return ""


def moved_along(
    thing: bpy.types.Object, scene: bpy.types.Scene, drawn: DrawnBody
) -> DrawnBody | None:
    """The body where the object is now; None if it was scaled, sheared or flattened."""
    try:
        return drawn.moved_to(frame_of(thing, scene))
    except PalpateError:
        # A flattened object has changed its scale too.
        return None


def places_along(
    thing: bpy.types.Object,
    frame: BodyFrame,
    places: Sequence[TouchedPlace | None],
    free: Sequence[Array | None],
) -> tuple[TouchedPlace | None, ...]:
    """Each finger's place: the touched one as it is seen now, or the nearest one to a finger that
    is ``free``, (3,), world coordinates; None at rest. ``frame`` is the object's.
    """
    marked = place_marks.hung(thing)
    return tuple(
        touched_place.nearest(thing, frame, finger)
        if marked and finger is not None
        else None
        if place is None
        else place.followed(thing, frame)
        for place, finger in zip(places, free, strict=True)
    )


def local_frames(frame: BodyFrame, places: Sequence[TouchedPlace | None]) -> tuple[BodyFrame, ...]:
    """Local frame of each finger's place, by the object's."""
    return tuple(frame if place is None else place.frame(frame) for place in places)


@dataclass(eq=False)
class PressedObject:
    """Object under a press.

    ``leads`` move the fingers, ``places`` are what each touches: it feels the body in the local
    frame of its own. ``homes`` are the frames of devices that no Empty places, None for a finger
    without a device. ``prop`` is the object where nobody holds it, and ``snapshot`` the last tick
    as seen from its body.
    """

    handle: ObjectHandle
    scene_name: str
    drawn: DrawnBody
    homes: tuple[DeviceFrame | None, ...]
    leads: tuple[FingerLead, ...] = (FingerLead(Lead.POINTER),)
    prop: PressedProp | None = None
    snapshot: Snapshot | None = None
    places: tuple[TouchedPlace | None, ...] = ()
    _hands: dict[int, BodyFrame] = field(default_factory=dict)

    @property
    def scene(self) -> bpy.types.Scene:
        """Scene in which the press began, or the present one if that is gone."""
        return bpy.data.scenes.get(self.scene_name) or bpy.context.scene

    @property
    def frames(self) -> tuple[BodyFrame, ...]:
        """Local frame of the body of each finger."""
        return local_frames(self.drawn.frame, self.places)

    @property
    def hands(self) -> tuple[BodyFrame, ...]:
        """Frame in which each finger is led: its local one, or the world, moved to where the place
        is seen.
        """
        if self.prop is None:
            return self.frames
        return tuple(self._hands.get(one, self.prop.world) for one in range(len(self.leads)))

    @property
    def air(self) -> float:
        """How far off the surface at rest fingers are set down, metres."""
        return 0.0 if self.prop is None else self.prop.air

    @property
    def home(self) -> BodyFrame:
        """Frame of the object in which homes are."""
        return self.drawn.frame if self.prop is None else self.prop.drawn.frame

    @property
    def pinches(self) -> bool:
        """Whether the pointer has two handles."""
        return self.leads == BOTH_POINTER

    def touch(self, place: TouchedPlace, thing: bpy.types.Object, finger: int = 0) -> None:
        """Press at a place as it is seen from now on, by one of the fingers."""
        self.places = (*self.places[:finger], place, *self.places[finger + 1 :])
        if self.prop is not None:
            self._hands[finger] = self.prop.hand(place)
        self.follow_frame(thing)

    def follow_frame(self, thing: bpy.types.Object) -> bool:
        """Follow the object; False if it was scaled, sheared or flattened."""
        moved = moved_along(thing, self.scene, self.drawn)
        if moved is None or self.prop is not None:
            # The servo says where it is.
            return moved is not None
        self.drawn = moved
        free = free_places(self.leads, self.snapshot, self.frames)
        self.places = places_along(thing, moved.frame, self.places, free)
        return True

    def others_that_end(self) -> list[str]:
        """Of each object that moves with it the reason why the press cannot continue; empty if it
        can.
        """
        others = () if self.prop is None else self.prop.others
        # What shows them is no live layer.
        reasons = (reason_to_end(one.handle.find(), one.drawn, withdrawn=True) for one in others)
        return [
            Sentence(reason, name=one.handle.name)
            for one, reason in zip(others, reasons, strict=True)
        ]

    def as_seen(self, thing: bpy.types.Object, snapshot: Snapshot, *, withdrawn: bool) -> Snapshot:
        """A tick as the body sees it, and the object where that left it."""
        if self.prop is None:
            return snapshot
        if not withdrawn:
            self.drawn = self.prop.follow(thing, self.drawn, snapshot)
        return snapshot.seen_from_body()
