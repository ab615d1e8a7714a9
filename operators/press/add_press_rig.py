"""Add Press Rig: sliders that push a place of a soft object along three axes, without Palpate."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.contact.place import nearest_place
from ...core.grip.held_patch import HeldPatch
from ...core.grip.motions import moved
from ...core.grip.patch import Grip
from ..layer import place_marks, press_rig
from ..object.drawn_body import DrawnBody
from ..place import touched_place
from ..reporting.translated import reported
from ..shape.held_body import open_held
from .modal_press import Pressing

Array = NDArray[np.float64]


class PALPATE_OT_add_press_rig(Pressing, bpy.types.Operator):
    bl_idname = "palpate.add_press_rig"
    bl_label = "Add Press Rig"
    bl_description = (
        "Give the soft object sliders X, Y and Z that push the place nearest to the 3D cursor: a "
        "modifier to animate and drive, which needs no Palpate. 1 moves the place by the radius"
    )
    bl_options = {"REGISTER", "UNDO"}

    use_cursor: bpy.props.BoolProperty(
        name="At 3D Cursor", description="The place nearest to the 3D cursor", default=True
    )
    at: bpy.props.FloatVectorProperty(
        name="At",
        description="The surface point nearest to this is touched, world coordinates",
        subtype="TRANSLATION",
    )
    radius: bpy.props.FloatProperty(
        name="Radius",
        description="How far around the place is moved along, of the body's size",
        subtype="FACTOR",
        default=0.08,
        min=0.005,
        max=0.5,
    )

    def act(self, context: bpy.types.Context) -> None:
        thing, scene = context.object, context.scene
        drawn = open_held(thing, scene)
        at = np.array(scene.cursor.location if self.use_cursor else self.at)
        with place_marks.marked(thing):
            rest = touched_place.nearest(thing, drawn.frame, at).rest
        rig = press_rig.add(thing, answers(drawn, rest, self.radius * drawn.size))
        self.report({"INFO"}, reported("Rig '{rig}' is a modifier now", rig=rig.name))


def answers(drawn: DrawnBody, rest: Array, radius: float) -> NDArray[np.float32]:
    """Displacements of the drawn vertices (3, p, 3), local units, where the place nearest to
    ``rest`` (3,), metres, is moved by the ``radius``, metres, along each of the object's axes.

    Raises
    ------
    PalpateError
        The place is pinned.
    """
    place = nearest_place(drawn.body, rest)
    normal = drawn.surface_place(rest)[1]
    grip = Grip(place.triangle, place.alpha, normal, radius)
    normals = drawn.node_normals[drawn.body.mesh.surface_nodes]
    held = HeldPatch.of(drawn.body, [grip], normals)
    axes = drawn.frame.body_from_local(np.eye(3))
    axes *= radius / np.linalg.norm(axes, axis=1, keepdims=True)
    return np.array(
        [drawn.displaced(held.displacements @ moved(axis)).reshape(-1, 3) for axis in axes]
    )


classes = (PALPATE_OT_add_press_rig,)
