"""Table of the forces in each frame, as CSV."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ...core.contact.touches import ToolTouch, Touch
from ...core.files.atomic_file import atomic_file
from ..object.drawn_body import DrawnBody
from ..tool.tool_depth import pressed_depth
from .frames.pressed_frames import PressedFrame

COLUMNS = (
    "frame",
    "seconds",
    "finger",
    "force_x_N",
    "force_y_N",
    "force_z_N",
    "force_N",
    "area_m2",
    "largest_pressure_Pa",
    "depth_m",
)


@dataclass(eq=False)
class FrameRows:
    """Rows of frames as they are pressed, a row a finger.

    Force on the finger in world axes, contact area, pressure, and how far the tool has gone beyond
    the rest surface; SI units.
    """

    drawn: DrawnBody
    frames_per_second: float
    largest_force: float = 0.0
    _rows: list[tuple[object, ...]] = field(default_factory=list)

    def add(self, here: PressedFrame) -> None:
        """Add a frame."""
        for number, (finger, force) in enumerate(zip(here.fingers, here.forces, strict=True)):
            strength = float(np.linalg.norm(finger.force))
            self.largest_force = max(self.largest_force, strength)
            figures = (
                here.frame / self.frames_per_second,
                *force,
                strength,
                finger.area,
                finger.largest_pressure,
                self._depth(finger),
            )
            seconds, *rest = (f"{figure:.9g}" for figure in figures)
            self._rows.append((here.frame, seconds, number + 1, *rest))

    def _depth(self, finger: Touch) -> float:
        if not isinstance(finger, ToolTouch):
            return 0.0
        mesh = self.drawn.body.mesh
        return pressed_depth(mesh, finger.tool, finger.pose, -finger.force, finger.displacements)

    def write(self, target: Path) -> None:
        """Write the table.

        Raises
        ------
        UnwritableError
            As for :func:`....core.files.atomic_file.atomic_file`.
        """
        text = io.StringIO(newline="")
        table = csv.writer(text)
        table.writerow(COLUMNS)
        table.writerows(self._rows)
        with atomic_file(target) as file:
            file.write(text.getvalue().encode("utf-8"))
