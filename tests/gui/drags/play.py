"""Plays twenty drags at each of two UI scales on models, and prints a table of what came of them.

    python tests/gui/drags/play.py MODEL ... [--table FILE]

Models are .blend, .gltf, .glb, .obj, .stl or .ply; without any, the sample scenes. Pictures and all
figures are left in build/drags/.
"""

from __future__ import annotations

import argparse
import json
import shutil
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[2]
sys.path.insert(0, str(HERE.parent))

from windowed_blender import Outcome, WindowedBlender, package_of, program_of  # noqa: E402

SCENARIO = "model_drags::drags_press_where_the_cursor_is"
# Drawn by the processor, forty drags take minutes.
LIMIT_SECONDS = 1700.0
OWN = ("mouse", "drumstick", "fingertip")
COLUMNS = (
    "model",
    "vertices",
    "predicted",
    "taken",
    "hits at 1",
    "hits at 1.75",
    "more elsewhere at 1",
    "more elsewhere at 1.75",
    "refused",
)


def main() -> int:
    """Play and print; 1 when a drag missed."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("models", nargs="*", type=Path)
    asked = parser.parse_args().models or [
        REPOSITORY / "sample_scenes" / f"{name}.blend" for name in OWN
    ]
    print("| " + " | ".join(COLUMNS) + " |\n|" + "---|" * len(COLUMNS), flush=True)
    failed = 0
    for path in asked:
        outcome = play(path)
        figures = {"model": path.name} | outcome.figures
        print("| " + " | ".join(str(figures.get(column, "")) for column in COLUMNS) + " |")
        if outcome.failure:
            print(outcome.failure.splitlines()[-1])
        sys.stdout.flush()
        failed += bool(outcome.failure)
    return 1 if failed else 0


def play(path: Path) -> Outcome:
    """What became of the drags at one model."""
    output = REPOSITORY / "build" / "drags" / path.stem
    output.mkdir(parents=True, exist_ok=True)
    # A copy, since bodies are stored beside a file.
    model = shutil.copyfile(path, output / path.name)
    blender = WindowedBlender(
        program_of(REPOSITORY),
        package_of(REPOSITORY),
        REPOSITORY,
        folder="drags",
        arguments=(str(model),),
        limit_seconds=LIMIT_SECONDS,
        output=output,
    )
    blender.play([SCENARIO])
    outcome = blender.outcomes[SCENARIO]
    (output / "figures.json").write_text(json.dumps(outcome.figures, indent=1), encoding="utf-8")
    return outcome


if __name__ == "__main__":
    sys.exit(main())
