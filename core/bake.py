"""The bake, step by step: surface -> tetrahedra -> stiffness -> compliance -> body."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass

import numpy as np
from numpy.typing import NDArray

from .bake_settings import BakeSettings
from .decimate import decimate
from .formulation import formulation_for
from .pins import pinned_nodes
from .progress import unwatched
from .regional_stiffness import StiffRegion, TetScale, young_scale
from .soft_body import SoftBody
from .stiffness import assemble
from .surface import Surface
from .surface_compliance import surface_compliance
from .tet_mesh import TetMesh
from .tetrahedralize import Fit, check_fit, tetrahedralize

__all__ = ["BakeProgress", "BakeReport", "BakeSettings", "bake"]

# (step, share of the whole bake done or None where nobody can know)
BakeProgress = Callable[[str, float | None], None]

# Beyond these the drawn shape and the body visibly part ways, and the maker should know.
NOTABLE_DISTANCE = 0.02
NOTABLE_VOLUME_ERROR = 0.1


@dataclass(frozen=True)
class BakeReport:
    """What a bake did: seconds of each step, the fit to the input, and what to tell the maker."""

    seconds: dict[str, float]
    fit: Fit | None
    warnings: list[str]

    def as_dict(self) -> dict[str, object]:
        """The report as plain values for JSON."""
        return asdict(self)


def bake(
    source: Surface | TetMesh,
    settings: BakeSettings,
    progress: BakeProgress = unwatched,
    surface: Surface | None = None,
) -> tuple[SoftBody, BakeReport]:
    """Make a body, in this process.

    Tetrahedralization cannot be interrupted here; programs with a person in front use
    :class:`palpate.core.bake_job.BakeJob`, which runs this function in a child process.

    Parameters
    ----------
    source : a surface, or tetrahedra that exist already.
    settings : see :class:`BakeSettings`.
    progress : told the step and the share of the whole that is done.
    surface : for tetrahedra with painted pins, the surface the weights were painted on.

    Raises
    ------
    PalpateError
        Anything that keeps the mesh from becoming a body, with the remedy.
    """
    settings.checked()
    seconds: dict[str, float] = {}
    fit: Fit | None = None
    if isinstance(source, Surface):
        with _timed(seconds, "tetrahedralize"):
            progress("tetrahedralize", None)
            welded = source.welded()
            shell = decimate(welded, settings.decimate_above)
            mesh = tetrahedralize(shell, settings.edge_length, settings.epsilon)
        with _timed(seconds, "check"):
            progress("check", 0.5)
            fit = check_fit(mesh, welded, shell)
        surface = source
    else:
        mesh = source
    fixed = pinned_nodes(settings.pins, mesh, surface)
    formulation = formulation_for(settings.formulation, settings.poisson_ratio)
    scale = _young_scale(settings.stiffness, mesh, surface)
    with _timed(seconds, "stiffness"):
        progress("stiffness", 0.55)
        stiffness = assemble(
            mesh, settings.poisson_ratio, formulation=formulation, young_scale=scale
        )
    with _timed(seconds, "compliance"):
        compliance = surface_compliance(
            mesh, stiffness, fixed, lambda share: progress("compliance", 0.6 + 0.4 * share)
        )
    body = SoftBody(
        mesh,
        np.unique(fixed),
        settings.poisson_ratio,
        compliance,
        settings.young_modulus,
        formulation,
        scale,
    )
    diagonal = float(np.linalg.norm(np.ptp(mesh.nodes, axis=0)))
    return body, BakeReport(seconds, fit, _warnings(fit, diagonal))


def _young_scale(
    stiffness: StiffRegion | TetScale | None, mesh: TetMesh, surface: Surface | None
) -> NDArray[np.float64] | None:
    """Factors on Young's modulus (M,), None where none differs from 1: the key is the same then."""
    if stiffness is None:
        return None
    scale = young_scale(stiffness, mesh, surface)
    return None if np.array_equal(scale, np.ones_like(scale)) else scale


def _warnings(fit: Fit | None, diagonal: float) -> list[str]:
    if fit is None:
        return []
    found = []
    if abs(fit.volume_ratio - 1) > NOTABLE_VOLUME_ERROR:
        found.append(
            f"the body has {100 * fit.volume_ratio:.0f} % of the volume that the mesh encloses; "
            "a smaller edge length or epsilon follows it more closely"
        )
    if fit.input_to_body > NOTABLE_DISTANCE * diagonal:
        found.append(
            f"parts of the mesh lie up to {1000 * fit.input_to_body:.2g} mm from the body, being "
            "open or too thin; they follow its nearest place"
        )
    return found


@contextmanager
def _timed(seconds: dict[str, float], step: str) -> Iterator[None]:
    start = time.perf_counter()
    yield
    seconds[step] = time.perf_counter() - start
