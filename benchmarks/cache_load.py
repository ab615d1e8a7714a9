"""From a body file to the first deformation, beside the bake that the file saves.

    python benchmarks/cache_load.py [--bodies NAME ...]

For ``mouse-1.7k`` and ``mouse-20k`` in both forms: the file is read, its pages having been dropped
from the system's cache where the system allows that, contact blocks and the native body are made,
and the first press is deformed. A large dense table stays in its file (*in place*); beside it the
same file read whole. Each in a process of its own, so that nothing is warm but Python's modules.
"""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from measuring.bodies import stored_body
from measuring.memory import in_fresh_process

from palpate.core.bake.settings import BakeSettings
from palpate.core.bake.steps import bake
from palpate.core.body import body_file
from palpate.core.servo.session import native_body
from palpate.core.stiffness.pins import PinNodes

BODIES = ("mouse-1.7k", "mouse-20k")
FORMS = ("dense", "compressed")

# The first press after loading a body so large may take at most this share of its bake.
LARGEST_SHARE = {"mouse-20k": 0.1}

PRESSED_TRIANGLE = 200


@dataclass(frozen=True)
class FirstPress:
    """Seconds of each part of the way to the first deformation."""

    load: float
    contact_blocks: float
    native_body: float
    deform: float

    @property
    def total(self) -> float:
        """Seconds of the whole way."""
        return self.load + self.contact_blocks + self.native_body + self.deform


def main() -> int:
    """Print the table; the exit status tells whether loading was quick enough."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--bodies", nargs="+", default=BODIES, metavar="NAME")
    missed = False
    print(
        f"{'body':12}{'form':12}{'file MB':>8}{'bake s':>8}  {'read':10}{'pages':7}"
        f"{'load ms':>9}{'blocks':>8}{'native':>8}{'deform':>8}{'total':>8}{'of bake':>9}{'MB':>6}"
    )
    for name in parser.parse_args().bodies:
        for form in FORMS:
            with tempfile.TemporaryDirectory() as folder:
                missed |= _measure(name, form, Path(folder) / "body.npz")
    return int(missed)


def _measure(name: str, form: str, file: Path) -> bool:
    """Print the rows of one body in one form; whether one of them missed the mark."""
    body = stored_body(name)
    settings = BakeSettings(pins=PinNodes(body.fixed), form=form)
    start = time.perf_counter()
    baked, _ = bake(body.mesh, settings)
    seconds = time.perf_counter() - start
    body_file.save(baked, file)
    size = file.stat().st_size
    missed = False
    whole_only = (
        body_file.MAPPED_FROM_BYTES is None or baked.compliance.nbytes < body_file.MAPPED_FROM_BYTES
    )
    for way in ("whole",) if whole_only or form != "dense" else ("in place", "whole"):
        for pages in ("cold", "warm"):
            if pages == "cold" and not _drop_pages(file):
                continue
            press, peak = in_fresh_process(_first_press, file, way == "in place")
            share = press.total / seconds
            missed |= share > LARGEST_SHARE.get(name, np.inf)
            print(
                f"{body.name:12}{form:12}{size / 1e6:8.1f}{seconds:8.2f}  {way:10}{pages:7}"
                f"{1e3 * press.load:9.1f}{1e3 * press.contact_blocks:8.1f}"
                f"{1e3 * press.native_body:8.1f}{1e3 * press.deform:8.2f}{1e3 * press.total:8.1f}"
                f"{100 * share:8.1f}%{peak / 1e6:6.0f}",
                flush=True,
            )
    return missed


def _first_press(file: Path, in_place: bool) -> FirstPress:
    """Load, prepare and deform once, as the first Press does."""
    marks = [time.perf_counter()]
    body = body_file.load(file) if in_place else body_file.load(file, mapped_from_bytes=None)
    marks.append(time.perf_counter())
    _ = body.contact_blocks
    marks.append(time.perf_counter())
    native_body(body)
    marks.append(time.perf_counter())
    body.deform(body.mesh.surface_triangles[PRESSED_TRIANGLE], np.eye(3))
    marks.append(time.perf_counter())
    return FirstPress(*np.diff(marks).tolist())


def _drop_pages(file: Path) -> bool:
    """Ask the system to forget the file's pages; whether it can be asked at all."""
    if sys.platform != "linux":
        return False
    with file.open("rb") as stream:
        os.fsync(stream.fileno())
        os.posix_fadvise(stream.fileno(), 0, 0, os.POSIX_FADV_DONTNEED)
    return True


if __name__ == "__main__":
    sys.exit(main())
