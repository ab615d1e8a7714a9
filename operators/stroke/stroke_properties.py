"""Properties of a stroke: what it did, and what the redo panel changes."""

from __future__ import annotations

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ..place.seen_place import SeenPlace
from ..reporting.quantities import newtons
from ..reporting.translated import shown
from ..scene.body_frame import BodyFrame
from ..scene.drawn_surface import frame_of, metres_per_unit
from .answer.motion import Asked, Motion

Array = NDArray[np.float64]

MOTION_ITEMS = [
    ("PUSH", "Push", "A fingertip presses in along the surface's normal; outward it pulls"),
    ("GRAB", "Grab", "The touched patch follows the pointer in the plane of the view"),
    ("TWIST", "Twist", "The touched patch is turned about the surface's normal"),
    ("PINCH", "Pinch", "The touched patch is drawn together, or spread"),
]


# Properties that a motion asks.
ASKED = {"PUSH": ("depth", "by"), "GRAB": ("by",), "TWIST": ("angle",), "PINCH": ("share",)}


class StrokeProperties:
    """Part of an operator that strokes; lengths in scene units."""

    motion: bpy.props.EnumProperty(
        name="Motion",
        description="What the stroke does",
        items=MOTION_ITEMS,
        options={"SKIP_SAVE"},
    )
    place: bpy.props.FloatVectorProperty(
        name="Place",
        description="The surface point nearest to this is touched, world coordinates",
        subtype="TRANSLATION",
        options={"SKIP_SAVE"},
    )
    depth: bpy.props.FloatProperty(
        name="Depth",
        description="How far the place is pushed in; below zero it is pulled out",
        subtype="DISTANCE",
        options={"SKIP_SAVE"},
    )
    by: bpy.props.FloatVectorProperty(
        name="By",
        description="How far the place is moved, or a push goes along the surface, world axes",
        subtype="TRANSLATION",
        options={"SKIP_SAVE"},
    )
    angle: bpy.props.FloatProperty(
        name="Angle",
        description="How far the patch is turned, counter-clockwise seen from outside",
        subtype="ANGLE",
        options={"SKIP_SAVE"},
    )
    share: bpy.props.FloatProperty(
        name="Drawn In",
        description="How far the patch is drawn together: 1 to a line; below zero it is spread",
        soft_min=-1.0,
        max=1.0,
        options={"SKIP_SAVE"},
    )
    radius: bpy.props.FloatProperty(
        name="Radius",
        description="Radius of the fingertip or patch; 0 for the tool's",
        subtype="DISTANCE",
        min=0.0,
        options={"SKIP_SAVE"},
    )
    mirrored: bpy.props.BoolVectorProperty(
        name="Mirrored",
        description="Mirror the stroke across the object's axes",
        subtype="XYZ",
        options={"SKIP_SAVE"},
    )
    outward: bpy.props.BoolProperty(
        name="Other Direction",
        description="Pull, turn back or spread",
        options={"SKIP_SAVE", "HIDDEN"},
    )
    # What was touched: when the redo panel has undone the stroke, another object is active.
    object_name: bpy.props.StringProperty(options={"SKIP_SAVE", "HIDDEN"})
    object_matrix: bpy.props.FloatVectorProperty(size=16, options={"SKIP_SAVE", "HIDDEN"})
    force: bpy.props.FloatProperty(options={"SKIP_SAVE", "HIDDEN"})

    def remember(self, seen: SeenPlace) -> None:
        """Take over what was touched."""
        self.place, self.object_name = seen.seen, seen.thing.name
        self.object_matrix = seen.frame.matrix.ravel()

    def remembered(self, context: bpy.types.Context) -> bpy.types.Object | None:
        """The object that was touched; the active one where none was.

        Raises
        ------
        PalpateError
            It is gone.
        """
        if not self.object_name:
            return context.object
        # Strokes are of objects of this file.
        thing = bpy.data.objects.get((self.object_name, None))
        if thing is None or thing.name not in context.view_layer.objects:
            raise PalpateError("{name} is gone; choose another object", name=self.object_name)
        return thing

    def remembered_frame(self, thing: bpy.types.Object, scene: bpy.types.Scene) -> BodyFrame:
        """Frame of the object, or of its instance that was touched.

        Raises
        ------
        PalpateError
            A transform that is not finite or flattens the object.
        """
        if not any(self.object_matrix):
            return frame_of(thing, scene)
        matrix = np.reshape(self.object_matrix, (4, 4))
        return BodyFrame.of_matrix(matrix, metres_per_unit(scene))

    def asked(self, frame: BodyFrame, turn: Array) -> Asked:
        """What is asked of a body whose object is in a frame; ``turn`` (3, 3) is from the axes at
        rest to those as seen.
        """
        by = frame.turn_to_body(np.array(self.by)) * frame.metres_per_unit @ turn
        match motion := Motion[self.motion]:
            case Motion.GRAB:
                return Asked(motion, by=by)
            case Motion.TWIST:
                return Asked(motion, self.angle)
            case Motion.PINCH:
                return Asked(motion, self.share)
        return Asked(motion, self.depth * frame.metres_per_unit, by=by)

    def tell(self, asked: Asked, frame: BodyFrame, turn: Array) -> None:
        """Take over what was asked, for the redo panel."""
        metres = frame.metres_per_unit
        if asked.by is not None:
            self.by = frame.turn_to_world(turn @ asked.by) / metres
        match asked.motion:
            case Motion.TWIST:
                self.angle = asked.amount
            case Motion.PINCH:
                self.share = asked.amount
            case Motion.PUSH:
                self.depth = asked.amount / metres

    def draw(self, context: bpy.types.Context) -> None:
        layout: bpy.types.UILayout = self.layout  # type: ignore[attr-defined]  # of Operator
        layout.use_property_split = True
        layout.prop(self, "motion")
        for name in ASKED[self.motion]:
            layout.prop(self, name)
        layout.prop(self, "place")
        layout.prop(self, "radius")
        layout.prop(self, "mirrored", toggle=True)
        layout.label(text=shown("Force: {force}", force=newtons(self.force)), translate=False)
