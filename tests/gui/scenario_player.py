"""Plays scenarios; runs inside Blender, started by windowed_blender.py with a job file.

Each scenario is a generator that a timer steps, so that Blender handles events and draws meanwhile.
At each beginning and end its report is written, so that a crash loses nothing.
"""

from __future__ import annotations

import ctypes
import faulthandler
import importlib.util
import json
import sys
import time
import traceback
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parent))

from stage import MODULE, Stage, Wait

STEP_SECONDS = 0.01
# A redraw that does not come is not worth more than this: the scenario's own asserts will say it.
LONGEST_REDRAW_SECONDS = 5.0
# After a scenario's limit, so long until Blender counts as hung and is ended from within.
GRACE_SECONDS = 20.0


class Player:
    """Plays one scenario after the other; `step` is called by a timer until it returns None."""

    def __init__(self, job: dict[str, Any], scenarios: list[str]) -> None:
        self.job = job
        self.waiting = scenarios
        self.report: dict[str, dict[str, object]] = {}
        self.name = ""
        self.stage = self.new_stage("")
        self.scenario: Wait | None = None
        self.wake: Callable[[], bool] = lambda: True
        self.deadline = 0.0
        self.draws = self.draws_before = 0

    def new_stage(self, name: str) -> Stage:
        """A stage for a scenario."""
        repository, output, files = (
            Path(self.job[folder]) for folder in ("repository", "pictures", "files")
        )
        return Stage(repository, output, files, name, tuple(self.job["arguments"]))

    def count_draw(self) -> None:
        """Note that the viewport has been drawn."""
        self.draws += 1

    def step(self) -> float | None:
        """Do what is due; return the seconds until the next call."""
        if self.scenario is None:
            if not self.waiting:
                bpy.ops.wm.quit_blender()
                return None
            self.begin(self.waiting.pop(0))
        elif time.monotonic() > self.deadline:
            self.scenario.close()
            self.end(f"the scenario was not over after {self.job['limit']:g} s")
        elif self.wake():
            self.advance()
        return STEP_SECONDS

    def begin(self, name: str) -> None:
        """Load the factory scene and start a scenario."""
        self.name = name
        self.stage = self.new_stage(name)
        self.report[name] = {"state": "running", "failure": "", "pictures": [], "figures": {}}
        self.write_report()
        mark(f"scenario begins: {name}")
        self.deadline, self.draws_before = time.monotonic() + self.job["limit"], self.draws
        faulthandler.dump_traceback_later(self.job["limit"] + GRACE_SECONDS, exit=True)
        self.scenario = self.played(name)
        self.wake_after(0.0)

    def played(self, name: str) -> Wait:
        """The scenario, in a fresh scene."""
        bpy.ops.wm.read_homefile(use_factory_startup=True)
        yield
        file, _, function_name = name.partition("::")
        folder = Path(__file__).parent / self.job["folder"]
        function = getattr(load(folder / f"{file}.py"), function_name)
        yield from function(self.stage)

    def advance(self) -> None:
        """Run the scenario to its next yield."""
        assert self.scenario is not None
        try:
            self.wake_after(next(self.scenario))
        except StopIteration:
            self.end("")
        except Exception:  # noqa: BLE001 -- whatever it is, pytest shows it
            self.end(traceback.format_exc())

    def wake_after(self, pause: float | None) -> None:
        """Wait for seconds, or for None until the viewport has been drawn."""
        begun = time.monotonic()
        if pause is not None:
            self.wake = lambda: time.monotonic() >= begun + pause
            return
        draws = self.draws
        for window in bpy.context.window_manager.windows:
            for area in window.screen.areas:
                area.tag_redraw()
        self.wake = lambda: self.draws > draws or time.monotonic() > begun + LONGEST_REDRAW_SECONDS

    def end(self, failure: str) -> None:
        """Note how the scenario ended."""
        if failure:
            self.stage.photograph("failed")
        self.report[self.name] = {
            "state": "failed" if failure else "held",
            "failure": failure,
            "pictures": self.stage.pictures,
            "figures": self.stage.figures,
        }
        self.scenario = None
        self.write_report()
        seconds = time.monotonic() - (self.deadline - self.job["limit"])
        mark(
            f"scenario ends: {self.name}, {seconds:.0f} s, {self.draws - self.draws_before} frames"
        )

    def write_report(self) -> None:
        """Write the report whole, or not at all."""
        result = Path(self.job["result"])
        partial = result.with_suffix(".partial")
        partial.write_text(json.dumps(self.report, indent=1), encoding="utf-8")
        partial.replace(result)


def load(path: Path) -> ModuleType:
    """Import a file of scenarios."""
    if str(path.parent) not in sys.path:
        sys.path.append(str(path.parent))
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def mark(line: str) -> None:
    """Print a line that stands in the log where it belongs, between what C and Python print."""
    ctypes.CDLL(None).fflush(None)
    print(line, flush=True)


def install(package: str) -> None:
    """Install the extension the way a user does, and enable it."""
    bpy.ops.extensions.package_install_files(
        filepath=package, repo="user_default", enable_on_install=True
    )
    # The operator returns FINISHED for a missing or broken file too.
    assert MODULE in bpy.context.preferences.addons, f"{package} was not installed and enabled"


def main() -> None:
    """Install the package and start the timer."""
    job = json.loads(Path(sys.argv[sys.argv.index("--") + 1]).read_text(encoding="utf-8"))
    faulthandler.enable()
    bpy.context.preferences.view.show_splash = False
    # Smooth edges come by drawing each view eight times over.
    bpy.context.preferences.system.viewport_aa = "OFF"
    player = Player(job, job["scenarios"])

    def start() -> None:
        try:
            install(job["package"])
        except Exception:
            # Without a scenario begun, pytest shows the log, where this exception stands.
            bpy.ops.wm.quit_blender()
            raise
        bpy.types.SpaceView3D.draw_handler_add(player.count_draw, (), "WINDOW", "POST_PIXEL")
        bpy.app.timers.register(player.step, persistent=True)

    # The window comes after this script, and installing needs it.
    bpy.app.timers.register(start, first_interval=0.1, persistent=True)


main()
