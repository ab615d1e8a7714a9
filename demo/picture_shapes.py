"""All shapes side by side: an ear of large.blend, pulled aside as far in each of them.

Run as BLENDER_PYTHON picture_shapes.py --package ZIP --output shapes.png, where BLENDER_PYTHON has
the bpy module. The same place goes the same way in every picture; Newton's table takes a minute or
two for it. Prints what each shape does to the volume of the body.
"""

import argparse
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
SCENES = HERE.parent / "sample_scenes"
sys.path[:0] = [str(HERE), str(SCENES)]

# World axes, metres: from below the tip of the left ear to the side and down, where an ear comes to
# that is bent without being stretched.
BELOW, BY = 0.008, (0.006, 0.064, -0.043)
SHAPES = ("LINEAR", "TABLE", "SERIES", "ROTATION_STRAIN")
PERCENT, SAMPLES = 50, 8


def main() -> int:
    """Press, render and join."""
    options = _options()
    with tempfile.TemporaryDirectory() as folder:
        import installed

        installed.install(options.package.resolve(), Path(folder) / "blender")
        pictures = []
        for name in options.shapes:
            title, volume = pressed(name, Path(folder), Path(folder) / f"{name}.png")
            print(f"{title}: volume {volume:.3f} of that at rest", flush=True)
            pictures.append((title, volume, Path(folder) / f"{name}.png"))
        join(pictures, options.output)
    return 0


def pressed(name: str, folder: Path, picture: Path) -> tuple[str, float]:
    """Render the hare with its ear pulled aside in one shape: its title and volume ratio."""
    import bpy
    import hare_shape
    import numpy as np
    from photographing import photograph

    copy = folder / "large.blend"
    if not copy.exists():
        shutil.copyfile(SCENES / copy.name, copy)
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    scene, hare = bpy.context.scene, bpy.data.objects["Hare"]
    bpy.context.view_layer.objects.active = hare
    hare.palpate.shape = name
    at = hare_shape.ear_tip(1.0) - np.array([0.0, 0.0, BELOW])
    if bpy.ops.palpate.press("EXEC_DEFAULT", at=at.tolist(), by=BY) != {"FINISHED"}:
        raise RuntimeError(f"{name}: the press did not finish")
    turn_to_face(scene)
    scene.cycles.samples = SAMPLES
    photograph(picture, PERCENT)
    title: str = hare.palpate.bl_rna.properties["shape"].enum_items[name].name
    return title, volume(hare, hare.data.shape_keys.key_blocks[-1]) / volume(hare, None)


def turn_to_face(scene: Any) -> None:
    """The camera before the hare, wide enough for a bent ear."""
    from mathutils import Vector

    camera = scene.camera
    camera.location, aim = (0.66, -0.06, 0.20), Vector((0.0, 0.018, 0.098))
    camera.rotation_euler = (aim - camera.location).to_track_quat("-Z", "Y").to_euler()
    camera.data.lens = 88.0
    scene.objects["Table"].rotation_euler.z = 1.5707963 - 0.1
    scene.render.resolution_x, scene.render.resolution_y = 800, 960


def volume(thing: Any, key: Any) -> float:
    """What the drawn mesh encloses, in a shape key or at rest, cubic units."""
    import numpy as np

    places = np.empty(3 * len(thing.data.vertices), dtype=np.float32)
    (key or thing.data.shape_keys.reference_key).points.foreach_get("co", places)
    thing.data.calc_loop_triangles()
    triangles = np.empty(3 * len(thing.data.loop_triangles), dtype=np.int32)
    thing.data.loop_triangles.foreach_get("vertices", triangles)
    a, b, c = places.astype(np.float64).reshape(-1, 3)[triangles.reshape(-1, 3)].transpose(1, 0, 2)
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6.0


def join(pictures: list[tuple[str, float, Path]], output: Path) -> None:
    """Put the pictures beside each other, named, into one file."""
    import bpy
    import numpy as np

    loaded = []
    for _, _, path in pictures:
        image = bpy.data.images.load(str(path))
        width, height = image.size
        loaded.append(np.array(image.pixels[:]).reshape(height, width, 4))
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
