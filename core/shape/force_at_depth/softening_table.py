"""The softenings of a body's surface, computed around the touched place while it is touched.

A thread in the background takes the nodes asked for, then those nearest to them, a few at a time,
and tells whoever listens. What it made is kept beside the body file. A node that is not known yet
has softening zero: there the corrected relation is the linear one.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...body.soft_body import SoftBody
from ...contact.near_field.surface_shape import node_normals
from ...errors import PalpateError
from ...progress import Progress, unwatched
from ..paper.outward_filling import OutwardFilling
from ..paper.table_file import (
    Layout,
    TableFileError,
    read_table,
    refuse,
    table_path,
    write_table,
)
from ..solid.free_solid import FreeSolid
from .softening import NODES_AT_ONCE, node_softening

# Counts changes of how softenings are computed: tables of an older kind are computed anew.
KIND = "softening-2"

# Measured: a node costs three columns, one more solve and one evaluation of the solid, each in
# proportion to the tets; the factor in the background more than that on large bodies.
SECONDS_PER_NODE_AND_TET = 8e-7
FACTOR_SECONDS_PER_NODE = 1.5e-4

# Told of nodes (k,) as counted in ``mesh.surface_nodes``, and their softenings (k, 4).
Listener: TypeAlias = Callable[[NDArray[np.int64], NDArray[np.float64]], None]


def whole_table_seconds(nodes: int, tets: int, surface_nodes: int) -> float:
    """About how long all softenings of a body take; right within a factor of two."""
    return SECONDS_PER_NODE_AND_TET * surface_nodes * tets + FACTOR_SECONDS_PER_NODE * nodes


class SofteningTable:
    """Softenings by node, as far as they are known. Safe to use from several threads.

    ``notice`` says which file could not be used and why; empty otherwise.
    """

    def __init__(self, body: SoftBody, body_file: Path | None = None) -> None:
        """Softenings of ``body``; kept beside ``body_file``, or nowhere where that is None."""
        self.body = body
        self.notice = ""
        self._path = None if body_file is None else table_path(body_file, "softening")
        surface = body.mesh.surface_nodes
        self._inward = -node_normals(body.mesh)
        self._values = np.zeros((len(surface), 4))
        self._known = ~np.isin(surface, body.compliance.free_surface)
        self._wanted = np.zeros(0, dtype=np.int64)
        self._listeners: list[Listener] = []
        self._solid: FreeSolid | None = None
        self._changed = False
        self._lock = threading.RLock()
        self._load()
        self._filling = OutwardFilling(
            body.mesh.nodes[surface], self._known, self._compute, NODES_AT_ONCE
        )

    @property
    def values(self) -> NDArray[np.float64]:
        """Softenings b and w of ``mesh.surface_nodes``, (s, 4), a copy; zero where unknown."""
        with self._lock:
            return self._values.copy()

    @property
    def share_known(self) -> float:
        """Share (0 to 1) of the whole surface that is known."""
        with self._lock:
            return float(self._known.mean())

    @property
    def ready(self) -> float:
        """Share (0 to 1) of the nodes asked for last that is known."""
        with self._lock:
            return float(self._known[self._wanted].mean()) if len(self._wanted) else 1.0

    def listen(self, listener: Listener) -> None:
        """Tell ``listener`` of all that is known, now and from whatever thread finds more."""
        with self._lock:
            known = np.flatnonzero(self._known)
            self._listeners.append(listener)
            listener(known, self._values[known])

    def around(self, nodes: ArrayLike) -> None:
        """Ask for ``nodes`` (k,) of the mesh, then for their neighbourhood; returns at once.

        Raises
        ------
        PalpateError
            The thread in the background has failed.
        """
        with self._lock:
            self._wanted = self._local(nodes)
        self._refuse_failure()
        if self.share_known < 1.0:
            self._filling.around(self._wanted)

    def wait_for(self, nodes: ArrayLike) -> None:
        """Return when ``nodes`` (k,) of the mesh are known.

        Raises
        ------
        PalpateError
            They cannot be computed.
        """
        self._wait_for(self._local(nodes))

    def fill(self, progress: Progress = unwatched) -> None:
        """Compute all that is missing, and keep it.

        ``progress`` is called with the share of the surface that is known, 0 to 1; it may raise to
        cancel, and what was found until then stays.

        Raises
        ------
        PalpateError
            They cannot be computed, or the place beside the body file cannot be written.
        """
        while len(missing := np.flatnonzero(~self._known)):
            progress(self.share_known)
            self._wait_for(missing[:NODES_AT_ONCE])
        progress(1.0)
        self.keep()

    def keep(self) -> None:
        """Write what is known beside the body file, if it has one and there is something new.

        Raises
        ------
        UnwritableError
            The place cannot be written.
        """
        with self._lock:
            if self._path is None or not self._changed:
                return
            self._load()
            arrays = {"softening": self._values.copy(), "known": self._known.copy()}
            self._changed = False
        write_table(self._path, KIND, self.body.key, arrays)

    def close(self) -> None:
        """End what works in the background and keep what it made; safe to call twice.

        Raises
        ------
        UnwritableError
            The place cannot be written.
        """
        self._filling.close()
        self.keep()

    def _wait_for(self, local: NDArray[np.int64]) -> None:
        if self._known[local].all():
            return
        try:
            self._filling.wait_for(local)
        except Exception:
            self._refuse_failure()
            raise

    def _refuse_failure(self) -> None:
        problem = self._filling.problem
        if isinstance(problem, PalpateError):
            raise problem
        if problem is not None:
            raise PalpateError(
                "felt force: softenings cannot be computed ({problem}); choose the linear one",
                problem=repr(problem),
            ) from problem

    def _compute(self, local: NDArray[np.int64]) -> None:
        if self._solid is None:
            self._solid = FreeSolid.of(self.body)
        places = np.searchsorted(self._solid.free, self.body.mesh.surface_nodes[local])
        found = node_softening(self._solid, places, self._inward[local])
        with self._lock:
            self._values[local], self._known[local], self._changed = found, True, True
            for listener in self._listeners:
                listener(local, found)

    def _local(self, nodes: ArrayLike) -> NDArray[np.int64]:
        """Places in ``mesh.surface_nodes``, each once."""
        return np.searchsorted(self.body.mesh.surface_nodes, np.unique(np.asarray(nodes)))

    def _read(self, path: Path) -> dict[str, NDArray[Any]]:
        count = len(self._known)
        layout: Layout = {"softening": (np.float64, (count, 4)), "known": (np.bool_, (count,))}
        arrays = read_table(path, KIND, self.body.key, layout)
        softening = arrays["softening"]
        bent = softening[:, :3].any(axis=1)
        if (softening[:, 3] < 0.0).any() or (softening[bent, 3] == 0.0).any():
            refuse(path, "softening")
        return arrays

    def _load(self) -> None:
        """Take over what the file knows and this table does not."""
        if self._path is None or not self._path.exists():
            return
        try:
            arrays = self._read(self._path)
        except TableFileError as problem:
            self.notice = problem.sentence
            return
        new = arrays["known"] & ~self._known
        self._values[new], self._known[new] = arrays["softening"][new], True
        for listener in self._listeners:
            listener(np.flatnonzero(new), self._values[new])
