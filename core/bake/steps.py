"""Steps of the bake: surface -> tetrahedra -> stiffness -> compliance -> body."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import asdict, dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..body.soft_body import SoftBody
from ..compliance.compression.compress import compress
from ..compliance.elimination.plan import EliminationPlan, plan_surface_inverse
from ..compliance.elimination.surface_columns import planned_columns
from ..compliance.free_body.density import DEFAULT_DENSITY
from ..compliance.protocol import Compliance
from ..compliance.surface_compliance import planned_compliance
from ..errors import CancelledError, PalpateError
from ..machine.available_memory import available_memory
from ..machine.blas_threads import blas_threads
from ..machine.machine_speed import dgemm_rate
from ..mesh.decimate import decimate
from ..mesh.fit import Fit, fit_warnings, measured_fit, refuse_misfit, size_warnings
from ..mesh.surface import Surface
from ..mesh.tet_mesh import TetMesh
from ..mesh.tetrahedralize import tetrahedralize
from ..progress import unwatched
from ..sentence import Sentence
from ..stiffness.assembly import assemble
from ..stiffness.held_pins import free_or_pinned, pins_checked
from ..stiffness.pins import NoPins, pinned_nodes
from ..stiffness.regions import StiffRegion, TetScale, young_scale
from .cost.memory import affordable_form
from .cost.prediction import (
    check_seconds,
    predicted_mesh,
    rest_seconds,
    tetrahedralize_seconds,
)
from .cost.size import MeshSize, ShapeSize
from .settings import BakeSettings
from .work import BakeProgress, BakeWork, Foresight

__all__ = ["BakeProgress", "BakeReport", "BakeSettings", "bake"]

# Below this arithmetic (operations, a second of one thread) one thread is used: several would wait
# for each other on a busy machine.
LEAST_WEIGHT_FOR_THREADS = 2e10


@dataclass(frozen=True)
class BakeReport:
    """Report of a bake: seconds of each step, fit to the input, warnings."""

    seconds: dict[str, float]
    fit: Fit | None
    warnings: list[Sentence]

    def as_dict(self) -> dict[str, object]:
        """Plain values for JSON."""
        return asdict(self)


def bake(
    source: Surface | TetMesh,
    settings: BakeSettings,
    progress: BakeProgress = unwatched,
    surface: Surface | None = None,
    available: Callable[[], int] = available_memory,
    foresee: Foresight = unwatched,
) -> tuple[SoftBody, BakeReport]:
    """Make a body, in this process.

    >>> from palpate.core.mesh.paper_cube import paper_cube
    >>> from palpate.core.stiffness.pins import PinBelow
    >>> mesh, _ = paper_cube()
    >>> body, report = bake(mesh, BakeSettings(poisson_ratio=0.45, pins=PinBelow(0.0)))
    >>> len(body.fixed), body.compliance.form, list(report.seconds)
    (25, 'dense', ['stiffness', 'plan', 'compliance'])

    Tetrahedralization and the assembly of the stiffness (seconds for tens of thousands of nodes,
    smoothed) cannot be interrupted here; interactive programs use
    :class:`palpate.core.bake.job.BakeJob`, which runs this function in a child process.

    Parameters
    ----------
    source : a surface, or existing tetrahedra.
    settings : see :class:`BakeSettings`.
    progress : called with the step and the share of the bake done; may raise to cancel.
    surface : for tetrahedra with painted pins, the painted surface.
    available : bytes of available memory, called before the compliance is computed.
    foresee : called before tetrahedralization, which reports nothing itself: its step, the share
        of the bake that is done at its end, and its expected seconds.

    Raises
    ------
    PalpateError
        Anything that keeps the mesh from becoming a body, with the remedy.
    """
    settings.checked()
    report = BakeReport({}, None, [])
    work = BakeWork(progress)
    shell: Surface | None = None
    if isinstance(source, Surface):
        surface = source
        shell, mesh = _tetrahedra(source, settings, work, report.seconds, foresee)
    else:
        mesh = source
        if surface is not None:
            shell = decimate(surface.welded(), settings.decimate_above)
        work.expect(rest_seconds(MeshSize.of(mesh), settings))
    fit = None
    if surface is not None and shell is not None:
        work.expect({"check": check_seconds(surface, mesh)})
        with _timed(report.seconds, "check"):
            work.begin("check")
            fit = measured_fit(mesh, surface, shell)
        if isinstance(source, Surface):
            refuse_misfit(fit, mesh, shell, settings.epsilon)
    misfit = (
        [] if fit is None or shell is None else fit_warnings(fit, mesh, shell, settings.epsilon)
    )
    with _explained(misfit):
        # Only who asks for no pins gets a free body; a rule that finds none is refused.
        is_free = isinstance(settings.pins, NoPins)
        held = free_or_pinned if is_free else pins_checked
        fixed = held(mesh, pinned_nodes(settings.pins, mesh, surface))
    scale = _young_scale(settings.stiffness, mesh, surface)
    with _timed(report.seconds, "stiffness"):
        work.begin("stiffness")
        stiffness = assemble(
            mesh, settings.poisson_ratio, formulation=settings.formulation, young_scale=scale
        )
    with _timed(report.seconds, "plan"):
        plan = plan_surface_inverse(mesh, stiffness, fixed, progress=work.begin("plan"))
        # The plan has its own copy, and this one is a tenth of what a bake holds.
        del stiffness
        form, warnings = affordable_form(plan, settings, available())
    with _timed(report.seconds, "compliance"), _explained(misfit):
        compliance = _compliance(plan, form, mesh, settings, work)
    body = SoftBody(
        mesh,
        fixed,
        settings.poisson_ratio,
        compliance,
        settings.young_modulus,
        settings.formulation,
        scale,
        fit,
        density=settings.density or (DEFAULT_DENSITY if is_free else None),
        law=settings.law,
    )
    told = [*size_warnings(mesh), *misfit, *warnings]
    return body, replace(report, fit=fit, warnings=told)


def _tetrahedra(
    source: Surface,
    settings: BakeSettings,
    work: BakeWork,
    seconds: dict[str, float],
    foresee: Foresight,
) -> tuple[Surface, TetMesh]:
    """The surface as handed to fTetWild, and its tetrahedra."""
    with _timed(seconds, "tetrahedralize"):
        work.unknown("tetrahedralize")
        shell = decimate(source.welded(), settings.decimate_above)
        size = ShapeSize.of(shell)
        expected = predicted_mesh(size, settings)
        alone = tetrahedralize_seconds(size, settings, expected.nodes)
        work.expect({"tetrahedralize": alone, **rest_seconds(expected, settings)})
        foresee("tetrahedralize", work.until_end_of("tetrahedralize"), alone)
        mesh = tetrahedralize(shell, settings.edge_length, settings.epsilon)
    work.forget("tetrahedralize")
    work.expect(rest_seconds(MeshSize.of(mesh), settings), spent=seconds["tetrahedralize"])
    return shell, mesh


@contextmanager
def _explained(misfit: list[Sentence]) -> Iterator[None]:
    """Say in errors what is known to be wrong with the body's shape."""
    try:
        yield
    except CancelledError:
        raise
    except PalpateError as problem:
        if not misfit:
            raise
        raise PalpateError(
            "{problem}; a likely reason: {warning}", problem=problem, warning=misfit[-1]
        ) from problem


def _compliance(
    plan: EliminationPlan, form: str, mesh: TetMesh, settings: BakeSettings, work: BakeWork
) -> Compliance:
    """Compliance by the plan: most of a bake's time."""
    threads = settings.threads if plan.weight >= LEAST_WEIGHT_FOR_THREADS else 1
    with blas_threads(threads) as threads:
        if form == "dense":
            work.forget("compress")
            work.expect({"compliance": plan.weight / dgemm_rate(threads)})
            return planned_compliance(plan, work.begin("compliance"))
        plan = replace(plan, table_itemsize=0)
        work.expect({"compliance": plan.weight / dgemm_rate(threads)})
        source = planned_columns(plan, work.begin("compliance"))
        positions = mesh.nodes[plan.free_surface]
        return compress(source, positions, settings.tolerance, work.begin("compress"))


def _young_scale(
    stiffness: StiffRegion | TetScale | None, mesh: TetMesh, surface: Surface | None
) -> NDArray[np.float64] | None:
    """Factors on Young's modulus (M,); None if all are 1, for the same key."""
    if stiffness is None:
        return None
    scale = young_scale(stiffness, mesh, surface)
    return None if np.array_equal(scale, np.ones_like(scale)) else scale


@contextmanager
def _timed(seconds: dict[str, float], step: str) -> Iterator[None]:
    start = time.perf_counter()
    yield
    seconds[step] = time.perf_counter() - start
