"""A table of power series, one for each freedom of the free surface, filled in any order.

It stands where the paper's tables of L for +F0 and -F0 stand in (16): displacements are summed over
the loaded freedoms, each with its own second and third order. Both signs come from one series; the
columns are kept packed (:mod:`.column_codec`).
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...body.soft_body import SoftBody
from ...stiffness.freedoms import freedoms
from .column_codec import ColumnCodec
from .continued_powers import continued_powers
from .power_series import ORDER, SeriesSolid
from .series_entries import TOLERANCE, WANTED_SHARE, SeriesEntries, series_entries
from .table_file import TableFileError, read_table, write_table

KIND = "series"
# Errors of packing, for each order, relative to the linear displacement at the largest force.
PACKING_ERROR = 5e-4
# Unpacked columns that are kept: of some 30 nodes.
COLUMNS_AT_HAND = 200


@dataclass(eq=False)
class SeriesTable:
    """Second and third order of every freedom, ``3 * place in the free surface + axis``.

    May be filled by one thread and drawn from by another.

    Attributes
    ----------
    body : whose it is.
    codec : how its columns are packed.
    is_filled : bool (m,).
    largest_force : (m,), F0 for a body of 1 Pa, newton; of both signs.
    bound : (m,), claimed of the relative error at +F0 and -F0; see :mod:`.series_entries`.
    is_polished : bool (m,), whether Newton's method was needed.
    """

    body: SoftBody
    codec: ColumnCodec
    is_filled: NDArray[np.bool_]
    largest_force: NDArray[np.float64]
    bound: NDArray[np.float64]
    is_polished: NDArray[np.bool_]
    _steps: NDArray[np.float64]
    _packed: dict[int, tuple[bytes, bytes]]
    _at_hand: OrderedDict[int, NDArray[np.float32]] = field(default_factory=OrderedDict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    @classmethod
    def empty(cls, body: SoftBody) -> SeriesTable:
        """A table with nothing in it."""
        compliance = body.compliance
        codec = ColumnCodec.of(body.mesh.nodes[compliance.free_surface], compliance)
        count = 3 * compliance.node_count
        no, zero = np.zeros(count, dtype=bool), np.zeros(count)
        return cls(body, codec, no, zero, zero.copy(), no.copy(), np.zeros((count, 2)), {})

    @property
    def nbytes(self) -> int:
        """Bytes of what is filled, and of the bases it is packed in."""
        with self._lock:
            packed = sum(len(one) + len(other) for one, other in self._packed.values())
        return packed + sum(basis.nbytes for basis in self.codec.bases)

    def has(self, places: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Whether all three freedoms of places (k,) of the free surface are filled, (k,)."""
        return np.asarray(self.is_filled.reshape(-1, 3)[places].all(axis=1), dtype=np.bool_)

    def fill(
        self, solid: SeriesSolid, wanted: NDArray[np.int64], may_polish: bool = True
    ) -> NDArray[np.int64]:
        """Compute the entries of the ``wanted`` freedoms (k,).

        Returns those whose largest force is smaller than wanted, for want of polishing.
        """
        entries = series_entries(solid, wanted, may_polish)
        self.put(wanted, entries)
        return wanted[entries.is_short]

    def put(self, filled: NDArray[np.int64], entries: SeriesEntries) -> None:
        """Keep the entries of the ``filled`` freedoms (k,)."""
        force, first = entries.largest_force, entries.first_norm
        second, second_step, second_error = self.codec.encode(
            entries.second, PACKING_ERROR * first / force
        )
        third, third_step, third_error = self.codec.encode(
            entries.third, PACKING_ERROR * first / force**2
        )
        packing = (second_error * force + third_error * force**2) / first
        with self._lock:
            for at, freedom in enumerate(filled.tolist()):
                self._packed[freedom] = second[at], third[at]
                # A polished entry takes the place of an earlier one.
                self._at_hand.pop(freedom, None)
            self._steps[filled] = np.stack([second_step, third_step], axis=1)
            self.largest_force[filled] = force
            self.bound[filled] = entries.bound + packing
            self.is_polished[filled] = entries.is_polished
            # Last, since whoever draws looks here first.
            self.is_filled[filled] = True

    def columns(self, freedom: int) -> NDArray[np.float32]:
        """Second and third order (2, n, 3) of a freedom that is filled, for a body of 1 Pa."""
        with self._lock:
            columns = self._at_hand.get(freedom)
            if columns is None:
                pairs = zip(self._packed[freedom], self._steps[freedom], strict=True)
                both = [self.codec.decode(packed, float(step)) for packed, step in pairs]
                columns = np.stack(both).reshape(2, -1, 3)
                self._at_hand[freedom] = columns
                if len(self._at_hand) > COLUMNS_AT_HAND:
                    self._at_hand.popitem(last=False)
            else:
                self._at_hand.move_to_end(freedom)
        return columns

    def displacements(
        self,
        nodes: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None = None,
    ) -> NDArray[np.float64]:
        """Displacements (n, 3) of the free surface nodes; arguments as :meth:`SoftBody.deform`.

        As (16), summed over freedoms; those that are not filled stay linear. Beyond a freedom's
        largest force its displacement goes on straight (:mod:`.continued_powers`).
        """
        moved = self.body.deform(nodes, nodal_forces, young_modulus)
        places, loads = self.loads(nodes, nodal_forces, young_modulus)
        flat = np.zeros(len(self.is_filled))
        flat[freedoms(places)] = loads.ravel()
        loaded = np.flatnonzero(self.is_filled & (flat != 0.0))
        squares, cubes = continued_powers(flat[loaded], self.largest_force[loaded])
        for freedom, square, cube in zip(loaded.tolist(), squares, cubes, strict=True):
            second, third = self.columns(freedom)
            moved = moved + square * second + cube * third
        return moved

    def loads(
        self,
        nodes: NDArray[np.int64],
        nodal_forces: NDArray[np.float64],
        young_modulus: float | None = None,
    ) -> tuple[NDArray[np.int64], NDArray[np.float64]]:
        """Places (k,) of the free surface, ascending, and the loads (k, 3) on them at 1 Pa."""
        modulus = self.body.modulus(young_modulus)
        places = self.body.free_index(np.asarray(nodes, dtype=np.int64).reshape(-1))
        free = places >= 0
        once, which = np.unique(places[free], return_inverse=True)
        loads = np.zeros((len(once), 3))
        np.add.at(loads, which, np.asarray(nodal_forces).reshape(-1, 3)[free] / modulus)
        return once, loads

    def save(self, path: Path) -> None:
        """Write what is filled; an older file is replaced in one step.

        Raises
        ------
        UnwritableError
            The place cannot be written.
        """
        with self._lock:
            filled = np.flatnonzero(self.is_filled)
            parts = [part for freedom in filled.tolist() for part in self._packed[freedom]]
            arrays: dict[str, NDArray[Any]] = {
                "order": np.array([ORDER]),
                "rule": np.array([WANTED_SHARE, TOLERANCE, PACKING_ERROR]),
                "filled": filled,
                "largest_force": self.largest_force[filled],
                "bound": self.bound[filled],
                "is_polished": self.is_polished[filled],
                "steps": self._steps[filled],
                "lengths": np.array([len(part) for part in parts], dtype=np.int64),
                "packed": np.frombuffer(b"".join(parts), dtype=np.uint8),
                "members": np.concatenate(self.codec.members),
                "bases": np.concatenate([basis.ravel() for basis in self.codec.bases]),
                "sizes": np.array([len(nodes) for nodes in self.codec.members]),
            }
        write_table(path, KIND, self.body.key, arrays)

    @classmethod
    def load(cls, body: SoftBody, path: Path) -> SeriesTable:
        """The table that :meth:`save` wrote for this very body.

        Raises
        ------
        TableFileError
            Missing, damaged, or of another body or version.
        """
        stored = read_table(path, KIND, body.key)
        try:
            return cls._of_arrays(body, stored)
        except (KeyError, ValueError, IndexError) as problem:
            raise TableFileError(
                "{path}: its parts contradict each other ({problem}); its table is computed anew",
                path=path,
                problem=repr(problem),
            ) from problem

    @classmethod
    def _of_arrays(cls, body: SoftBody, stored: dict[str, NDArray[Any]]) -> SeriesTable:
        rule = [ORDER, WANTED_SHARE, TOLERANCE, PACKING_ERROR]
        if [*stored["order"], *stored["rule"]] != rule:
            raise ValueError("made by another rule")
        sizes, count = stored["sizes"], 3 * body.compliance.node_count
        members = np.split(stored["members"], np.cumsum(sizes)[:-1])
        squares = np.split(stored["bases"], np.cumsum(9 * sizes**2)[:-1])
        bases = [
            flat.reshape(3 * size, 3 * size) for flat, size in zip(squares, sizes, strict=True)
        ]
        table = cls(
            body,
            ColumnCodec(tuple(members), tuple(bases)),
            np.zeros(count, dtype=bool),
            np.zeros(count),
            np.zeros(count),
            np.zeros(count, dtype=bool),
            np.zeros((count, 2)),
            {},
        )
        filled, ends = stored["filled"], np.cumsum(stored["lengths"])
        whole = stored["packed"].tobytes()
        starts = ends - stored["lengths"]
        parts = [whole[start:end] for start, end in zip(starts, ends, strict=True)]
        for at, freedom in enumerate(filled.tolist()):
            table._packed[freedom] = parts[2 * at], parts[2 * at + 1]
        table.largest_force[filled] = stored["largest_force"]
        table.bound[filled] = stored["bound"]
        table.is_polished[filled] = stored["is_polished"]
        table._steps[filled] = stored["steps"]
        table.is_filled[filled] = True
        return table
