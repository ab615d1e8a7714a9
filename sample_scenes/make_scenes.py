"""Make the sample scenes, soft already: BLENDER_PYTHON make_scenes.py --package ZIP [--only NAME].

BLENDER_PYTHON has the bpy module; use that of the oldest Blender we support, since newer ones read
older files. The body files that appear in `palpate/` beside the scenes are not kept: the tetrahedra
are inside the .blend, and Rebuild Body makes the same body from them. The cache that a scene plays
is kept there.
"""

import argparse
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE / "free"), str(HERE.parent / "demo")]


def main() -> int:
    """Write the scenes into the chosen folder, with their bodies' tetrahedra inside."""
    options = _options()
    options.output.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as home:
        import installed

        installed.install(options.package.resolve(), Path(home))
        # Only now: these import bpy, which finds its home when it is first imported.
        import bodies
        import bowl_scene
        import bpy
        import finger_scenes
        import lifted_scene
        import material_scene
        import scenes
        import stacked_scene
        import table_scene

        bpy.context.preferences.filepaths.save_version = 0
        stored = {"Cube": bodies.cube_tets()}
        stored |= {name.title(): bodies.stored_tets(name) for name in ("drumstick", "hare")}
        stored |= finger_scenes.tets() | lifted_scene.tets() | stacked_scene.tets()
        stored |= table_scene.tets() | bowl_scene.tets()
        stored |= material_scene.tets()
        for name, (make, finish) in {
            "cube": (lambda: [scenes.cube_scene()], None),
            "mouse": (lambda: [scenes.mouse_scene()], None),
            "drumstick": (lambda: [scenes.drumstick_scene()], None),
            "pinch": (finger_scenes.pinch_scene, finger_scenes.keep_pinches),
            "dents": (finger_scenes.dents_scene, finger_scenes.keep_dents),
            "imprint": (finger_scenes.imprint_scene, finger_scenes.keep_imprints),
            "animated": (finger_scenes.animated_scene, finger_scenes.bake_animation),
            "fingertip": (finger_scenes.fingertip_scene, None),
            "lifted": (lifted_scene.lifted_scene, lifted_scene.bake_lift),
            "stacked": (stacked_scene.stacked_scene, stacked_scene.settle_stack),
            "table": (table_scene.table_scene, table_scene.bake_press),
            "bowl": (bowl_scene.bowl_scene, bowl_scene.settle_teddy),
            "materials": (material_scene.material_scene, material_scene.keep_presses),
            "large": (lambda: [scenes.hare_scene()], None),
        }.items():
            if options.only not in {None, name}:
                continue
            made = make()
            path = options.output / f"{name}.blend"
            # Saved first, so that the body file goes beside it and the user's folder stays clean.
            bpy.ops.wm.save_as_mainfile(filepath=str(path), compress=True)
            for body in made:
                bodies.attach(body, stored[body.name])
            if finish is not None:
                finish()
            bpy.context.view_layer.objects.active = made[0]
            bpy.ops.wm.save_mainfile(compress=True)
            vertices = sum(len(body.data.vertices) for body in made)
            print(f"{path.name}: {vertices} vertices, {path.stat().st_size} bytes")
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--package", type=Path, required=True, help="the extension's zip")
    parser.add_argument("--output", type=Path, default=HERE)
    parser.add_argument("--only", metavar="NAME", help="make this one alone")
    return parser.parse_args()


if __name__ == "__main__":
    sys.exit(main())
