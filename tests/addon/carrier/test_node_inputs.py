"""Inputs of geometry nodes that make the mesh as seen: a body is of the values at its bake."""

from __future__ import annotations

import bpy
from soft_scene import part, select, status

KINDS = {"Height": ("Float", 0.5), "Count": ("Int", 3), "Way": ("Vector", (0.0, 1.0, 0.0))}


def divided(thing: bpy.types.Object) -> bpy.types.NodesModifier:
    """A modifier that divides the faces, with inputs."""
    group = bpy.data.node_groups.new("Divided", "GeometryNodeTree")
    group.is_modifier = True
    for in_out in ("INPUT", "OUTPUT"):
        group.interface.new_socket("Geometry", in_out=in_out, socket_type="NodeSocketGeometry")
    for name, (kind, _) in KINDS.items():
        group.interface.new_socket(name, in_out="INPUT", socket_type=f"NodeSocket{kind}")
    given, made = (group.nodes.new(f"NodeGroup{end}") for end in ("Input", "Output"))
    divide = group.nodes.new("GeometryNodeSubdivideMesh")
    group.links.new(given.outputs[0], divide.inputs["Mesh"])
    group.links.new(divide.outputs["Mesh"], made.inputs[0])
    modifier = thing.modifiers.new("Divided", "NODES")
    modifier.node_group = group
    return modifier


def test_a_changed_input_is_another_mesh_and_an_animated_one_is_left_out(palpate):
    bpy.ops.mesh.primitive_cube_add()
    thing = select(bpy.context.object)
    thing.palpate.edge_length, thing.palpate.epsilon = 0.3, 0.02
    modifier, inputs = divided(thing), part("operators.layer.modifier_inputs")
    assert bpy.ops.palpate.make_soft() == {"FINISHED"}
    fit = part("operators.object.soft_object").Fit
    assert status(thing).fit is fit.READY
    for name, (_, other) in KINDS.items():
        before = inputs.value(modifier, name)
        before = tuple(before) if hasattr(before, "__len__") else before
        inputs.set_value(modifier, name, other)
        assert status(thing).fit is fit.CHANGED
        assert "modifiers" in status(thing).text
        inputs.set_value(modifier, name, before)
        assert status(thing).fit is fit.READY
    digest = part("operators.carrier.seen_mesh").digest
    thing.keyframe_insert(inputs.path(modifier, "Height"), frame=1)
    still = digest(thing)
    inputs.set_value(modifier, "Height", 0.7)
    assert digest(thing) == still
