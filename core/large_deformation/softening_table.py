"""The softenings of a body's surface, computed around the touched place while it is touched.

One thread in the background takes the unknown nodes nearest to the place asked for last, a few at
a time, tells whoever listens, and ends when all are known. What it made is kept beside the body
file. A node that is not known yet has softening zero: there the corrected relation is the linear
one.
"""

from __future__ import annotations

import threading
import time
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..contact_points import node_normals
from ..errors import PalpateError
from ..progress import Progress, unwatched
from ..soft_body import SoftBody
from .free_solid import FreeSolid
from .softening import NODES_AT_ONCE, node_softening
from .softening_file import load_softening, save_softening, softening_path

# Between two steps in the background the other threads have this time for themselves, seconds.
PAUSE_SECONDS = 0.004

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

    ``notice`` says, if a file was found that could not be used, which and why; empty otherwise.
    """

    def __init__(self, body: SoftBody, body_file: Path | None = None) -> None:
        """Softenings of ``body``; kept beside ``body_file``, or nowhere where that is None."""
        self.body = body
        self.notice = ""
        self._path = None if body_file is None else softening_path(body_file)
        surface = body.mesh.surface_nodes
        self._inward = -node_normals(body.mesh)
        self._values = np.zeros((len(surface), 4))
        self._known = ~np.isin(surface, body.compliance.free_surface)
        self._wanted = np.zeros(0, dtype=np.int64)
        self._listeners: list[Listener] = []
        self._solid: FreeSolid | None = None
        self._thread: threading.Thread | None = None
        self._failure: PalpateError | None = None
        self._changed = self._closing = False
        # Held for a moment at a time; the other one as long as a step takes.
        self._lock, self._working = threading.RLock(), threading.Lock()
        self._load()

    @property
    def values(self) -> NDArray[np.float64]:
        """Of every node of ``mesh.surface_nodes`` b and w, (s, 4); zero where unknown. A copy."""
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

    def unlisten(self, listener: Listener) -> None:
        """Do not tell this one any longer."""
        with self._lock:
            self._listeners.remove(listener)

    def around(self, nodes: ArrayLike) -> None:
        """Ask for ``nodes`` (k,) of the mesh, then for their neighbourhood; returns at once.

        Raises
        ------
        PalpateError
            The thread in the background failed; told once.
        """
        with self._lock:
            failure, self._failure = self._failure, None
            if failure is not None:
                raise failure
            self._wanted = self._local(nodes)
            if self._thread is None and not self._closing and not self._known.all():
                self._thread = threading.Thread(
                    target=_fill_in_background, args=(weakref.ref(self),), daemon=True
                )
                self._thread.start()

    def wait_for(self, nodes: ArrayLike) -> None:
        """Return when ``nodes`` (k,) of the mesh are known.

        Raises
        ------
        PalpateError
            They cannot be computed.
        """
        local = self._local(nodes)
        with self._working:
            self._compute(local[~self._known[local]])

    def fill(self, progress: Progress = unwatched) -> None:
        """Compute all that is missing, and keep it.

        ``progress`` is called with the share done, 0 to 1; it may raise to cancel, and what was
        found until then is kept in memory.
        """
        missing = np.flatnonzero(~self._known)
        for first in range(0, len(missing), NODES_AT_ONCE):
            progress(first / len(missing))
            with self._working:
                few = missing[first : first + NODES_AT_ONCE]
                self._compute(few[~self._known[few]])
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
            values, known, self._changed = self._values.copy(), self._known.copy(), False
        save_softening(self._path, self.body.key, values, known)

    def close(self) -> None:
        """End what works in the background and keep what it made; safe to call twice.

        Raises
        ------
        UnwritableError
            The place cannot be written.
        """
        with self._lock:
            self._closing, thread = True, self._thread
        if thread is not None:
            thread.join()
        self.keep()

    def step(self) -> bool:
        """Compute the few unknown nodes nearest to the place asked for; False if none is left."""
        with self._working:
            with self._lock:
                few = self._nearest_unknown()
                if self._closing or not len(few):
                    return False
            self._compute(few)
            return True

    def failed(self, problem: PalpateError | None) -> None:
        """The thread in the background ends: by a failure, or because nothing is left."""
        with self._lock:
            self._failure, self._thread = problem, None

    def _compute(self, local: NDArray[np.int64]) -> None:
        if not len(local):
            return
        if self._solid is None:
            self._solid = FreeSolid.of(self.body)
        places = np.searchsorted(self._solid.free, self.body.mesh.surface_nodes[local])
        found = node_softening(self._solid, places, self._inward[local])
        with self._lock:
            self._values[local], self._known[local], self._changed = found, True, True
            for listener in self._listeners:
                listener(local, found)

    def _nearest_unknown(self) -> NDArray[np.int64]:
        unknown = np.flatnonzero(~self._known)
        if len(self._wanted) == 0:
            return unknown[:NODES_AT_ONCE]
        positions = self.body.mesh.nodes[self.body.mesh.surface_nodes]
        away = positions[unknown] - positions[self._wanted].mean(axis=0)
        distance = np.linalg.norm(away, axis=1)
        distance[np.isin(unknown, self._wanted)] = -1.0
        nearest: NDArray[np.int64] = unknown[np.argsort(distance, kind="stable")[:NODES_AT_ONCE]]
        return nearest

    def _local(self, nodes: ArrayLike) -> NDArray[np.int64]:
        """Places in ``mesh.surface_nodes``, each once."""
        return np.searchsorted(self.body.mesh.surface_nodes, np.unique(np.asarray(nodes)))

    def _load(self) -> None:
        if self._path is None or not self._path.exists():
            return
        try:
            self._values, self._known = load_softening(self._path, self.body.key, len(self._values))
        except PalpateError as problem:
            self.notice = str(problem)


def _fill_in_background(table: weakref.ref[SofteningTable]) -> None:
    """Steps until nothing is left, or nobody has the table any longer."""
    problem: PalpateError | None = None
    try:
        while (one := table()) is not None and one.step():
            del one
            time.sleep(PAUSE_SECONDS)
        if (one := table()) is not None:
            one.keep()
    except PalpateError as failure:
        problem = failure
    except Exception as failure:  # noqa: BLE001 - told to whoever asks next instead of by a thread's traceback
        problem = PalpateError(
            f"felt force: the softenings cannot be computed ({failure!r}); choose the linear one"
        )
    if (one := table()) is not None:
        one.failed(problem)
