"""Steps of the demo: Blender bakes, presses and photographs; then charts and the report.

python demo/make_demo.py --blender BLENDER_PYTHON --package ZIP [--output FOLDER] [--readme PNG]
"""

import argparse
import json
import subprocess
import sys
from pathlib import Path

import charts
import numpy as np
from report import report, summary

HERE = Path(__file__).resolve().parent


def main() -> int:
    """Run all steps; returns the exit status of the first failure."""
    options = _options()
    output: Path = options.output
    output.mkdir(parents=True, exist_ok=True)
    command = [*options.blender, str(HERE / "press_in_blender.py")]
    command += ["--package", str(options.package), "--output", str(output)]
    log = output / "blender.log"
    with log.open("w", encoding="utf-8") as file:
        blender = subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
        )
        for line in blender.stdout or ():
            file.write(line)
            if line.startswith("demo: "):
                print(line.removeprefix("demo: "), end="", flush=True)
    if blender.wait():
        print(_tail(log), file=sys.stderr)
        print(f"demo: Blender ended with status {blender.returncode}; see {log}", file=sys.stderr)
        return 1
    made = _report(output, options.readme)
    print(summary(made))
    return 0


def _report(output: Path, readme: Path | None) -> dict[str, object]:
    """Draw the figures and write report.json."""
    raw = json.loads((output / "raw.json").read_text(encoding="utf-8"))
    with np.load(output / "samples.npz", allow_pickle=False) as file:
        samples = file["samples"]
    press, contact = raw["press"], raw["contact"]
    cube_pictures = [output / name for name in raw["cube_pictures"]]
    before, after = (output / name for name in raw["mouse_pictures"])
    figures = [
        charts.force_curve(output / "force-depth.png", samples, press),
        charts.readme_picture(output / "press.png", before, after, contact, samples, press),
        charts.cube_picture(output / "cube.png", cube_pictures, raw["cube_presses"]),
    ]
    if readme is not None:
        readme.parent.mkdir(parents=True, exist_ok=True)
        readme.write_bytes(figures[1].read_bytes())
    pictures = [str(path) for path in (before, after, *cube_pictures, *figures)]
    made = report(raw, pictures)
    text = json.dumps(made, indent=2, allow_nan=False)
    (output / "report.json").write_text(text + "\n", encoding="utf-8")
    return made


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    asked = "a Python that has the bpy module, or a command that calls one"
    parser.add_argument("--blender", required=True, nargs="+", help=asked)
    parser.add_argument("--package", type=Path, required=True, help="the extension's zip")
    parser.add_argument("--output", type=Path, default=Path("build/demo"))
    parser.add_argument("--readme", type=Path, help="also write the README's picture here")
    return parser.parse_args()


def _tail(log: Path, lines: int = 25) -> str:
    return "\n".join(log.read_text(encoding="utf-8").splitlines()[-lines:])


if __name__ == "__main__":
    sys.exit(main())
