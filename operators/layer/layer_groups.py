"""Node groups that displace a mesh by stored vectors: one of a kind in a file, shared by all.

Blender evaluates them without Palpate. Vectors are found by name among the attributes of the mesh
itself, or of a carrier: a hidden mesh whose vertices are those that modifiers make of the object's.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum

import bpy

from .group_building import GroupBuilder, Sockets

# Custom property of a group that was made here: its kind and the version of its nodes.
MARK, VERSION = "palpate_group", 1
DISPLACEMENT, CARRIER = "Displacement", "Carrier"
STRENGTH, LIVE, LEVEL = "Strength", "Live", "Level"
# Attributes that a press gives the vertices: places at rest, where the live layer finds them, and
# what that moves them by.
REST, AT, PRESSED = "palpate_rest", "palpate_at", "palpate_pressed"
# What the name of a layer's attribute has more for its traction, and attributes for shaders.
TRACTION = " Traction"
SUM, BORNE = "palpate_displacement", "palpate_traction"
PRESSURE, NORMAL = "palpate_pressure", "palpate_normal"
# Normals of the corners of faces, while these are divided.
SHADED = "palpate_shaded"
AXES = ("X", "Y", "Z")
DESCRIPTIONS = {
    DISPLACEMENT: "Attribute of the vertices that is added to their places, local units",
    CARRIER: "Mesh that has the attribute for the vertices that modifiers make; none: the mesh's",
    STRENGTH: "Factor on the displacement: 1 as it was pressed",
    LIVE: "Attribute of the layer that follows a press",
    LEVEL: "How often each edge is halved",
    "X": "Push along the X axis",
    "Y": "Push along the Y axis",
    "Z": "Push along the Z axis",
}

_SOURCE: Sockets = (("Geometry", "Geometry"), (CARRIER, "Object"), (DISPLACEMENT, "String"))


class Kind(Enum):
    """What a group adds to the places of the vertices."""

    LAYER = "layer"  # the attribute's vectors, times Strength
    FORCES = "forces"  # the same, and what the vertices bear as attributes
    RIG = "rig"  # of three attributes, "<name> X", Y and Z: each times its slider
    PLACES = "places"  # nothing; it gives the vertices their places at rest, and as they are
    FINE = "fine"  # nothing; it divides faces, so that a coarse mesh can show a dent
    STORED = "stored"  # within the others: the vectors of a name


@dataclass(frozen=True)
class _Plan:
    """Inputs of a group, and its one output: what it is of those."""

    inputs: Sockets
    result: Callable[[GroupBuilder], bpy.types.NodeSocket]


def group_of(kind: Kind) -> bpy.types.NodeTree:
    """The group of a kind in this file, made where there is none."""
    found = (group for group in bpy.data.node_groups if kind_of(group) is kind)
    return next((group for group in found if group.library is None), None) or _make(kind)


def kind_of(group: bpy.types.NodeTree | None) -> Kind | None:
    """The kind of a group, by its mark and its inputs; None for what is not of Palpate."""
    mark = None if group is None else group.get(MARK)
    kind = next((kind for kind in Kind if mark == _mark(kind)), None)
    if group is None or kind is None:
        return None
    found = tuple((item.name, item.socket_type.removeprefix("NodeSocket")) for item in _in(group))
    return kind if found == _PLANS[kind].inputs else None


def socket(group: bpy.types.NodeTree, name: str) -> str:
    """Identifier of an input: the key of its value in a modifier."""
    identifier: str = next(item.identifier for item in _in(group) if item.name == name)
    return identifier


def _mark(kind: Kind) -> str:
    return f"{kind.value} {VERSION}"


def _in(group: bpy.types.NodeTree) -> list[bpy.types.NodeTreeInterfaceSocket]:
    items = group.interface.items_tree
    return [item for item in items if item.item_type == "SOCKET" and item.in_out == "INPUT"]


def _make(kind: Kind) -> bpy.types.NodeTree:
    plan, within = _PLANS[kind], kind is Kind.STORED
    name, output = f"Palpate {kind.value.title()}", "Vectors" if within else "Geometry"
    outputs = ((output, "Vector" if within else "Geometry"),)
    builder = GroupBuilder.begin(name, plan.inputs, outputs)
    builder.group.is_modifier = not within
    builder.group[MARK] = _mark(kind)
    for item in _in(builder.group):
        item.description = DESCRIPTIONS.get(item.name, "")
        if item.socket_type == "NodeSocketFloat":
            item.default_value = 1.0 if item.name == STRENGTH else 0.0
    return builder.end(**{output: plan.result(builder)})


def _stored(builder: GroupBuilder) -> bpy.types.NodeSocket:
    """Own vectors, or the carrier's: by number, or by place where there are other vertices, as
    with other levels of subdivision for rendering.
    """
    vectors = {"data_type": "FLOAT_VECTOR"}
    own = builder.node("GeometryNodeInputNamedAttribute", vectors, Name=builder.given(DISPLACEMENT))
    carrier = builder.node(
        "GeometryNodeObjectInfo", {"transform_space": "ORIGINAL"}, Object=builder.given(CARRIER)
    )["Geometry"]
    carried = own["Attribute"]
    by_number = builder.node(
        "GeometryNodeSampleIndex",
        {**vectors, "domain": "POINT"},
        Geometry=carrier,
        Value=carried,
        Index=builder.node("GeometryNodeInputIndex")["Index"],
    )
    by_place = builder.node(
        "GeometryNodeSampleNearestSurface", vectors, Mesh=carrier, Value=carried
    )
    here, there = (
        builder.node("GeometryNodeAttributeDomainSize", Geometry=geometry)["Point Count"]
        for geometry in (builder.given("Geometry"), carrier)
    )
    of_carrier = builder.choice(
        builder.math("COMPARE", here, there, 0.5), by_number["Value"], by_place["Value"]
    )
    return builder.choice(builder.math("COMPARE", there, 0.0, 0.5), own["Attribute"], of_carrier)


def _named(builder: GroupBuilder, name: object) -> bpy.types.NodeSocket:
    """Vectors of a name, of the mesh or its carrier."""
    found = builder.subgroup(
        group_of(Kind.STORED),
        Geometry=builder.given("Geometry"),
        Carrier=builder.given(CARRIER),
        Displacement=name,
    )
    return found["Vectors"]


def _moved(builder: GroupBuilder, vectors: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    """Geometry moved by vectors."""
    moved = builder.node(
        "GeometryNodeSetPosition", Geometry=builder.given("Geometry"), Offset=vectors
    )
    return moved["Geometry"]


def _places(builder: GroupBuilder) -> bpy.types.NodeSocket:
    """Geometry with the marks of its vertices."""
    geometry = builder.given("Geometry")
    marks = {
        REST: _named(builder, builder.given(DISPLACEMENT)),
        AT: builder.node("GeometryNodeInputPosition")["Position"],
        PRESSED: _named(builder, builder.given(LIVE)),
    }
    for name, vectors in marks.items():
        geometry = _with(builder, geometry, name, vectors)
    return geometry


def _with(
    builder: GroupBuilder,
    geometry: bpy.types.NodeSocket,
    name: str,
    value: bpy.types.NodeSocket,
    kind: str = "FLOAT_VECTOR",
    domain: str = "POINT",
) -> bpy.types.NodeSocket:
    """Geometry with an attribute, of its vertices or what else it has."""
    stored = builder.node(
        "GeometryNodeStoreNamedAttribute",
        {"data_type": kind, "domain": domain},
        Geometry=geometry,
        Name=name,
        Value=value,
    )
    return stored["Geometry"]


def _fine(builder: GroupBuilder) -> bpy.types.NodeSocket:
    """Geometry with its faces divided, shaped and shaded as it was: within a face the normals are
    between those at its corners, and from there they turn with a dent. The edges of a flat face
    stay sharp.
    """
    smooth = builder.node("GeometryNodeInputShadeSmooth")["Smooth"]
    flat_beside = builder.node(
        "GeometryNodeFieldOnDomain",
        {"data_type": "BOOLEAN", "domain": "FACE"},
        Value=builder.truth("NOT", smooth),
    )["Value"]
    sharp = builder.truth("NOT", builder.node("GeometryNodeInputEdgeSmooth")["Smooth"])
    edged = _with(
        builder,
        builder.given("Geometry"),
        "sharp_edge",
        builder.truth("OR", flat_beside, sharp),
        "BOOLEAN",
        "EDGE",
    )
    normals = builder.node("GeometryNodeInputNormal")["Normal"]
    told = _with(builder, edged, SHADED, normals, domain="CORNER")
    shaded = builder.node("GeometryNodeSetShadeSmooth", Geometry=told, Shade_Smooth=True)
    divided = builder.node(
        "GeometryNodeSubdivideMesh", Mesh=shaded["Geometry"], Level=builder.given(LEVEL)
    )["Mesh"]
    between = builder.node(
        "GeometryNodeInputNamedAttribute", {"data_type": "FLOAT_VECTOR"}, Name=SHADED
    )["Attribute"]
    turning = builder.node(
        "GeometryNodeSetMeshNormal",
        {"mode": "TANGENT_SPACE"},
        Mesh=divided,
        Custom_Normal=between,
    )["Mesh"]
    removed = builder.node("GeometryNodeRemoveAttribute", Geometry=turning, Name=SHADED)
    return removed["Geometry"]


def _layer(builder: GroupBuilder) -> bpy.types.NodeSocket:
    vectors = _named(builder, builder.given(DISPLACEMENT))
    return _moved(builder, builder.scaled(vectors, builder.given(STRENGTH)))


def _forces(builder: GroupBuilder) -> bpy.types.NodeSocket:
    """A layer whose displacement and traction are added to those of the layers before it; pressure
    and normal are of the sum.
    """
    name, factor = builder.given(DISPLACEMENT), builder.given(STRENGTH)
    moved = builder.scaled(_named(builder, name), factor)
    borne = builder.scaled(_named(builder, builder.text(name, TRACTION)), factor)

    def known(attribute: str) -> bpy.types.NodeSocket:
        vectors = {"data_type": "FLOAT_VECTOR"}
        found = builder.node("GeometryNodeInputNamedAttribute", vectors, Name=attribute)
        return found["Attribute"]

    def of_borne(operation: str) -> bpy.types.NodeOutputs:
        return builder.node("ShaderNodeVectorMath", {"operation": operation}, Vector=known(BORNE))

    geometry = _moved(builder, moved)
    for attribute, vectors in ((SUM, moved), (BORNE, borne)):
        geometry = _with(builder, geometry, attribute, builder.sum(known(attribute), vectors))
    geometry = _with(builder, geometry, PRESSURE, of_borne("LENGTH")["Value"], "FLOAT")
    return _with(builder, geometry, NORMAL, of_borne("NORMALIZE")["Vector"])


def _rig(builder: GroupBuilder) -> bpy.types.NodeSocket:
    vectors = (
        builder.scaled(
            _named(builder, builder.text(builder.given(DISPLACEMENT), f" {axis}")),
            builder.given(axis),
        )
        for axis in AXES
    )
    return _moved(builder, builder.sum(*vectors))


_PLANS = {
    Kind.STORED: _Plan(_SOURCE, _stored),
    Kind.LAYER: _Plan((*_SOURCE, (STRENGTH, "Float")), _layer),
    Kind.FORCES: _Plan((*_SOURCE, (STRENGTH, "Float")), _forces),
    Kind.RIG: _Plan((*_SOURCE, *((axis, "Float") for axis in AXES)), _rig),
    Kind.PLACES: _Plan((*_SOURCE, (LIVE, "String")), _places),
    Kind.FINE: _Plan((("Geometry", "Geometry"), (LEVEL, "Int")), _fine),
}
