"""Report of `palpate servo`: forces, depths and timing."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ...core.servo.latency_timer import explain
from ..body.figure_lines import as_lines

if TYPE_CHECKING:
    from ...core.servo.session import FingerCounters, ServoCounters, Snapshot


@dataclass
class Felt:
    """Extremes of the first finger in all ticks so far, SI units."""

    samples: int = 0
    touching: int = 0
    contact_force: float = 0.0
    output_force: float = 0.0
    depth: float = 0.0

    def take(self, samples: NDArray[np.void]) -> None:
        """Add the samples of more ticks."""
        samples = samples[samples["finger"] == 0]
        if not len(samples):
            return
        contact, output, depth = (
            np.linalg.norm(vectors, axis=1)
            for vectors in (
                samples["force"],
                samples["output"],
                samples["probe"] - samples["proxy"],
            )
        )
        self.samples += len(samples)
        self.touching += int(np.count_nonzero(contact))
        self.contact_force = max(self.contact_force, float(contact.max()))
        self.output_force = max(self.output_force, float(output.max()))
        self.depth = max(self.depth, float(depth[contact > 0.0].max(initial=0.0)))


def for_people(report: dict[str, Any]) -> str:
    """Report with one figure a line, and the stages of the tick as a table."""
    lines = as_lines({name: value for name, value in report.items() if name != "stages_us"})
    columns = ("mean", "p99", "max")
    rows = [f"{'tick, us':10}" + "".join(f"{column:>9}" for column in columns)]
    for stage, times in report["stages_us"].items():
        rows.append(f"{stage:10}" + "".join(f"{times[column]:9.2f}" for column in columns))
    return "\n".join([lines, *rows])


def _of_others(last: Snapshot, counters: Sequence[FingerCounters]) -> dict[str, Any]:
    """State, faults and link of all fingers but the first; nothing if there are none."""
    others = [
        {"last_state": finger.state, "last_fault": finger.fault, **counted}
        for finger, counted in zip(last.fingers[1:], counters[1:], strict=False)
    ]
    return {"other_fingers": others} if others else {}


def servo_report(felt: Felt, last: Snapshot, counters: ServoCounters, port: str) -> dict[str, Any]:
    """Figures by name, from the last snapshot and the final counters."""
    return {
        **{name: counters[name] for name in ("rate_hz", "ticks", "missed", "late_ticks")},
        "lateness_us": counters["lateness_us"],
        **{
            name: counters[name]
            for name in (
                *("late_over_10_us", "late_over_50_us", "late_over_200_us", "late_over_1000_us"),
                *("longest_gap_us", "stages_us", "busy_us", "spun_us"),
            )
        },
        "realtime": counters["realtime"],
        "link": counters["link"],
        "warning": explain(counters["link"], port) or "",
        "faults": counters["faults"],
        "samples_lost": counters["samples_lost"],
        "last_state": last.state,
        "last_fault": last.fault,
        "touching_ticks": felt.touching,
        **_of_others(last, counters["fingers"]),
        "peak_contact_force_n": felt.contact_force,
        "peak_output_force_n": felt.output_force,
        "deepest_mm": felt.depth * 1e3,
    }
