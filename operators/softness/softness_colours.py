"""Map Softness: stiffness over the surface as a colour attribute, and its removal."""

import bpy
import numpy as np
from numpy.typing import NDArray

from ...core.sentence import Sentence
from ...core.softness.force_depth import MILLIMETRES
from ...core.softness.ramp import ramp
from ...core.softness.softness_map import softness_map
from ..object import soft_object
from ..object.drawn_body import DrawnBody
from ..reporting.acting import Acting
from ..reporting.translated import reported
from ..scene.drawn_surface import rest_coordinates
from .softness_operator import SoftnessOperator

ATTRIBUTE = "Palpate Softness"
# For shaders and geometry nodes: how far a newton goes in, metres.
SOFTNESS = "palpate_softness"


class PALPATE_OT_map_softness(SoftnessOperator, bpy.types.Operator):
    bl_idname = "palpate.map_softness"
    bl_label = "Map Softness"
    bl_description = (
        "Colour the object by how hard a fingertip must push for each millimetre: dark is soft, "
        "yellow is firm. Writes the colour attribute Palpate Softness and shows it in the view, "
        "and the number palpate_softness (m/N) for shaders"
    )
    asks_everywhere = True

    def measure(self, context: bpy.types.Context, drawn: DrawnBody) -> None:
        thing = context.object
        softness = thing.palpate_softness
        found = softness_map(
            drawn.body,
            pad_radius=drawn.frame.metres_per_unit * softness.finger_radius,
            young_modulus=thing.palpate.young_modulus,
        )
        shown = thing.data.color_attributes.active_color_name
        if shown != ATTRIBUTE:
            softness.shown_before = shown
        _write(thing.data, ramp(_at_vertices(thing, drawn, found.shares())))
        _write_softness(thing.data, _at_vertices(thing, drawn, 1.0 / found.stiffness))
        softness.map_low, softness.map_high = (end / MILLIMETRES for end in found.span)
        self.report({"INFO"}, reported("Viewport Shading > Color > Attribute shows it"))


class PALPATE_OT_remove_softness_map(Acting, bpy.types.Operator):
    bl_idname = "palpate.remove_softness_map"
    bl_label = "Remove Softness Map"
    bl_description = "Delete the attributes Palpate Softness and palpate_softness"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def refusal(cls, context: bpy.types.Context) -> str:
        reason = soft_object.refusal(context.object)
        if not reason and ATTRIBUTE not in context.object.data.color_attributes:
            reason = Sentence("{name} has no softness map", name=context.object.name)
        return reason

    def act(self, context: bpy.types.Context) -> None:
        mesh = context.object.data
        softness = context.object.palpate_softness
        mesh.color_attributes.remove(mesh.color_attributes[ATTRIBUTE])
        if SOFTNESS in mesh.attributes:
            mesh.attributes.remove(mesh.attributes[SOFTNESS])
        if softness.shown_before in mesh.color_attributes:
            mesh.color_attributes.active_color_name = softness.shown_before
        for name in ("map_low", "map_high", "shown_before"):
            softness.property_unset(name)


def _at_vertices(
    thing: bpy.types.Object, drawn: DrawnBody, of_nodes: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Values of the object's vertices (p,) from those of the surface nodes (s,) around each."""
    local = rest_coordinates(thing.data).reshape(-1, 3)
    places = drawn.at_rest.closest_points.query(drawn.frame.body_from_local(local))
    corners = drawn.body.mesh.surface_local_triangles[places.triangle]
    values: NDArray[np.float64] = np.einsum("pc,pc->p", places.alpha, of_nodes[corners])
    return values


def _write_softness(mesh: bpy.types.Mesh, softness: NDArray[np.float64]) -> None:
    """Write metres per newton (p,) to the vertices."""
    old = mesh.attributes.get(SOFTNESS)
    if old is not None:
        mesh.attributes.remove(old)
    attribute = mesh.attributes.new(SOFTNESS, "FLOAT", "POINT")
    attribute.data.foreach_set("value", softness.astype(np.float32))


def _write(mesh: bpy.types.Mesh, colours: NDArray[np.float64]) -> None:
    """Write colours (p, 3), sRGB, to the vertices; shown in the view, while renders keep theirs."""
    attributes = mesh.color_attributes
    rendered = attributes.default_color_name
    old = attributes.get(ATTRIBUTE)
    if old is not None:
        attributes.remove(old)
    attribute = attributes.new(ATTRIBUTE, "FLOAT_COLOR", "POINT")
    flat = np.ones((len(colours), 4), dtype=np.float32)
    # Attributes of floats hold scene linear colours.
    dark = colours <= 0.04045
    flat[:, :3] = np.where(dark, colours / 12.92, ((colours + 0.055) / 1.055) ** 2.4)
    attribute.data.foreach_set("color", flat.ravel())
    attributes.active_color_name = ATTRIBUTE
    if rendered:
        attributes.default_color_name = rendered
    mesh.update()


classes = (PALPATE_OT_map_softness, PALPATE_OT_remove_softness_map)
