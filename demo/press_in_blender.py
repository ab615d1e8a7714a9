"""Part of the demo that runs in Blender: bake, press, photograph. Writes raw.json, samples.npz.

Run by make_demo.py: BLENDER_PYTHON press_in_blender.py --package ZIP --output FOLDER, where
BLENDER_PYTHON has the bpy module.
"""

import argparse
import json
import shutil
import sys
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
SCENES = HERE.parent / "sample_scenes"

from installed import install, palpate  # noqa: E402


def main() -> int:
    """Run this part."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--package", type=Path, required=True)
    parser.add_argument("--output", type=Path, required=True)
    options = parser.parse_args()
    # A fresh home, without remains of an earlier demo.
    output = options.output.resolve()
    home = output / "blender"
    shutil.rmtree(home, ignore_errors=True)
    install(options.package.resolve(), home)
    import bpy

    raw: dict[str, Any] = {"blender": bpy.app.version_string}
    raw |= demo_cube(output)
    raw |= demo_mouse(output)
    (output / "raw.json").write_text(json.dumps(raw, indent=1), encoding="utf-8")
    return 0


def open_scene(name: str, folder: Path) -> Any:
    """Open a copy of a sample scene, with the body file next to the copy."""
    import bpy

    copy = folder / f"{name}.blend"
    shutil.copyfile(SCENES / copy.name, copy)
    bpy.ops.wm.open_mainfile(filepath=str(copy))
    return bpy.data.objects[name.title()]


def demo_cube(folder: Path) -> dict[str, Any]:
    """Press the paper's cube: its own tetrahedra, pressed 5 mm on the top and on the side."""
    import baking
    import bpy
    import numpy as np
    from photographing import photograph, pixel

    say("cube: baking")
    cube = open_scene("cube", folder)
    bpy.context.scene.palpate.tip = "POINT"
    figures = baking.rebuild_body(cube)
    press_once = palpate("operators.press.press_once").press_once
    pictures = [photograph(folder / "cube-before.png", 75)]
    presses = []
    for name, at, by in (
        ("top", (0.0, 0.0, 0.05), (0.0, 0.0, -0.005)),
        ("side", (0.0, -0.025, 0.025), (0.0, 0.005, 0.0)),
    ):
        say(f"cube: pressing the {name}")
        pressed = press_once(cube, bpy.context.scene, at, by)
        pictures.append(photograph(folder / f"cube-{name}.png", 75))
        layers, kept = palpate("operators.layer.layers"), cube.modifiers.active
        moved = layers.displacement(cube, kept)
        presses.append(
            {
                "name": name,
                "at": pixel(list(at)),
                "tip": pixel([a + b for a, b in zip(at, by, strict=True)]),
                "max_displacement_mm": 1e3 * float(np.linalg.norm(moved, axis=1).max()),
                "force_n": list(pressed.force),
            }
        )
        layers.remove(cube, kept)
    return {
        "cube": figures,
        "cube_presses": presses,
        "cube_pictures": [path.name for path in pictures],
    }


def demo_mouse(folder: Path) -> dict[str, Any]:
    """Press the plush mouse: Make Soft, then the device presses its back about 8 mm."""
    import baking
    import numpy as np
    import pressing
    from photographing import photograph, pixel

    say("mouse: Make Soft")
    mouse = open_scene("mouse", folder)
    figures = baking.make_soft(mouse)
    say("mouse: picture before")
    pictures = [photograph(folder / "mouse-before.png")]
    say(f"mouse: the device presses for {pressing.SECONDS:g} s")
    place = pressing.place_near(mouse, np.array([-0.024, -0.025, 0.047]))
    pressed, samples = pressing.press_with_device(mouse, place, 0.0082, folder)
    np.savez_compressed(folder / "samples.npz", samples=samples)
    say("mouse: picture after")
    pictures.append(photograph(folder / "mouse-after.png"))
    pressed["contact"]["pixels"] = {
        name: pixel(pressed["contact"][name]) for name in ("proxy", "probe")
    }
    return {"mouse": figures, **pressed, "mouse_pictures": [path.name for path in pictures]}


def say(what: str) -> None:
    """Print progress."""
    print(f"demo: {what}", flush=True)


if __name__ == "__main__":
    sys.exit(main())
