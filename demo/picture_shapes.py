"""Picture of all shapes: an ear of large.blend, its tip moved to the same place in each.

Run as BLENDER_PYTHON picture_shapes.py --package ZIP --output shapes.png, where BLENDER_PYTHON has
the bpy module. The last picture is the truth, Newton's equilibrium with the touched place where it
is in the others, and its outline is drawn over all of them. The paper's table takes a minute or two
for the touched place, the truth about one. Prints for each shape the volume of the body and the
distance of the drawn vertices from the true ones.
"""

import argparse
import shutil
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
SCENES = HERE.parent / "sample_scenes"
sys.path[:0] = [str(HERE), str(SCENES)]

# World axes, metres: the tip of the left ear moves to the side and down, bent without stretching.
BELOW, BY = 0.008, (0.004, 0.050, -0.022)
SHAPES = ("LINEAR", "TABLE", "ROTATION_STRAIN")
TRUTH = "Newton's Method"
SAMPLES, WIDTH, HEIGHT = 12, 400, 500
OUTLINE = (1.0, 1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Pressed:
    """Picture's name, vertices (p, 3) in local units and volume ratio."""

    title: str
    vertices: Any
    volume: float


def main() -> int:
    """Press, render and join."""
    options = _options()
    with tempfile.TemporaryDirectory() as folder:
        import installed

        installed.install(options.package.resolve(), Path(folder) / "blender")
        hare = opened(Path(folder))
        cases = [pressed(hare, name) for name in options.shapes]
        truth = true_one(hare)
        outline = silhouette(hare, truth)
        pictures = []
        for case in (*cases, truth):
            off = distance(case, truth) / distance(truth, None, hare)
            print(f"{case.title}: volume {case.volume:.3f}, {100 * off:.1f} % off the true shape")
            pictures.append(Path(folder) / f"{len(pictures)}.png")
            render(hare, case, off, pictures[-1])
        join(pictures, outline, options.output)
    return 0


def opened(folder: Path) -> Any:
    """Hare of a copy of large.blend, with room for a bent ear in the camera."""
    import bpy

    copy = folder / "large.blend"
    shutil.copyfile(SCENES / copy.name, copy)
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    hare = bpy.data.objects["Hare"]
    bpy.context.view_layer.objects.active = hare
    turn_to_face(bpy.context.scene)
    return hare


def turn_to_face(scene: Any) -> None:
    """Place the camera in front of the hare's head and ears."""
    from mathutils import Vector

    camera = scene.camera
    camera.location, aim = (0.66, -0.02, 0.20), Vector((0.0, 0.033, 0.125))
    camera.rotation_euler = (aim - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens, camera.data.sensor_fit = 78.0, "VERTICAL"
    scene.objects["Table"].rotation_euler.z = 1.5707963 - 0.1
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    scene.cycles.samples = SAMPLES


def pressed_place() -> Any:
    """Place of the finger, world coordinates."""
    import hare_shape
    import numpy as np

    return hare_shape.ear_tip(1.0) - np.array([0.0, 0.0, BELOW])


def pressed(hare: Any, name: str) -> Pressed:
    """Ear pulled aside in one of the panel's shapes."""
    import bpy

    hare.palpate.shape = name
    bpy.context.scene.palpate.tip = "POINT"
    at = pressed_place().tolist()
    if bpy.ops.palpate.press("EXEC_DEFAULT", at=at, by=BY) != {"FINISHED"}:
        raise RuntimeError(f"{name}: the press did not finish")
    title: str = hare.palpate.bl_rna.properties["shape"].enum_items[name].name
    return taken(hare, title)


def true_one(hare: Any) -> Pressed:
    """Ear pulled aside by Newton's method, which takes a second or more a frame."""
    import bpy
    from installed import palpate

    class Newton:
        """The Shape protocol's part that is used to meet a finger."""

        def __init__(self, body: Any) -> None:
            self.solid, self.last = (
                palpate("core.shape.solid.free_solid").FreeSolid.of(body),
                None,
            )

        def displacements(self, nodes: Any, nodal_forces: Any, young_modulus: float) -> Any:
            forces = self.solid.on_free_nodes(nodes, nodal_forces / young_modulus)
            newton = palpate("core.shape.solid.newton")
            try:
                found = newton.equilibrium(self.solid, forces, start=self.last)
            except newton.NoEquilibrium:
                found = newton.equilibrium(self.solid, forces)
            self.last = found.displacements
            return found.displacements[self.solid.surface]

    meeting = palpate("core.shape.meeting")
    drawn = palpate("operators.object.drawn_body").open_body(hare, bpy.context.scene)
    touch = palpate("core.contact.single_press").touch_nearest(
        drawn.body, at=pressed_place(), by=BY
    )
    load = meeting.FingerLoad(touch.triangle, touch.nodal_forces)
    met = meeting.Meeting(drawn.body, Newton(drawn.body)).settle([load], drawn.body.young_modulus)
    if not met.settled:
        raise RuntimeError(f"Newton's method misses the finger by {100 * met.missed:.0f} %")
    moved = drawn.drawn_displacement(met.displacements)
    palpate("operators.imprint.kept_imprint").keep_moved(
        hare, bpy.context.scene, drawn.frame, moved
    )
    return taken(hare, TRUTH)


def taken(hare: Any, title: str) -> Pressed:
    """Take the latest layer off again."""
    from installed import palpate

    layers, layer = palpate("operators.layer.layers"), hare.modifiers.active
    rest = places(hare)
    vertices = rest + layers.displacement(hare, layer)
    layers.remove(hare, layer)
    return Pressed(title, vertices, volume(hare, vertices) / volume(hare, rest))


def places(thing: Any) -> Any:
    """Vertices (p, 3) of a mesh at rest, local units."""
    import numpy as np

    flat = np.empty(3 * len(thing.data.vertices), dtype=np.float32)
    thing.data.vertices.foreach_get("co", flat)
    return flat.astype(np.float64).reshape(-1, 3)


def triangles(thing: Any) -> Any:
    """Triangles (t, 3) of the drawn mesh."""
    import numpy as np

    thing.data.calc_loop_triangles()
    corners = np.empty(3 * len(thing.data.loop_triangles), dtype=np.int32)
    thing.data.loop_triangles.foreach_get("vertices", corners)
    return corners.reshape(-1, 3)


def volume(thing: Any, vertices: Any) -> float:
    """Volume of the drawn mesh with vertices (p, 3), cubic units."""
    import numpy as np

    a, b, c = vertices[triangles(thing)].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


def distance(case: Pressed, other: Pressed | None, hare: Any = None) -> float:
    """Distance of two shapes, or from rest: root of the sum of squares over all vertices."""
    import numpy as np

    origin = places(hare) if other is None else other.vertices
    return float(np.linalg.norm(case.vertices - origin))


def silhouette(hare: Any, case: Pressed) -> Any:
    """Share (height, width) of each pixel, from below, that the outline of a shape covers."""
    import bpy
    import numpy as np
    from bpy_extras.object_utils import world_to_camera_view
    from mathutils import Vector

    fine = 3
    scene, size = bpy.context.scene, np.array([WIDTH, HEIGHT]) * fine
    seen = [
        world_to_camera_view(scene, scene.camera, hare.matrix_world @ Vector(place))[:2]
        for place in case.vertices.tolist()
    ]
    points = np.array(seen) * size
    covered = np.zeros(size[::-1], dtype=bool)
    for corners in points[triangles(hare)]:
        low = np.clip(np.floor(corners.min(axis=0)), 0, size - 1).astype(int)
        high = np.clip(np.ceil(corners.max(axis=0)) + 1, 0, size).astype(int)
        x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
        sides = [
            (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])
            for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True)
        ]
        inside = np.all(np.array(sides) >= 0, axis=0) | np.all(np.array(sides) <= 0, axis=0)
        covered[low[1] : high[1], low[0] : high[0]] |= inside
    grown = np.pad(covered, fine, mode="edge")
    for axis in (0, 1):
        for _ in range(fine):
            grown |= np.roll(grown, 1, axis) | np.roll(grown, -1, axis)
    line = grown[fine:-fine, fine:-fine] & ~covered
    return line.reshape(HEIGHT, fine, WIDTH, fine).mean(axis=(1, 3))


def render(hare: Any, case: Pressed, off: float, picture: Path) -> None:
    """Render a picture of a shape, with its name."""
    from installed import palpate
    from photographing import photograph

    layers = palpate("operators.layer.layers")
    shown = layers.add(hare, "Shown")
    layers.write(hare, shown, (case.vertices - places(hare)).astype("float32").ravel())
    change = round(100 * (case.volume - 1))
    second = "the truth" if case.title == TRUTH else f"{100 * off:.0f} % off"
    words = [
        written(case.title, 0.0400, 0.0058),
        written(f"volume {f'{change:+d}' if change else 0} %, {second}", 0.0350, 0.0042),
    ]
    photograph(picture)
    layers.remove(hare, shown)
    import bpy

    for word in words:
        bpy.data.objects.remove(word)


def written(text: str, height: float, size: float) -> Any:
    """Add a line of text in front of the camera, this far above the middle of its picture."""
    import bpy

    scene, curve = bpy.context.scene, bpy.data.curves.new("Text", "FONT")
    curve.body, curve.size, curve.align_x = text, size, "CENTER"
    white = bpy.data.materials.new("White")
    shader = white.node_tree.nodes["Principled BSDF"].inputs
    shader["Base Color"].default_value = (0.0, 0.0, 0.0, 1.0)
    shader["Emission Color"].default_value, shader["Emission Strength"].default_value = OUTLINE, 1.0
    curve.materials.append(white)
    word = bpy.data.objects.new("Text", curve)
    word.parent, word.location = scene.camera, (0.0, height, -0.3)
    word.visible_shadow = word.visible_diffuse = word.visible_glossy = False
    scene.collection.objects.link(word)
    return word


def join(pictures: list[Path], outline: Any, output: Path) -> None:
    """Join the pictures side by side, an outline over each, into one file."""
    import bpy
    import numpy as np

    loaded = []
    for path in pictures:
        image = bpy.data.images.load(str(path))
        width, height = image.size
        pixels = np.array(image.pixels[:]).reshape(height, width, 4)
        share = 0.85 * outline[..., None]
        loaded.append((1.0 - share) * pixels + share * np.array(OUTLINE))
    whole = np.concatenate(loaded, axis=1)
    height, width = whole.shape[:2]
    joined = bpy.data.images.new("Shapes", width, height)
    joined.pixels = whole.ravel()
    joined.filepath_raw, joined.file_format = str(output.resolve()), "PNG"
    joined.save()


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--package", type=Path, required=True, help="the extension's zip")
    parser.add_argument("--output", type=Path, required=True)
    parser.add_argument("--shapes", nargs="+", choices=SHAPES, default=list(SHAPES))
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
