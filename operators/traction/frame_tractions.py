"""What presses the vertices in each frame of an animation, for a mesh that is exported."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import bpy
import numpy as np
from numpy.typing import NDArray

from ..layer.layer_groups import BORNE, NORMAL, PRESSURE, SUM
from .point_attribute import point_attribute

Vectors = NDArray[np.float32]
KINDS = {SUM: "FLOAT_VECTOR", BORNE: "FLOAT_VECTOR", NORMAL: "FLOAT_VECTOR", PRESSURE: "FLOAT"}


@dataclass(eq=False)
class FrameTractions:
    """Flat displacements and tractions (3 p,) of one frame after the other, in a file.

    Attributes
    ----------
    points : number of vertices.
    first_frame, step : scene frame of the first ones, and frames from each to the next.
    """

    points: int
    first_frame: float
    step: float
    _file: IO[bytes]
    written: int = 0

    def add(self, moved: Vectors | None, borne: Vectors | None) -> None:
        """Store the next frame's; None for none."""
        for vectors in (moved, borne):
            nothing = np.zeros(3 * self.points, dtype=np.float32)
            self._file.write((nothing if vectors is None else vectors).tobytes())
        self.written += 1

    def at(self, frame: float) -> tuple[Vectors, Vectors]:
        """Displacements and tractions (p, 3); straight between frames that are stored."""
        self._file.flush()
        shape = (self.written, 2, self.points, 3)
        stored = np.memmap(self._file.name, dtype=np.float32, mode="r", shape=shape)
        place = float(np.clip((frame - self.first_frame) / self.step, 0, self.written - 1))
        low = min(int(place), max(0, self.written - 2))
        high = min(low + 1, self.written - 1)
        share = np.float32(place - low)
        moved, borne = (1 - share) * stored[low] + share * stored[high]
        return moved, borne


@contextmanager
def frame_tractions(
    file: Path, points: int, first_frame: float, step: float
) -> Iterator[FrameTractions]:
    """Store frames in a new file, which whoever made its folder removes."""
    with file.open("w+b") as stream:
        yield FrameTractions(points, first_frame, step, stream)


@contextmanager
def shown_by(mesh: bpy.types.Mesh, frames: FrameTractions) -> Iterator[None]:
    """The mesh has the attributes of each frame as it comes; see *Force as data* in the docs."""
    name = mesh.name
    for attribute, kind in KINDS.items():
        point_attribute(mesh, attribute, kind)

    def show(scene: bpy.types.Scene, *_: object) -> None:
        _write(bpy.data.meshes[name], *frames.at(scene.frame_current_final))

    bpy.app.handlers.frame_change_pre.append(show)
    try:
        yield
    finally:
        bpy.app.handlers.frame_change_pre.remove(show)


def _write(mesh: bpy.types.Mesh, moved: Vectors, borne: Vectors) -> None:
    pressure = np.linalg.norm(borne, axis=1)
    normal = np.divide(borne, pressure[:, None], out=np.zeros_like(borne), where=borne != 0.0)
    values = {SUM: moved, BORNE: borne, NORMAL: normal, PRESSURE: pressure}
    for name, value in values.items():
        field = "value" if KINDS[name] == "FLOAT" else "vector"
        mesh.attributes[name].data.foreach_set(field, value.ravel())
    mesh.update_tag()
