"""Fingerprint of the surface that a body was baked from, and changes since.

Coordinates are not hashed, since rotating an object changes the last bits of its matrix. They are
projected on a few fixed pseudo-random directions, and the projections compared with a tolerance:
one vertex moved by a ten-thousandth of the body is detected.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import PalpateError
from ...core.sentence import Sentence

PROJECTIONS = 8
# Between the rounding of a float32 matrix, about 1e-7 of the size, and real edits.
TOLERANCE = 2e-6
SEED = 19980331
# Bounds of a text from a file: longer ones, and more or farther vertices than a mesh has, are none.
LONGEST_TEXT, MOST_VERTICES, FARTHEST = 10_000, 2**31, 1e100


@dataclass(frozen=True)
class Fingerprint:
    """Topology, shape and size of a drawn surface, and the rules painted on it.

    ``pins`` and ``stiffness`` are texts that change with pins and stiff regions, ``stack`` one that
    changes with the modifiers that made what was baked; empty where that was the mesh itself.
    """

    vertices: int
    faces: int
    topology: str
    local: tuple[float, ...]
    body: tuple[float, ...]
    size: float
    local_size: float
    pins: str = ""
    stiffness: str = ""
    stack: str = ""

    def to_text(self) -> str:
        """Text stored on the object."""
        return json.dumps(asdict(self))

    @classmethod
    def from_text(cls, text: str) -> Fingerprint:
        """Read what :meth:`to_text` wrote.

        Raises
        ------
        PalpateError
            It is something else.
        """
        try:
            fields = json.loads(text[:LONGEST_TEXT])
            fields["local"], fields["body"] = tuple(fields["local"]), tuple(fields["body"])
            read = cls(**fields)
        except (ValueError, TypeError, LookupError, RecursionError) as problem:
            raise _damaged() from problem
        if not read._is_sound:
            raise _damaged()
        return read

    @property
    def _is_sound(self) -> bool:
        """Whether every value is of its type, and finite."""
        counts = (self.vertices, self.faces)
        numbers = (*self.local, *self.body, self.size, self.local_size)
        texts = (self.topology, self.pins, self.stiffness, self.stack)
        return (
            len(self.local) == len(self.body) == PROJECTIONS
            and all(type(count) is int and 0 <= count < MOST_VERTICES for count in counts)
            and all(type(number) in {int, float} and abs(number) <= FARTHEST for number in numbers)
            and all(type(text) is str for text in texts)
        )


def _damaged() -> PalpateError:
    return PalpateError("what this file says of its body cannot be true; press Make Soft")


def take(
    local: NDArray[np.float64],
    body: NDArray[np.float64],
    corners: NDArray[np.int64],
    face_starts: NDArray[np.int64],
) -> Fingerprint:
    """Fingerprint a surface without rules: vertices (p, 3) in local units and metres, polygons."""
    of_local, of_body = _project(local, body)
    return Fingerprint(
        vertices=len(local),
        faces=len(face_starts),
        topology=digest(corners, face_starts),
        local=of_local,
        body=of_body,
        size=_size(body),
        local_size=_size(local),
    )


def digest(*arrays: NDArray[np.int64]) -> str:
    """Short hex digest of integer arrays."""
    sha = hashlib.sha256()
    for array in arrays:
        sha.update(np.ascontiguousarray(array, dtype=np.int64).tobytes())
        sha.update(b"|")
    return sha.hexdigest()[:16]


def changed_body(old: Fingerprint, new: Fingerprint) -> str:
    """Changes that make the baked body unusable, as text for the panel; empty if none."""
    if (old.vertices, old.faces) != (new.vertices, new.faces):
        return Sentence(
            "the mesh has {vertices} vertices and {faces} faces now, {old_vertices} and "
            "{old_faces} when it was baked",
            vertices=new.vertices,
            faces=new.faces,
            old_vertices=old.vertices,
            old_faces=old.faces,
        )
    if old.topology != new.topology:
        return Sentence("the faces are connected differently than when it was baked")
    if old.stack != new.stack:
        return Sentence("the modifiers that made what was baked have changed")
    if _same(old.body, new.body, old.size, old.vertices):
        return ""
    if _same(old.local, new.local, old.local_size, old.vertices):
        return Sentence("the object's scale or the scene's unit scale changed since the bake")
    return Sentence("the shape was edited since the bake")


def _project(*places: NDArray[np.float64]) -> list[tuple[float, ...]]:
    """Projections of each array of places (p, 3) on the same directions."""
    generator, flat = np.random.default_rng(SEED), [points.ravel() for points in places]
    # One direction at a time: they are the same numbers as all at once, in less memory.
    rows = (generator.standard_normal(flat[0].size) for _ in range(PROJECTIONS))
    products = np.array([[float(row @ points) for points in flat] for row in rows])
    return [tuple(column.tolist()) for column in products.T]


def _same(old: tuple[float, ...], new: tuple[float, ...], size: float, count: int) -> bool:
    allowed = TOLERANCE * size * np.sqrt(count)
    return bool(np.all(np.abs(np.subtract(old, new)) <= allowed))


def _size(points: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
