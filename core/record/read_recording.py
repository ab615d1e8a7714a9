"""Recordings read from files, which may be a stranger's."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TextIO

import numpy as np
import palpate_servo
from numpy.typing import NDArray

from ..files.npz_archive import Archive, ArchiveError, opened
from ..files.npz_members import ArrayHead
from ..files.small_text import json_value
from .recording import (
    CSV_HEADER,
    DTYPE,
    FINGER_COLUMN,
    FORMAT,
    SUFFIXES,
    UNITS,
    VECTORS,
    RecordingError,
)

# Rate beyond which there is no servo.
MOST_HZ = 1_000_000
# Of a row of a CSV file; a servo's have some four hundred.
MOST_CHARACTERS = 4_000
CSV_FIELDS = [("tick", "=u8"), ("numbers", "=f8", (16,)), ("state", "U32")]


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


def read_recording(path: Path) -> Recording:
    """Read what `recording.write_recording` has written, to the last bit.

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


def _read_npz(path: Path) -> Recording:
    try:
        with opened(path) as archive:
            return _recording(archive, path)
    except ArchiveError as problem:
        raise RecordingError("{problem}; record again", problem=problem) from problem


def _recording(archive: Archive, path: Path) -> Recording:
    """The recording in an archive, whose arrays are read once their shapes are known to agree."""
    try:
        about = json_value(str(archive.read("about")))
        if about["format"] != FORMAT:
            raise RecordingError(
                "{path}: is of the format {format}, this Palpate reads {own}; update Palpate",
                path=path,
                format=repr(about["format"]),
                own=repr(FORMAT),
            )
        # Old recordings of one finger have no column for it.
        names = [name for name in UNITS if name != "finger" or name in archive.heads]
        heads = [archive.heads[name] for name in names]
        count = heads[0].shape[0]
        for name, head in zip(names, heads, strict=True):
            _refuse_other_shape(name, head, count)
        states = tuple(str(state) for state in archive.read("states").ravel())
        samples = np.zeros(count, DTYPE)
        for name in names:
            samples[name] = archive.read(name)
        _refuse_nonsense(samples, states)
        return Recording(samples, states, _rate(about))
    except (LookupError, ValueError, TypeError, OverflowError) as problem:
        raise RecordingError(
            "{path}: is no recording ({problem}); choose another file",
            path=path,
            problem=repr(problem) if isinstance(problem, LookupError) else problem,
        ) from None


def _refuse_other_shape(name: str, head: ArrayHead, count: int) -> None:
    if head.shape != (count, *DTYPE[name].shape) or head.dtype.kind not in "iuf":
        raise ValueError(f"{name} is of the shape {head.shape}")


def _rate(about: Mapping[str, object]) -> int:
    rate = about["rate_hz"]
    if type(rate) is not int or not 0 < rate <= MOST_HZ:
        raise ValueError(f"a rate of {str(rate)[:30]} Hz")
    return rate


def _refuse_nonsense(samples: NDArray[np.void], states: Sequence[str]) -> None:
    """Raise ValueError for states without a name and numbers that no servo records."""
    if len(samples) and samples["state"].max() >= len(states):
        raise ValueError(f"state {samples['state'].max()} has no name")
    # The touched surface is nowhere while a finger is free.
    for name in ("time", "probe", "proxy", "force", "output"):
        if not np.isfinite(samples[name]).all():
            raise ValueError(f"{name} is not finite")
    for finger in np.unique(samples["finger"]):
        if (np.diff(samples["time"][samples["finger"] == finger]) < 0.0).any():
            raise ValueError("its times go back")


def _lines(file: TextIO) -> Iterator[str]:
    """Lines of a file, none of them longer than a servo's rows."""
    while line := file.readline(MOST_CHARACTERS):
        if len(line) == MOST_CHARACTERS:
            raise ValueError(f"a line of over {MOST_CHARACTERS - 1} characters")
        yield line


def _read_csv(path: Path) -> Recording:
    try:
        with path.open(encoding="utf-8") as file:
            header = file.readline(2 * len(CSV_HEADER)).rstrip("\n")
            if header not in (CSV_HEADER, CSV_HEADER + FINGER_COLUMN):
                raise RecordingError(
                    "{path}: is no recording (another first line); choose another file", path=path
                )
            is_alone = header == CSV_HEADER
            fields = np.dtype(CSV_FIELDS + ([] if is_alone else [("finger", "=u4")]))
            rows = np.empty(0, fields)
            # numpy warns of files without lines.
            if first := next(_lines(file), ""):
                lines = itertools.chain([first], _lines(file))
                rows = np.loadtxt(lines, fields, delimiter=",", comments=None, ndmin=1)
    except OSError as problem:
        raise RecordingError(
            "{path}: cannot be read ({reason}); choose another file",
            path=path,
            reason=problem.strerror,
        ) from problem
    except MemoryError as problem:
        raise RecordingError(
            "{path}: does not fit into the memory of this computer; record less", path=path
        ) from problem
    except (ValueError, OverflowError) as problem:
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
    try:
        _refuse_nonsense(samples, states)
    except ValueError as problem:
        raise RecordingError(
            "{path}: is damaged ({problem}); record again", path=path, problem=problem
        ) from problem
    return Recording(samples, states, None)
