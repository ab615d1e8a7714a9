"""Form of a compliance that fits the memory."""

from __future__ import annotations

from ...compliance.dense import BYTES_PER_PAIR
from ...compliance.elimination.plan import EliminationPlan
from ...errors import PalpateError
from ...sentence import Sentence
from ..settings import BakeSettings
from .bake_cost import BakeCost, planned_cost

# Dense tables of more bytes are compressed when the form is ``auto``.
LARGEST_AUTOMATIC_TABLE = 300_000_000


def automatic_form(form: str, dense: BakeCost, available: int | None) -> str:
    """Form for ``auto``: ``dense`` unless its table is large or does not fit."""
    if form != "auto":
        return form
    too_large = BYTES_PER_PAIR * dense.free_surface_nodes**2 > LARGEST_AUTOMATIC_TABLE
    does_not_fit = available is not None and dense.peak_bytes > available
    return "compressed" if too_large or does_not_fit else "dense"


def affordable_form(
    plan: EliminationPlan, settings: BakeSettings, available: int
) -> tuple[str, list[Sentence]]:
    """Form to compute, and warnings for the user about its choice.

    Raises
    ------
    PalpateError
        The memory does not suffice; with the remedy.
    """
    dense = planned_cost(plan, "dense", settings.threads)
    compressed = planned_cost(plan, "compressed", settings.threads)
    chosen = automatic_form(settings.form, dense, available)
    cost = dense if chosen == "dense" else compressed
    refusal = memory_refusal(cost, available, compressed)
    if refusal is not None:
        raise PalpateError(refusal)
    warnings = []
    if settings.form == "auto" and chosen == "compressed" and dense.peak_bytes > available:
        warnings.append(
            Sentence(
                "the compliance was compressed, since whole it would have taken {needed} of "
                "memory, and {available} could be had",
                needed=_memory(dense.peak_bytes),
                available=_memory(available),
            )
        )
    return chosen, warnings


def memory_refusal(
    cost: BakeCost, available: int, compressed: BakeCost | None = None
) -> Sentence | None:
    """Reason with remedy why memory forbids a bake; None where it suffices.

    ``compressed`` is the cost of the compressed form, which is offered only where it would fit.
    """
    if cost.peak_bytes <= available:
        return None
    would_fit = compressed is None or compressed.peak_bytes <= available
    remedy = Sentence("use a larger edge length")
    if cost.form == "dense" and would_fit:
        remedy = Sentence("choose the compressed form or use a larger edge length")
    return Sentence(
        "bake: {count:,} free surface nodes take {needed} of memory, and {available} can be had; "
        "{remedy}",
        count=cost.free_surface_nodes,
        needed=_memory(cost.peak_bytes),
        available=_memory(available),
        remedy=remedy,
    )


def _memory(count: int) -> str:
    return f"{count / 1e9:.1f} GB" if count >= 1e9 else f"{max(1, round(count / 1e6))} MB"
