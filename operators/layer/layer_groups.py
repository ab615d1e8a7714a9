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
STRENGTH = "Strength"
# Attributes that a press gives the vertices: places at rest, and where the live layer finds them.
REST, AT = "palpate_rest", "palpate_at"
AXES = ("X", "Y", "Z")
DESCRIPTIONS = {
    DISPLACEMENT: "Attribute of the vertices that is added to their places, local units",
    CARRIER: "Mesh that has the attribute for the vertices that modifiers make; none: the mesh's",
    STRENGTH: "Factor on the displacement: 1 as it was pressed",
    "X": "Push along the X axis",
    "Y": "Push along the Y axis",
    "Z": "Push along the Z axis",
}

_SOURCE: Sockets = (("Geometry", "Geometry"), (CARRIER, "Object"), (DISPLACEMENT, "String"))


class Kind(Enum):
    """What a group adds to the places of the vertices."""

    LAYER = "layer"  # the attribute's vectors, times Strength
    RIG = "rig"  # of three attributes, "<name> X", Y and Z: each times its slider
    PLACES = "places"  # nothing; it gives the vertices their places at rest, and as they are
    STORED = "stored"  # within the others: the vectors of a name


@dataclass(frozen=True)
class _Plan:
    name: str
    inputs: Sockets
    vectors: Callable[[GroupBuilder], bpy.types.NodeSocket]


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
    plan = _PLANS[kind]
    adds = kind is not Kind.STORED
    result = ("Geometry", "Geometry") if adds else ("Vectors", "Vector")
    builder = GroupBuilder.begin(plan.name, plan.inputs, (result,))
    builder.group.is_modifier = adds
    builder.group[MARK] = _mark(kind)
    for item in _in(builder.group):
        item.description = DESCRIPTIONS.get(item.name, "")
        if item.socket_type == "NodeSocketFloat":
            item.default_value = 1.0 if item.name == STRENGTH else 0.0
    vectors = plan.vectors(builder)
    if not adds:
        return builder.end(Vectors=vectors)
    if kind is Kind.PLACES:
        return builder.end(Geometry=_with_places(builder, vectors))
    moved = builder.node(
        "GeometryNodeSetPosition", Geometry=builder.given("Geometry"), Offset=vectors
    )
    return builder.end(Geometry=moved["Geometry"])


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


def _with_places(builder: GroupBuilder, rest: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
    """Geometry with places at rest, and the present ones."""
    geometry = builder.given("Geometry")
    for name, places in ((REST, rest), (AT, builder.node("GeometryNodeInputPosition")["Position"])):
        geometry = builder.node(
            "GeometryNodeStoreNamedAttribute",
            {"data_type": "FLOAT_VECTOR", "domain": "POINT"},
            Geometry=geometry,
            Name=name,
            Value=places,
        )["Geometry"]
    return geometry


def _layer(builder: GroupBuilder) -> bpy.types.NodeSocket:
    return builder.scaled(_named(builder, builder.given(DISPLACEMENT)), builder.given(STRENGTH))


def _rig(builder: GroupBuilder) -> bpy.types.NodeSocket:
    return builder.sum(
        *(
            builder.scaled(
                _named(builder, builder.text(builder.given(DISPLACEMENT), f" {axis}")),
                builder.given(axis),
            )
            for axis in AXES
        )
    )


_PLANS = {
    kind: _Plan(f"Palpate {kind.value.title()}", (*_SOURCE, *((f, "Float") for f in sliders)), made)
    for kind, sliders, made in (
        (Kind.STORED, (), _stored),
        (Kind.LAYER, (STRENGTH,), _layer),
        (Kind.RIG, AXES, _rig),
        (Kind.PLACES, (), lambda builder: _named(builder, builder.given(DISPLACEMENT))),
    )
}
