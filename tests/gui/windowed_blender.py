"""Starts the windowed Blender, hands it scenarios, and reads back what became of them."""

from __future__ import annotations

import json
import os
import re
import subprocess
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from pathlib import Path

PLAYER = Path(__file__).with_name("scenario_player.py")
# Software drawing is slow to start; what a scenario may take is kept by the player itself.
SECONDS_TO_START = 120
LONGEST_RUN_SECONDS = 1800
LINES_OF_LOG = 60
TRACEBACK = re.compile(r"Traceback \(most recent call last\):\n(?:[ ].*\n)+")
# Drawn by the processor, so every pixel takes time; the panels' text is still read easily.
SCREEN = "1280x800"
# A window that is drawn by the processor keeps about one core busy.
AT_ONCE = min(2, os.cpu_count() or 1)
# Xvfb looks for a free display and takes it in two steps; two that look at once find the same one.
SECONDS_BETWEEN_STARTS = 3.0


@dataclass(frozen=True)
class Outcome:
    """How one scenario ended."""

    failure: str
    """Why it failed, as text with tracebacks; empty when it held."""
    pictures: tuple[str, ...] = ()
    figures: dict[str, object] = field(default_factory=dict)


@dataclass
class WindowedBlender:
    """Plays scenarios with one package, in as few starts of Blender as possible."""

    program: Path
    package: Path
    repository: Path
    folder: str = "scenarios"
    """Of the scenarios' files, beside this one."""
    arguments: tuple[str, ...] = ()
    """For the scenarios, as `stage.arguments`."""
    limit_seconds: float = 300.0
    """For each scenario, against hanging only."""
    output: Path | None = None
    """Folder of pictures and logs; build/gui without one."""
    screen: str = SCREEN
    """Pixels of the window, across and down."""
    outcomes: dict[str, Outcome] = field(default_factory=dict)

    def play(self, scenarios: list[str]) -> None:
        """Fill `outcomes` with one for each scenario, played by some Blenders side by side."""
        uncover(self.repository)
        with ThreadPoolExecutor(AT_ONCE) as players:
            dealt = [scenarios[first::AT_ONCE] for first in range(AT_ONCE)]
            for outcomes in players.map(self._play_in_order, range(1, AT_ONCE + 1), dealt):
                self.outcomes |= outcomes

    def _play_in_order(self, player: int, scenarios: list[str]) -> dict[str, Outcome]:
        """Play scenarios in one Blender, and in a new one what is left when it crashes."""
        time.sleep((player - 1) * SECONDS_BETWEEN_STARTS)
        pictures = self.output or self.repository / "build" / "gui"
        pictures.mkdir(parents=True, exist_ok=True)
        outcomes: dict[str, Outcome] = {}
        waiting = list(scenarios)
        start = 0
        while waiting:
            start += 1
            log = pictures / f"blender-{player}.{start}.log"
            result = log.with_suffix(".json")
            result.unlink(missing_ok=True)
            self._run_blender(waiting, pictures, log, result)
            played = self._read(log, result, waiting)
            outcomes |= played
            waiting = [scenario for scenario in waiting if scenario not in played]
        return outcomes

    def _run_blender(self, scenarios: list[str], pictures: Path, log: Path, result: Path) -> None:
        with tempfile.TemporaryDirectory(prefix="palpate-gui-") as user_folder:
            files = Path(user_folder) / "files"
            files.mkdir()
            job = Path(user_folder) / "job.json"
            job.write_text(
                json.dumps(
                    {
                        "scenarios": scenarios,
                        "folder": self.folder,
                        "arguments": self.arguments,
                        "limit": self.limit_seconds,
                        "package": str(self.package),
                        "repository": str(self.repository),
                        "pictures": str(pictures),
                        "files": str(files),
                        "result": str(result),
                    }
                ),
                encoding="utf-8",
            )
            longest = max(LONGEST_RUN_SECONDS, int(self.limit_seconds) + SECONDS_TO_START)
            environment = os.environ | {
                "BLENDER_USER_RESOURCES": user_folder,
                "TIMEOUT": str(longest),
                "SCREEN": self.screen,
            }
            command = [str(self.program), "run", "--enable-event-simulate", "--factory-startup"]
            command += ["--python-exit-code", "3", "--python", str(PLAYER), "--", str(job)]
            with log.open("wb") as text:
                subprocess.run(
                    command,
                    check=False,
                    cwd=self.repository,
                    env=environment,
                    stdin=subprocess.DEVNULL,
                    stdout=text,
                    stderr=subprocess.STDOUT,
                    timeout=longest + SECONDS_TO_START,
                )

    def _read(self, log: Path, result: Path, scenarios: list[str]) -> dict[str, Outcome]:
        """Return outcomes of all that were at least begun; of the first, if none was."""
        reported = json.loads(result.read_text(encoding="utf-8")) if result.is_file() else {}
        text = log.read_text(encoding="utf-8", errors="replace")
        if not reported:
            return {
                scenarios[0]: Outcome(f"Blender did not get as far as a scenario:\n{tail(text)}")
            }
        return {name: _outcome(name, report, text) for name, report in reported.items()}


def _outcome(name: str, report: dict[str, object], log: str) -> Outcome:
    printed = log.partition(f"scenario begins: {name}\n")[2].partition("scenario begins: ")[0]
    failure = str(report["failure"])
    if report["state"] == "running":
        failure = f"Blender ended in the middle of the scenario:\n{tail(printed)}"
    elif any(is_of_a_file(one) for one in TRACEBACK.findall(printed)):
        failure += f"\nBlender printed a traceback meanwhile:\n{tail(printed)}"
    pictures = report["pictures"]
    figures = report["figures"]
    assert isinstance(pictures, list)
    assert isinstance(figures, dict)
    return Outcome(failure.strip(), tuple(str(picture) for picture in pictures), figures)


def is_of_a_file(traceback: str) -> bool:
    """Whether Python code of a file is in a traceback. In others are only Blender's own one-line
    expressions, as for a tool's hint after the mode has changed.
    """
    return re.search(r'File "(?!<string>)', traceback) is not None


def program_of(repository: Path) -> Path:
    """What starts the windowed Blender: `BLENDER_GUI`, or its usual place."""
    usual = "../shared/blender-gui/blender-gui"
    return (repository / os.environ.get("BLENDER_GUI", usual)).resolve()


def package_of(repository: Path) -> Path:
    """The zip to install: `PALPATE_PACKAGE`, or the one of make."""
    windowed = "build/packages/palpate-windowed.zip"
    return (repository / os.environ.get("PALPATE_PACKAGE", windowed)).resolve()


def uncover(folder: Path) -> None:
    """Unmount what an earlier folder of this name left in the windowed Blender's root.

    That root shows a folder by a bind mount, made once for each name. Where the folder has been
    deleted and made anew since, as a clean checkout is, the mount still shows the deleted one.
    """
    root = Path(os.environ.get("BLENDER_ROOT", "~/.cache/blender-gui/root")).expanduser()
    shown = root / folder.relative_to("/")
    # Path.is_mount compares devices, and a bind mount is mostly of the same one.
    mounted = subprocess.run(["mountpoint", "-q", str(shown)], check=False).returncode == 0
    if mounted and not shown.samefile(folder):
        subprocess.run(["umount", "--lazy", str(shown)], check=True)


def tail(text: str) -> str:
    """Return the last lines of a log."""
    return "\n".join(text.splitlines()[-LINES_OF_LOG:])
