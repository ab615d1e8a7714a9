"""The scene about large deformation: a plush hare whose long ears bend far."""

import bodies
import bpy
import fabric
import hare_shape
import numpy as np
import scenes
import studio
from mouse_shape import Part


def hare_scene() -> bpy.types.Object:
    """The plush hare on its table, the view near its ears."""
    scene = studio.empty_scene("Large")
    hare = plush_hare(scene)
    aim = (0.0, 0.0, 0.094)
    studio.backdrop(scene, (0.13, 0.27, 0.29), 0.30)
    studio.lights(scene, (0.0, 0.0, 0.10))
    studio.camera(scene, (0.36, -0.46, 0.19), aim, 92.0)
    studio.render_settings(scene)
    scene.render.resolution_x, scene.render.resolution_y = 800, 960
    studio.open_view(scene, hare, 0.42, aim)
    return hare


def plush_hare(scene: bpy.types.Scene) -> bpy.types.Object:
    """The hare with its fabrics, material and pins."""
    shape = hare_shape.hare()
    mesh = scenes.soft_mesh("Hare", shape)
    body, stitch, pink = (0.50, 0.42, 0.34), (0.20, 0.14, 0.11), (0.76, 0.30, 0.30)
    for material in (
        fabric.plush(fabric.ringed, body, stitch, pink),
        fabric.felt(pink),
        fabric.bead(),
    ):
        mesh.materials.append(material)
    x, y, z = shape.vertices.T
    plain = scenes.checked(body, z, 0.030 * np.arctan2(y, x + 0.014))
    colours = np.where((shape.felt < 0.0)[:, None], pink, plain)
    for part, colour in ((Part.FELT, pink), (Part.BEAD, (0.01, 0.01, 0.01))):
        colours[hare_shape.vertices_of(shape, part)] = colour
    scenes.paint(mesh, colours)
    hare = studio.link(scene, "Hare", mesh)
    scenes.pin(hare, shape.pinned)
    bodies.set_up(hare, scenes.PINNED, material="PLUSH")
    bodies.set_mesh_size(hare, bodies.HARE_SIZE)
    hare.palpate.shape = "ROTATION_STRAIN"
    return hare
