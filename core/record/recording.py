"""Recordings of the servo as files: every tick in CSV or npz, written atomically; read by
:mod:`.read_recording`.

`docs/recording.md` describes both formats.
"""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import IO

import numpy as np
import palpate_servo
from numpy.typing import NDArray

from ..errors import PalpateError
from ..files.atomic_file import atomic_file, refuse_missing_folder, refuse_unwritable
from ..files.npz_archive import write_arrays

FORMAT = "palpate recording 1"
SUFFIXES = (".csv", ".npz")
UNITS = {
    "tick": "1",
    "time": "s",
    "probe": "m",
    "proxy": "m",
    "surface": "m",
    "force": "N",
    "output": "N",
    "state": "index into states",
    "finger": "1",
}
VECTORS = ("probe", "proxy", "surface", "force", "output")
DTYPE = np.dtype(
    [
        ("tick", "=u8"),
        ("time", "=f8"),
        *((name, "=f8", (3,)) for name in VECTORS),
        ("state", "=u4"),
        ("finger", "=u4"),
    ]
)
"""Type of `palpate_servo.Servo.samples()` and `recording()`."""
CSV_HEADER = ",".join(
    [
        "tick",
        "time_s",
        *(f"{name}_{axis}_{UNITS[name]}" for name in VECTORS for axis in "xyz"),
        "state",
    ]
)
FINGER_COLUMN = ",finger"
"""Last column of a recording of more than one finger."""
CSV_GROWTH = 3.0
"""Largest ratio of a CSV line's bytes to those of its tick in memory."""
_ROWS_AT_ONCE = 10_000


class RecordingError(PalpateError):
    """Recording that cannot be written or read."""


def check_recording_path(path: Path) -> None:
    """Check that a recording could be written to ``path``, before it is made.

    Raises
    ------
    RecordingError
        The suffix is neither ``.csv`` nor ``.npz``.
    UnwritableError
        The path is a folder or a device, or its folder is missing or not writable.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise RecordingError(
            "{path}: a recording is written as CSV or npz; let the name end in {suffixes}",
            path=path,
            suffixes=" or ".join(SUFFIXES),
        )
    refuse_missing_folder(path)
    refuse_unwritable(path)


def check_room(path: Path, memory_bytes: int) -> None:
    """Check that a recording of this size in memory will fit on the disk of its path.

    Raises
    ------
    RecordingError
        The disk has less room.
    """
    growth = CSV_GROWTH if path.suffix.lower() == ".csv" else 1.0
    needed, free = growth * memory_bytes, shutil.disk_usage(path.parent).free
    if free < needed:
        raise RecordingError(
            "{path}: the recording may take {needed:.1f} MB, and {folder} has room for {free:.1f} "
            "MB; record for a shorter time, or choose a folder with more room",
            path=path,
            needed=needed / 1e6,
            folder=path.parent,
            free=free / 1e6,
        )


def write_recording(
    path: Path, samples: NDArray[np.void], states: Sequence[str], rate_hz: int
) -> None:
    """Write ``samples`` in the format of ``path``'s suffix; replaces an older file atomically.

    Parameters
    ----------
    samples : structured array (n,), from `Servo.recording()` or `Servo.samples()`. SI units.
    states : `palpate_servo.STATES`.

    Raises
    ------
    RecordingError, UnwritableError
        As for :func:`check_recording_path`, and when writing fails, as on a full disk; an older
        file stays as it was.
    ValueError
        Samples of another type, or of a state that has no name.
    """
    check_recording_path(path)
    if samples.dtype != DTYPE:
        raise ValueError(f"samples are of type {samples.dtype}, not {DTYPE}")
    if len(samples) and samples["state"].max() >= len(states):
        raise ValueError(f"state {samples['state'].max()} is none of {tuple(states)}")
    with atomic_file(path) as file:
        if path.suffix.lower() == ".csv":
            _write_csv(file, samples, states)
        else:
            _write_npz(file, samples, states, rate_hz)


def _write_csv(file: IO[bytes], samples: NDArray[np.void], states: Sequence[str]) -> None:
    fingers = samples["finger"]
    is_alone = not fingers.any()
    file.write((CSV_HEADER + ("" if is_alone else FINGER_COLUMN)).encode() + b"\n")
    for start in range(0, len(samples), _ROWS_AT_ONCE):
        rows = samples[start : start + _ROWS_AT_ONCE]
        numbers = np.column_stack([rows["time"], *(rows[name] for name in VECTORS)]).tolist()
        # A list's text has the shortest digits that read back as the same number.
        ends = [""] * len(rows) if is_alone else [f",{n}" for n in rows["finger"].tolist()]
        file.writelines(
            f"{tick},{str(row)[1:-1].replace(' ', '')},{states[state]}{end}\n".encode()
            for tick, row, state, end in zip(
                rows["tick"].tolist(), numbers, rows["state"].tolist(), ends, strict=True
            )
        )


def _write_npz(
    file: IO[bytes], samples: NDArray[np.void], states: Sequence[str], rate_hz: int
) -> None:
    about = {
        "format": FORMAT,
        "palpate": palpate_servo.__version__,
        "rate_hz": rate_hz,
        "units": UNITS,
    }
    write_arrays(
        file,
        {
            **{name: np.ascontiguousarray(samples[name]) for name in UNITS},
            "states": np.array(states),
            "about": np.array(json.dumps(about)),
        },
    )
