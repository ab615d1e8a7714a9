"""Plays scenarios with the installed extension in a real Blender, its window on a virtual screen.

A scenario is a generator function in `scenarios/`, named for the promise it keeps. It runs inside
Blender, stepped by a timer, and gets a `Stage` (see stage.py) with what a user's hands and eyes do:

    def dragging_dents_the_surface(stage):
        stage.open_scene("sample_scenes/mouse.blend")
        yield from stage.open_sidebar("Palpate")
        with stage.view():
            bpy.ops.palpate.press("INVOKE_DEFAULT")
        here = stage.pixel((0.0, 0.0, 0.06))
        yield from stage.drag([here, (here[0], here[1] - 40)])
        yield from stage.picture("pressed")
        yield from stage.key("RET")
        yield from stage.until(lambda: ..., "the kept layer")
        assert ...

What it yields says how long to wait: `yield` until the viewport has been drawn again, `yield 0.5`
so many seconds. It fails by an exception, and also when Blender or the extension prints a traceback
meanwhile, for Blender swallows those of timers, handlers and modal operators. It also fails after
`limit_seconds` of windowed_blender.py, far more than any needs, and there only so that none hangs.

Before each scenario Blender loads its factory scene; the extension stays installed and enabled.
The scenarios that pytest selected are dealt to two Blenders, which play them side by side, each in
the order of their files; should one crash or hang, that scenario fails and its rest runs in a new
one. Pictures, Blender's output and its reports are left in build/gui/. `make test-gui` builds the
package and plays all but those marked `@at_length`, which `make test-at-length`, a part of
`make test-all`, plays; after that, one alone by `.venv/bin/pytest tests/gui -k dragging_dents`.

`BLENDER_GUI` names the program that starts the windowed Blender, `PALPATE_PACKAGE` the zip. Without
that program everything here is skipped.
"""

from __future__ import annotations

import ast
import os
from pathlib import Path
from typing import Any

import pytest
from windowed_blender import WindowedBlender, package_of, program_of

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]


def scenarios() -> list[Any]:
    """Return `file::function` of every scenario: public functions with one parameter, `stage`."""
    found = []
    for path in sorted((HERE / "scenarios").glob("*.py")):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if not isinstance(node, ast.FunctionDef) or node.name.startswith("_"):
                continue
            if [argument.arg for argument in node.args.args] != ["stage"]:
                continue
            named = {mark.id for mark in node.decorator_list if isinstance(mark, ast.Name)}
            marks = [pytest.mark.at_length] if "at_length" in named else []
            found.append(pytest.param(f"{path.stem}::{node.name}", marks=marks))
    return found


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Make one test of each scenario."""
    if "scenario" in metafunc.fixturenames:
        metafunc.parametrize("scenario", scenarios())


@pytest.fixture(scope="session")
def windowed_blender(request: pytest.FixtureRequest) -> WindowedBlender:
    """Return what became of the selected scenarios, all of which have run by then."""
    selected = [
        item.callspec.params["scenario"]
        for item in request.session.items
        if isinstance(item, pytest.Function) and "scenario" in getattr(item, "fixturenames", ())
    ]
    program, package = program_of(REPOSITORY), package_of(REPOSITORY)
    if not os.access(program, os.X_OK):
        pytest.skip(f"no Blender with a window here: {program} is missing (set BLENDER_GUI)")
    if not package.is_file():
        pytest.fail(f"{package} is missing: run `make test-gui`")
    blender = WindowedBlender(program, package, REPOSITORY)
    blender.play(selected)
    return blender
