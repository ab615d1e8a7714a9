"""Node groups built from sockets and operations by name."""

from __future__ import annotations

from collections.abc import Mapping

import bpy

Sockets = tuple[tuple[str, str], ...]


class GroupBuilder:
    """Nodes of a group, added and linked by the names of their inputs."""

    def __init__(self, group: bpy.types.NodeTree) -> None:
        self.group = group
        self._given = group.nodes.new("NodeGroupInput")

    @classmethod
    def begin(cls, name: str, inputs: Sockets, outputs: Sockets) -> GroupBuilder:
        """A new group with inputs and outputs of these names and types, such as `Float`."""
        group = bpy.data.node_groups.new(name, "GeometryNodeTree")
        for in_out, sockets in (("OUTPUT", outputs), ("INPUT", inputs)):
            for one, kind in sockets:
                group.interface.new_socket(one, in_out=in_out, socket_type=f"NodeSocket{kind}")
        return cls(group)

    def given(self, name: str) -> bpy.types.NodeSocket:
        """Input of the group."""
        return self._given.outputs[name]

    def node(
        self, kind: str, settings: Mapping[str, object] | None = None, **inputs: object
    ) -> bpy.types.NodeOutputs:
        """Add a node; inputs are sockets or values, by name with `_` for blanks. Its outputs."""
        node = self.group.nodes.new(kind)
        for name, value in (settings or {}).items():
            setattr(node, name, value)
        for name, value in inputs.items():
            self._connect(value, node.inputs[name.replace("_", " ").strip()])
        return node.outputs

    def math(self, operation: str, *operands: object) -> bpy.types.NodeSocket:
        """Result of an operation on numbers."""
        node = self.group.nodes.new("ShaderNodeMath")
        node.operation = operation
        for place, operand in enumerate(operands):
            self._connect(operand, node.inputs[place])
        return node.outputs["Value"]

    def truth(self, operation: str, *operands: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """Result of an operation on truths."""
        node = self.group.nodes.new("FunctionNodeBooleanMath")
        node.operation = operation
        for place, operand in enumerate(operands):
            self._connect(operand, node.inputs[place])
        return node.outputs["Boolean"]

    def sum(self, *vectors: bpy.types.NodeSocket) -> bpy.types.NodeSocket:
        """Sum of vectors."""
        result, *others = vectors
        for other in others:
            node = self.group.nodes.new("ShaderNodeVectorMath")
            self._connect(result, node.inputs[0])
            self._connect(other, node.inputs[1])
            result = node.outputs["Vector"]
        return result

    def scaled(self, vector: bpy.types.NodeSocket, factor: object) -> bpy.types.NodeSocket:
        """Vector times a number."""
        made = self.node(
            "ShaderNodeVectorMath", {"operation": "SCALE"}, Vector=vector, Scale=factor
        )
        return made["Vector"]

    def choice(self, condition: object, if_true: object, if_false: object) -> bpy.types.NodeSocket:
        """One of two vectors; the other is not computed."""
        made = self.node(
            "GeometryNodeSwitch",
            {"input_type": "VECTOR"},
            Switch=condition,
            True_=if_true,
            False_=if_false,
        )
        return made["Output"]

    def text(self, *parts: object) -> bpy.types.NodeSocket:
        """Texts joined."""
        node = self.group.nodes.new("GeometryNodeStringJoin")
        # Of an input that takes several links the last one made comes first.
        for part in reversed(parts):
            self._connect(self._as_text(part), node.inputs["Strings"])
        return node.outputs["String"]

    def _as_text(self, part: object) -> bpy.types.NodeSocket:
        if isinstance(part, bpy.types.NodeSocket):
            return part
        return self.node("FunctionNodeInputString", {"string": part})["String"]

    def subgroup(self, group: bpy.types.NodeTree, **inputs: object) -> bpy.types.NodeOutputs:
        """Outputs of another group within this one."""
        return self.node("GeometryNodeGroup", {"node_tree": group}, **inputs)

    def end(self, **outputs: bpy.types.NodeSocket) -> bpy.types.NodeTree:
        """The group with its outputs, its nodes in rows."""
        self.node("NodeGroupOutput", **outputs)
        for place, node in enumerate(self.group.nodes):
            node.location = (190.0 * (place % 6), -240.0 * (place // 6))
        return self.group

    def _connect(self, value: object, target: bpy.types.NodeSocket) -> None:
        if isinstance(value, bpy.types.NodeSocket):
            self.group.links.new(value, target)
        else:
            target.default_value = value
