"""Materials that show a dent: patterns laid in rest coordinates, so they go in with the surface."""

from collections.abc import Callable

import bpy

Colour = tuple[float, float, float]
Socket = bpy.types.NodeSocket
REST = "rest"  # vertex attribute: position before any press, metres
FELT = "felt"  # vertex attribute: distance from the seam, negative on felt, metres
PITCH, THREAD = 0.0045, 0.0006  # of the quilt, metres
QUILT = "quilt"  # vertex attribute: distance from the quilt's border, positive inside, metres


class Graph:
    """A material's node tree, written as expressions."""

    def __init__(self, name: str, solid: Colour) -> None:
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.material.diffuse_color = (*solid, 1.0)
        self.tree = self.material.node_tree
        self.shader = self.tree.nodes["Principled BSDF"]

    def node(self, kind: str, *inputs: Socket | float, **settings: str | float) -> bpy.types.Node:
        """Add a node, set it up and feed its first inputs."""
        made = self.tree.nodes.new(kind)
        for name, value in settings.items():
            setattr(made, name, value)
        for socket, value in zip(made.inputs, inputs, strict=False):
            self.feed(socket, value)
        return made

    def feed(self, socket: Socket, value: Socket | float | Colour) -> None:
        """Link a socket to another, or give it a constant."""
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif isinstance(value, tuple):
            socket.default_value = (*value, 1.0)
        else:
            socket.default_value = value

    def math(self, operation: str, *inputs: Socket | float) -> Socket:
        """One arithmetic node."""
        return self.node("ShaderNodeMath", *inputs, operation=operation).outputs[0]

    def attribute(self, name: str) -> bpy.types.Node:
        """Read an attribute of the mesh."""
        return self.node("ShaderNodeAttribute", attribute_name=name, attribute_type="GEOMETRY")

    def mix(self, factor: Socket, a: Socket | Colour, b: Socket | Colour) -> Socket:
        """`a` where the factor is 0, `b` where it is 1."""
        made = self.node("ShaderNodeMix", data_type="RGBA")
        self.feed(made.inputs["Factor"], factor)
        self.feed(made.inputs["A"], a)
        self.feed(made.inputs["B"], b)
        return made.outputs["Result"]

    def step(self, value: Socket, low: float, high: float) -> Socket:
        """0 below `low`, 1 above `high`, smooth between."""
        made = self.node("ShaderNodeMapRange", value, low, high, interpolation_type="SMOOTHSTEP")
        return made.outputs[0]

    def line(self, value: Socket, pitch: float, width: float) -> Socket:
        """1 within `width` of each multiple of `pitch`, 0 elsewhere, soft edges."""
        gap = self.math("ABSOLUTE", self.math("WRAP", value, 0.5 * pitch, -0.5 * pitch))
        return self.math("SUBTRACT", 1.0, self.step(gap, 0.35 * width, 0.65 * width))

    def pile(self, scale: float, strength: float, distance: float) -> Socket:
        """Bumps of short fibres in rest coordinates: a normal."""
        noise = self.node("ShaderNodeTexNoise")
        self.feed(noise.inputs["Vector"], self.attribute(REST).outputs["Vector"])
        self.feed(noise.inputs["Scale"], scale)
        self.feed(noise.inputs["Detail"], 4.0)
        bump = self.node("ShaderNodeBump")
        self.feed(bump.inputs["Strength"], strength)
        self.feed(bump.inputs["Distance"], distance)
        self.feed(bump.inputs["Height"], noise.outputs[0])
        return bump.outputs[0]

    def surface(self, **inputs: Socket | float | Colour) -> bpy.types.Material:
        """Feed the Principled BSDF by its inputs' names; the finished material."""
        for name, value in inputs.items():
            self.feed(
                self.shader.inputs[name.replace("_", " ").title().replace("Ior", "IOR")], value
            )
        return self.material


def plush(
    pattern: Callable[[Graph], Socket], body: Colour, stitch: Colour, felt: Colour
) -> bpy.types.Material:
    """Short-haired fabric with a stitched pattern and felt where the attribute says so."""
    graph = Graph("Plush", body)
    fabric = graph.mix(pattern(graph), body, stitch)
    seam = graph.step(graph.attribute(FELT).outputs["Fac"], -0.0003, 0.0003)
    return graph.surface(
        base_color=graph.mix(seam, felt, fabric),
        roughness=0.85,
        sheen_weight=0.55,
        sheen_roughness=0.45,
        normal=graph.pile(3000.0, 0.35, 0.0004),
    )


def felt(colour: Colour) -> bpy.types.Material:
    """Plain felt."""
    graph = Graph("Felt", colour)
    return graph.surface(
        base_color=colour, roughness=0.9, sheen_weight=0.5, normal=graph.pile(3000.0, 0.3, 0.0004)
    )


def bead() -> bpy.types.Material:
    """A polished black bead."""
    dark = (0.012, 0.010, 0.012)
    return Graph("Bead", dark).surface(base_color=dark, roughness=0.08, coat_weight=1.0)


def foam(colour: Colour, line: Colour, pitch: float) -> bpy.types.Material:
    """Soft foam ruled in squares of `pitch` metres."""
    graph = Graph("Foam", colour)
    rest = graph.node("ShaderNodeSeparateXYZ", graph.attribute(REST).outputs["Vector"])
    shifted = [graph.math("ADD", axis, 0.5 * pitch) for axis in rest.outputs]  # none on a face
    lines = [graph.line(axis, pitch, 0.0006) for axis in shifted]
    ruled = graph.math("MAXIMUM", graph.math("MAXIMUM", lines[0], lines[1]), lines[2])
    return graph.surface(
        base_color=graph.mix(ruled, colour, line),
        roughness=0.7,
        specular_ior_level=0.15,
        normal=graph.pile(2500.0, 0.2, 0.0003),
    )


def quilted(graph: Graph) -> Socket:
    """Rings across the mouse and seams along it, and a stitched smile."""
    x, y, z = graph.node("ShaderNodeSeparateXYZ", graph.attribute(REST).outputs["Vector"]).outputs
    rings = graph.line(x, PITCH, THREAD)
    angle = graph.math("ARCTAN2", y, graph.math("SUBTRACT", z, 0.018))
    seams = graph.line(graph.math("MULTIPLY", angle, 0.034), PITCH, THREAD)
    border = graph.step(graph.attribute(QUILT).outputs["Fac"], 0.0, 0.0006)
    quilt = graph.math("MULTIPLY", graph.math("MAXIMUM", rings, seams), border)
    return graph.math("MAXIMUM", quilt, smile(graph, x, y, z))


def smile(graph: Graph, x: Socket, y: Socket, z: Socket) -> Socket:
    """Two small arcs under the nose: 1 on the thread."""
    side = graph.math("SUBTRACT", graph.math("ABSOLUTE", y), 0.0038)
    drop = graph.math("SUBTRACT", z, 0.0195)
    squares = [graph.math("MULTIPLY", way, way) for way in (side, drop)]
    radius = graph.math("SQRT", graph.math("ADD", *squares))
    off = graph.math("ABSOLUTE", graph.math("SUBTRACT", radius, 0.0038))
    thread = graph.math("SUBTRACT", 1.0, graph.step(off, 0.0003, 0.0006))
    below = graph.math("LESS_THAN", drop, 0.0)
    front = graph.math("GREATER_THAN", x, 0.045)
    return graph.math("MULTIPLY", thread, graph.math("MULTIPLY", below, front))


def ringed(graph: Graph) -> Socket:
    """Rings round the hare from its feet to the tips of its ears, and seams along its trunk."""
    x, y, z = graph.node("ShaderNodeSeparateXYZ", graph.attribute(REST).outputs["Vector"]).outputs
    rings = graph.line(z, PITCH, THREAD)
    angle = graph.math("ARCTAN2", y, graph.math("ADD", x, 0.014))
    seams = graph.line(graph.math("MULTIPLY", angle, 0.030), PITCH, THREAD)
    border = graph.step(graph.attribute(QUILT).outputs["Fac"], 0.0, 0.0006)
    quilt = graph.math("MULTIPLY", graph.math("MAXIMUM", rings, seams), border)
    ears = graph.math("MULTIPLY", rings, graph.step(z, 0.0925, 0.0935))
    return graph.math("MAXIMUM", quilt, ears)
