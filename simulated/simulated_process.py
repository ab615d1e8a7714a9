"""Simulated device as a child process, for tests, command line and Blender."""

from __future__ import annotations

import contextlib
import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import IO, Any, Self

from ..core.errors import PalpateError
from ..core.files.scratch_folder import ScratchFolder
from ..core.machine import c_runtime, run_module
from ..core.sentence import Sentence
from .hand.options import SimulatedOptions
from .hand.plant import Vector
from .hand.quaternion import Quaternion
from .lines import Lines
from .wire.ports import ANY_SOCKET, HAS_PSEUDO_TERMINALS

# A Python starts in one, on a busy computer in a minute; one that ends instead is told at once.
START_SECONDS = 90.0
ANSWER_SECONDS = 10.0
# Ctrl-C is for the host: the device must survive until the host has released it.
NEW_GROUP = getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)


class SimulatedDevice:
    """Child process that ends with `stop`, with the `with` block, and when this process dies.

    `haply` is the model of a Haply 2DIY to simulate; without it the device speaks the link.

    `python` and `python_args` start Python; inside Blender these are `sys.executable`
    and `bpy.app.python_args`. Raises PalpateError when the device does not start.
    """

    def __init__(
        self,
        options: SimulatedOptions | None = None,
        *,
        haply: str | None = None,
        python: str = sys.executable,
        python_args: Sequence[str] = (),
    ) -> None:
        options = options or SimulatedOptions()
        self._folder: ScratchFolder | None = None
        if not (options.link or HAS_PSEUDO_TERMINALS):
            options = replace(options, link=ANY_SOCKET)
        elif not options.link:
            # A link, so that it comes back at the same path after unplugging.
            self._folder = ScratchFolder("device")
            options = replace(options, link=str(self._folder.path / "port"))
        self.options = options
        model = [] if haply is None else [f"--haply={haply}"]
        self._last_report: dict[str, Any] | None = None
        try:
            self._process = subprocess.Popen(  # noqa: S603 - our own script, no shell
                [
                    python,
                    *python_args,
                    *run_module.command("simulated.device_process"),
                    "--commands",
                    *model,
                    *options.arguments(),
                ],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                start_new_session=True,
                env=c_runtime.for_a_child(),
                creationflags=NEW_GROUP | c_runtime.NO_WINDOW,
            )
        except OSError as error:
            self._remove_folder()
            raise PalpateError(
                "the simulated device cannot be started: {python}: {reason}; check this "
                "installation of Python",
                python=python,
                reason=error.strerror,
            ) from error
        self._said = Lines(_pipe(self._process.stdout).fileno())
        try:
            self.port: str = self._read_json(START_SECONDS)["port"]
        except BaseException:
            self.stop()
            raise

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    @property
    def running(self) -> bool:
        """Whether the process is running."""
        return self._process.poll() is None

    @property
    def pid(self) -> int:
        """Process id."""
        return self._process.pid

    def unplug(self) -> None:
        """Remove the port; `plug_in` brings it back at the same path."""
        self._command("unplug")

    def plug_in(self) -> None:
        """Bring the port back."""
        self._command("plug")

    def press_buttons(self, mask: int) -> None:
        """Hold exactly the buttons of `mask` (0: none)."""
        self._command(f"buttons {mask}")

    def move_hand(self, position: Vector, seconds: float) -> None:
        """Leave the script and bring the hand to `position` (m) in `seconds`."""
        x, y, z = map(float, position)
        self._command(f"move {x!r} {y!r} {z!r} {float(seconds)!r}")

    def turn_hand(self, rotation: Quaternion, seconds: float) -> None:
        """Leave the script and turn the stylus to a unit quaternion (w, x, y, z) in `seconds`; from
        then on the device sends its orientation.
        """
        w, x, y, z = map(float, rotation)
        self._command(f"turn {w!r} {x!r} {y!r} {z!r} {float(seconds)!r}")

    def report(self) -> dict[str, Any]:
        """Counters and present state (see `SimulatedBoard.report`)."""
        self._command("report")
        return self._read_json(ANSWER_SECONDS)

    def stop(self) -> dict[str, Any]:
        """End the process and return its last report, empty if there is none; idempotent."""
        if self._last_report is None:
            self._last_report = self._end()
            self._remove_folder()
        return self._last_report

    def _remove_folder(self) -> None:
        if self._folder:
            self._folder.remove()

    def _end(self) -> dict[str, Any]:
        # This stops it; one that has ended already does not take what is left to say.
        with contextlib.suppress(OSError):
            _pipe(self._process.stdin).close()
        try:
            self._process.wait(ANSWER_SECONDS)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._said.wait_for_end()
        last = b"{}"
        while (line := self._said.next()) is not None:
            last = line
        for pipe in (self._process.stdout, self._process.stderr):
            _pipe(pipe).close()
        report: dict[str, Any] = json.loads(last)
        return report if report.get("end") else {}

    def _command(self, line: str) -> None:
        pipe = _pipe(self._process.stdin)
        try:
            pipe.write(line.encode() + b"\n")
            pipe.flush()
        except (OSError, ValueError) as error:
            raise PalpateError("the simulated device has ended; start it again") from error

    def _read_json(self, seconds: float) -> dict[str, Any]:
        line = self._said.next(seconds)
        if line is None and self._said.ended:
            raise PalpateError(self._reason_for_end())
        if line is None:
            raise PalpateError(
                "the simulated device has not answered for {seconds:g} s; start it again",
                seconds=seconds,
            )
        content: dict[str, Any] = json.loads(line)
        return content

    def _reason_for_end(self) -> Sentence:
        lines = _pipe(self._process.stderr).read().decode(errors="replace").strip().splitlines()
        reason = lines[-1].removeprefix("palpate: ") if lines else Sentence("no reason given")
        return Sentence("the simulated device has ended: {reason}", reason=reason)


def _pipe(stream: IO[bytes] | None) -> IO[bytes]:
    if stream is None:
        raise RuntimeError("the process was started without this pipe")
    return stream
