"""Recordings of the servo as files: every tick in CSV or npz, written atomically.

`docs/recording.md` describes both formats.
"""

from __future__ import annotations

import itertools
import json
import shutil
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import numpy as np
import palpate_servo
from numpy.typing import NDArray

from ..errors import PalpateError
from ..files.atomic_file import atomic_file, refuse_missing_folder, refuse_unwritable
from ..files.npz_archive import ArchiveError, read_arrays, write_arrays

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
_CSV_FIELDS = [("tick", "=u8"), ("numbers", "=f8", (16,)), ("state", "U32")]


class RecordingError(PalpateError):
    """Recording that cannot be written or read."""


@dataclass(frozen=True, eq=False)
class Recording:
    """Recorded ticks from a file.

    Attributes
    ----------
    samples : structured array (n,) of `DTYPE`; a row for each finger of each tick.
    states : names of the states that `samples["state"]` counts.
    rate_hz : of the servo; None from a CSV file.
    """

    samples: NDArray[np.void]
    states: tuple[str, ...]
    rate_hz: int | None


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


def read_recording(path: Path) -> Recording:
    """Read what `write_recording` has written, to the last bit.

    Raises
    ------
    RecordingError
        The file is not there, is damaged, or is no recording.
    """
    match path.suffix.lower():
        case ".csv":
            return _read_csv(path)
        case ".npz":
            return _read_npz(path)
        case _:
            raise RecordingError(
                "{path}: a recording ends in {suffixes}", path=path, suffixes=" or ".join(SUFFIXES)
            )


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


def _read_npz(path: Path) -> Recording:
    try:
        arrays = read_arrays(path)
    except ArchiveError as problem:
        raise RecordingError("{problem}; record again", problem=problem) from problem
    try:
        about = json.loads(str(arrays["about"]))
        if about["format"] != FORMAT:
            raise RecordingError(
                "{path}: is of the format {format}, this Palpate reads {own}; update Palpate",
                path=path,
                format=repr(about["format"]),
                own=repr(FORMAT),
            )
        samples = np.zeros(len(arrays["tick"]), DTYPE)
        for name in UNITS:
            # Old recordings of one finger have no column for it.
            if name != "finger" or name in arrays:
                samples[name] = arrays[name]
        return Recording(samples, tuple(arrays["states"].tolist()), int(about["rate_hz"]))
    except (KeyError, ValueError, TypeError) as problem:
        raise RecordingError(
            "{path}: is no recording ({problem}); choose another file", path=path, problem=problem
        ) from None


def _read_csv(path: Path) -> Recording:
    try:
        with path.open(encoding="utf-8") as file:
            header = file.readline().rstrip("\n")
            if header not in (CSV_HEADER, CSV_HEADER + FINGER_COLUMN):
                raise RecordingError(
                    "{path}: is no recording (another first line); choose another file", path=path
                )
            is_alone = header == CSV_HEADER
            fields = np.dtype(_CSV_FIELDS + ([] if is_alone else [("finger", "=u4")]))
            rows = np.empty(0, fields)
            # numpy warns of files without lines.
            if first := file.readline():
                lines = itertools.chain([first], file)
                rows = np.loadtxt(lines, fields, delimiter=",", comments=None, ndmin=1)
    except OSError as problem:
        raise RecordingError(
            "{path}: cannot be read ({reason}); choose another file",
            path=path,
            reason=problem.strerror,
        ) from problem
    except ValueError as problem:
        raise RecordingError(
            "{path}: is damaged ({problem}); record again", path=path, problem=problem
        ) from problem
    samples = np.zeros(len(rows), DTYPE)
    if not is_alone:
        samples["finger"] = rows["finger"]
    samples["tick"], samples["time"] = rows["tick"], rows["numbers"][:, 0]
    for place, name in enumerate(VECTORS):
        samples[name] = rows["numbers"][:, 1 + 3 * place : 4 + 3 * place]
    names, found = np.unique(rows["state"], return_inverse=True)
    states = tuple(dict.fromkeys((*palpate_servo.STATES, *names.tolist())))
    samples["state"] = np.array([states.index(name) for name in names], np.uint32)[found]
    return Recording(samples, states, None)
