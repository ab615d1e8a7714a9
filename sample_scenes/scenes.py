"""The scenes: cube, plush mouse, hare and drumstick with material, pins, light and camera."""

import bodies
import bpy
import drumstick_shape
import fabric
import hare_shape
import mouse_shape
import numpy as np
import studio
from numpy.typing import NDArray

PINNED, BONE = "Pinned", "Bone"
BONE_FACTOR = 1000.0
CUBE_EDGE = 0.05
CUBE_CELLS = 24
CHECK = 0.0125  # two squares of the check, metres
Colour = tuple[float, float, float]


def soft_mesh(name: str, shape: mouse_shape.QuadMesh) -> bpy.types.Mesh:
    """A Blender mesh with smooth shading, material slots by part, rest and felt attributes."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(shape.vertices, [], shape.quads.tolist())
    mesh.shade_smooth()
    mesh.polygons.foreach_set("material_index", shape.part.astype(np.int32))
    rest = mesh.attributes.new(fabric.REST, "FLOAT_VECTOR", "POINT")
    rest.data.foreach_set("vector", shape.vertices.astype(np.float32).ravel())
    for attribute, values in ((fabric.FELT, shape.felt), (fabric.QUILT, shape.quilt)):
        layer = mesh.attributes.new(attribute, "FLOAT", "POINT")
        layer.data.foreach_set("value", values.astype(np.float32))
    mesh.update()
    return mesh


def paint(mesh: bpy.types.Mesh, colours: NDArray[np.float64]) -> None:
    """Store vertex colours (v, 3), linear: what Solid shading shows."""
    layer = mesh.color_attributes.new("Colour", "FLOAT_COLOR", "POINT")
    rgba = np.column_stack([colours, np.ones(len(colours))]).astype(np.float32)
    layer.data.foreach_set("color", rgba.ravel())


def checked(colour: Colour, *ways: NDArray[np.float64]) -> NDArray[np.float64]:
    """A soft check of two tones (v, 3) along some ways (v,) in metres, for Solid shading."""
    waves = [np.cos(2.0 * np.pi * way / CHECK) for way in ways]
    tone = 1.0 + 0.3 * np.tanh(3.0 * np.prod(waves, axis=0))
    return tone[:, None] * np.array(colour)


def pin(thing: bpy.types.Object, vertices: NDArray[np.int64]) -> None:
    """Make the vertex group that holds the body on the table."""
    thing.vertex_groups.new(name=PINNED).add(vertices.tolist(), 1.0, "REPLACE")


def mouse_scene() -> bpy.types.Object:
    """The plush mouse on its table."""
    scene = studio.empty_scene("Mouse")
    mouse = plush_mouse(scene)
    aim = (-0.004, -0.004, 0.030)
    studio.present(scene, mouse, aim, (0.23, -0.33, 0.215), 88.0, 0.23, lit=(0.0, 0.0, 0.03))
    return mouse


def plush_mouse(scene: bpy.types.Scene) -> bpy.types.Object:
    """The mouse with its fabrics, material and pins."""
    shape = mouse_shape.mouse()
    mesh = soft_mesh("Mouse", shape)
    body, stitch, pink = (0.40, 0.315, 0.265), (0.14, 0.095, 0.08), (0.76, 0.24, 0.25)
    for material in (
        fabric.plush(fabric.quilted, body, stitch, pink),
        fabric.felt(pink),
        fabric.bead(),
    ):
        mesh.materials.append(material)
    x, y, z = shape.vertices.T
    plain = checked(body, x, 0.034 * np.arctan2(y, z - 0.018))
    colours = np.where((shape.felt < 0.0)[:, None], pink, plain)
    for part, colour in (
        (mouse_shape.Part.FELT, pink),
        (mouse_shape.Part.BEAD, (0.01, 0.01, 0.01)),
    ):
        colours[np.unique(shape.quads[shape.part == part])] = colour
    paint(mesh, colours)
    mouse = studio.link(scene, "Mouse", mesh)
    pin(mouse, shape.pinned)
    bodies.set_up(mouse, PINNED, material="PLUSH")
    bodies.set_mesh_size(mouse, bodies.MOUSE_SIZE)
    return mouse


def felt_vertices(mouse: bpy.types.Mesh) -> NDArray[np.int64]:
    """Vertices of the mouse's faces that are of felt."""
    felt = [face for face in mouse.polygons if face.material_index == mouse_shape.Part.FELT]
    return np.unique(np.array([v for face in felt for v in face.vertices], dtype=np.int64))


def cube_scene() -> bpy.types.Object:
    """The paper's cube, 50 mm, pinned at the bottom."""
    scene = studio.empty_scene("Cube")
    cube = paper_cube(scene, "Cube")
    # As its figures are.
    cube.palpate.shape = "LINEAR"
    aim = (0.0, 0.0, 0.023)
    studio.present(scene, cube, aim, (0.23, -0.28, 0.20), 110.0, 0.14)
    return cube


def paper_cube(scene: bpy.types.Scene, name: str) -> bpy.types.Object:
    """The paper's cube standing on the origin, with its material and pins."""
    unit, quads = mouse_shape.cube_surface(CUBE_CELLS)
    vertices = CUBE_EDGE * (unit - np.array([0.5, 0.5, 0.0]))
    plain = np.full(len(vertices), 0.01)
    shape = mouse_shape.QuadMesh(
        vertices, quads, np.zeros(len(quads), dtype=np.int64), felt=plain, quilt=plain
    )
    mesh = soft_mesh(name, shape)
    colour = (0.80, 0.20, 0.09)
    mesh.materials.append(fabric.foam(colour, (0.40, 0.07, 0.03), CUBE_EDGE / 10.0))
    paint(mesh, checked(colour, *vertices.T))
    cube = studio.link(scene, name, mesh)
    pin(cube, np.flatnonzero(vertices[:, 2] < 1e-6))
    # The paper's own, whose figures the cube is there to show.
    bodies.set_up(cube, PINNED, material="PAPER_CUBE", formulation="LINEAR")
    return cube


def drumstick_scene() -> bpy.types.Object:
    """A plush drumstick with a bone inside: soft where the meat is thick, firm over the bone."""
    scene = studio.empty_scene("Drumstick")
    shape = drumstick_shape.drumstick()
    mesh = soft_mesh("Drumstick", shape)
    meat, bone = (0.42, 0.17, 0.06), (0.78, 0.72, 0.60)
    mesh.materials.append(fabric.felt(meat))
    mesh.materials.append(fabric.felt(bone))
    x, y, z = shape.vertices.T
    colours = checked(meat, x, 0.034 * np.arctan2(y, z - 0.028))
    inner = drumstick_shape.bone_vertices(shape)
    colours[inner] = bone
    paint(mesh, colours)
    drumstick = studio.link(scene, "Drumstick", mesh)
    pin(drumstick, shape.pinned)
    drumstick.vertex_groups.new(name=BONE).add(inner.tolist(), 1.0, "REPLACE")
    bodies.set_up(drumstick, PINNED, material="JELLY")
    bodies.set_stiff(drumstick, BONE, BONE_FACTOR)
    bodies.set_mesh_size(drumstick, bodies.DRUMSTICK_SIZE)
    aim = (0.016, 0.0, 0.026)
    studio.present(scene, drumstick, aim, (0.21, -0.33, 0.23), 82.0, 0.26)
    return drumstick


def hare_scene() -> bpy.types.Object:
    """The plush hare on its table, the view near its ears."""
    scene = studio.empty_scene("Large")
    hare = plush_hare(scene)
    aim = (0.0, 0.0, 0.094)
    studio.present(scene, hare, aim, (0.36, -0.46, 0.19), 92.0, 0.42, lit=(0.0, 0.0, 0.10))
    scene.render.resolution_x, scene.render.resolution_y = 800, 960
    return hare


def plush_hare(scene: bpy.types.Scene) -> bpy.types.Object:
    """The hare with its fabrics, material and pins."""
    shape = hare_shape.hare()
    mesh = soft_mesh("Hare", shape)
    body, stitch, pink = (0.50, 0.42, 0.34), (0.20, 0.14, 0.11), (0.76, 0.30, 0.30)
    for material in (
        fabric.plush(fabric.ringed, body, stitch, pink),
        fabric.felt(pink),
        fabric.bead(),
    ):
        mesh.materials.append(material)
    x, y, z = shape.vertices.T
    plain = checked(body, z, 0.030 * np.arctan2(y, x + 0.014))
    colours = np.where((shape.felt < 0.0)[:, None], pink, plain)
    for part, colour in (
        (mouse_shape.Part.FELT, pink),
        (mouse_shape.Part.BEAD, (0.01, 0.01, 0.01)),
    ):
        colours[hare_shape.vertices_of(shape, part)] = colour
    paint(mesh, colours)
    hare = studio.link(scene, "Hare", mesh)
    pin(hare, shape.pinned)
    bodies.set_up(hare, PINNED, material="PLUSH")
    bodies.set_mesh_size(hare, bodies.HARE_SIZE)
    hare.palpate.shape = "ROTATION_STRAIN"
    return hare
