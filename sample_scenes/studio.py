"""What all scenes share: backdrop, lights, camera, render settings and the open 3D view."""

import math

import bpy
from mathutils import Vector

Colour = tuple[float, float, float]

TABLE_COLOUR = (0.13, 0.27, 0.29)


def empty_scene(name: str) -> bpy.types.Scene:
    """Blender's factory start without its objects, millimetres shown, metres stored."""
    bpy.ops.wm.read_homefile(use_factory_startup=True)
    bpy.data.batch_remove([*bpy.data.objects, *bpy.data.meshes, *bpy.data.materials])
    bpy.data.batch_remove([*bpy.data.lights, *bpy.data.cameras])
    scene = bpy.context.scene
    scene.name = name
    scene.unit_settings.system = "METRIC"
    scene.unit_settings.scale_length = 1.0
    scene.unit_settings.length_unit = "MILLIMETERS"
    scene.tool_settings.use_snap = False
    return scene


def present(
    scene: bpy.types.Scene,
    body: bpy.types.Object,
    aim: Colour,
    camera_at: Colour,
    lens: float,
    distance: float,
    lit: Colour | None = None,
) -> None:
    """The body on the table, ready to be rendered and in view from `distance`; metres."""
    backdrop(scene, TABLE_COLOUR, 0.30)
    lights(scene, aim if lit is None else lit)
    camera(scene, camera_at, aim, lens)
    render_settings(scene)
    open_view(scene, body, distance, aim)


def link(scene: bpy.types.Scene, name: str, data: bpy.types.ID | None) -> bpy.types.Object:
    """Put `data` into the scene as an object of that name; an Empty without."""
    thing = bpy.data.objects.new(name, data)
    scene.collection.objects.link(thing)
    return thing


def backdrop(scene: bpy.types.Scene, colour: Colour, depth: float) -> None:
    """A table that bends up into a wall `depth` metres behind the body."""
    profile = [(-1.2, 0.0)]
    bend = 0.25
    for step in range(17):
        angle = 0.5 * math.pi * step / 16
        profile.append((depth + bend * math.sin(angle), bend - bend * math.cos(angle)))
    profile.append((depth + bend, 1.5))
    vertices = [(x, y, z) for y, z in profile for x in (-2.0, 2.0)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    mesh = bpy.data.meshes.new("Table")
    mesh.from_pydata(vertices, [], faces)
    mesh.shade_smooth()
    material = bpy.data.materials.new("Table")
    material.use_nodes = True
    material.diffuse_color = (*colour, 1.0)
    shader = material.node_tree.nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1.0)
    shader.inputs["Roughness"].default_value = 0.7
    mesh.materials.append(material)
    table = link(scene, "Table", mesh)
    table.hide_select = True
    table.rotation_euler.z = math.radians(BACKDROP_TURN)


BACKDROP_TURN = 50.0  # degrees: the wall faces the camera


def area_light(
    scene: bpy.types.Scene,
    name: str,
    at: Colour,
    aim: Colour,
    size: float,
    watts: float,
    tint: Colour,
) -> None:
    """A square area light at `at` that shines at `aim`."""
    light = bpy.data.lights.new(name, "AREA")
    light.size, light.energy, light.color = size, watts, tint
    lamp = link(scene, name, light)
    lamp.location = at
    lamp.rotation_euler = (Vector(aim) - Vector(at)).to_track_quat("-Z", "Y").to_euler()
    lamp.hide_select = True


def lights(scene: bpy.types.Scene, aim: Colour) -> None:
    """Key from the left, cool fill from the right, rim from behind: a dent throws a shadow."""
    area_light(scene, "Key", (-0.30, -0.20, 0.36), aim, 0.14, 2.8, (1.0, 0.94, 0.86))
    area_light(scene, "Fill", (0.48, -0.12, 0.20), aim, 0.40, 1.3, (0.95, 0.96, 1.0))
    area_light(scene, "Rim", (-0.34, 0.26, 0.34), aim, 0.14, 2.0, (1.0, 0.97, 0.93))
    world = scene.world
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value = (0.72, 0.80, 0.90, 1.0)
    background.inputs["Strength"].default_value = 0.19


def camera(scene: bpy.types.Scene, at: Colour, aim: Colour, lens: float) -> None:
    """The camera the pictures are taken with, and the 3D view's as well."""
    data = bpy.data.cameras.new("Camera")
    data.lens, data.clip_start, data.clip_end = lens, 0.001, 10.0
    scene.camera = link(scene, "Camera", data)
    scene.camera.location = at
    scene.camera.rotation_euler = (Vector(aim) - Vector(at)).to_track_quat("-Z", "Y").to_euler()


def render_settings(scene: bpy.types.Scene, samples: int = 16) -> None:
    """Cycles on any processor, denoised: seconds a picture."""
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = 960, 640
    scene.render.image_settings.file_format = "PNG"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_denoising = True
    scene.cycles.max_bounces = 3
    scene.view_settings.view_transform = "AgX"
    scene.view_settings.exposure = 0.2
    scene.view_settings.look = "AgX - Medium High Contrast"


def open_view(scene: bpy.types.Scene, body: bpy.types.Object, distance: float, aim: Colour) -> None:
    """Every 3D view looks at the body from the camera's side, near enough, sidebar open."""
    for other in scene.objects:
        other.select_set(other == body)
    bpy.context.view_layer.objects.active = body
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                _frame(area, scene.camera, distance, aim)


def show_empties() -> None:
    """Let Empties be seen in every 3D view, but not lamps and camera."""
    for thing in bpy.context.scene.objects:
        if thing.type in {"LIGHT", "CAMERA"}:
            thing.hide_set(True)
    for screen in bpy.data.screens:
        for area in screen.areas:
            if area.type == "VIEW_3D":
                area.spaces.active.overlay.show_extras = True


def _frame(area: bpy.types.Area, view_from: bpy.types.Object, distance: float, aim: Colour) -> None:
    space = area.spaces.active
    space.clip_start, space.clip_end = 0.001, 10.0
    space.shading.type = "SOLID"
    space.shading.color_type = "VERTEX"
    space.shading.light = "STUDIO"
    space.shading.show_cavity = True
    space.shading.cavity_type = "BOTH"
    space.shading.cavity_ridge_factor = 0.6
    space.shading.cavity_valley_factor = 1.2
    space.overlay.show_relationship_lines = False
    space.overlay.show_extras = False
    space.overlay.show_floor = False
    space.overlay.show_axis_x = space.overlay.show_axis_y = False
    space.overlay.show_cursor = False
    space.show_region_ui = True
    view = space.region_3d
    view.view_perspective = "PERSP"
    view.view_location = aim
    view.view_rotation = view_from.rotation_euler.to_quaternion()
    view.view_distance = distance
