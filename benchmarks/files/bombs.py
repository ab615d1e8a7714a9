"""What it takes to refuse a zip bomb, beside numpy.load, which reads it.

    python benchmarks/files/bombs.py [--quick]

3 MB that say they are a body and become 3 GB (``--quick``: a tenth). The seconds of the
processor, which a busy machine does not lengthen, and the growth of memory are those of a fresh
process, the best of `RUNS`; the refusal holds within 50 ms and 50 MB.
So it does for a PLY of 200 bytes that promises a hundred million faces, and for
what else mesh files may promise and not hold.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
import zipfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.lib import format as npy

from palpate.benchmarks.measuring.memory import in_fresh_process
from palpate.core.body import body_file
from palpate.core.errors import PalpateError
from palpate.core.mesh.read_mesh import read_surface

RUNS = 3
ROWS = 125_000_000
MOST_SECONDS, MOST_BYTES = 0.05, 50_000_000
BYTES_AT_ONCE = 8_000_000
FACES = 100_000_000


def write_bomb(path: Path, rows: int) -> None:
    """A body file whose nodes are ``rows`` rows of zeros."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, word in (("format", body_file.FORMAT), ("version", "2"), ("form", "dense")):
            with archive.open(f"{name}.npy", "w") as member:
                npy.write_array(member, np.array(word))
        with archive.open("nodes.npy", "w", force_zip64=True) as member:
            about = {"descr": "<f8", "fortran_order": False, "shape": (rows, 3)}
            npy.write_array_header_1_0(member, about)
            for first in range(0, 24 * rows, BYTES_AT_ONCE):
                member.write(bytes(min(BYTES_AT_ONCE, 24 * rows - first)))


def write_promises(folder: Path) -> list[Path]:
    """Files of a few bytes that promise a lot."""
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    corners = "property list uchar int vertex_indices\n"
    head = f"ply\nformat ascii 1.0\nelement vertex 1\n{axes}element face {FACES}\n{corners}"
    lies = {
        "faces.ply": f"{head}end_header\n0 0 0\n".encode(),
        "triangles.stl": bytes(80) + (2**32 - 1).to_bytes(4, "little") + bytes(50),
        "beyond.obj": b"v 0 0 0\n" * 100 + b"f 1 2 999999999999\n",
        "endless.obj": bytes(20_000_000),
    }
    for name, content in lies.items():
        (folder / name).write_bytes(content)
    return [folder / name for name in lies]


def refused(path: Path) -> float:
    """Seconds of the processor until Palpate refuses the file."""
    begun = time.process_time()
    try:
        body_file.load(path) if path.suffix == ".npz" else read_surface(path)
    except PalpateError:
        return time.process_time() - begun
    raise AssertionError(f"{path} was read")


def loaded(path: Path) -> float:
    """Seconds of the processor until numpy has read the file."""
    begun = time.process_time()
    with np.load(path, allow_pickle=False) as arrays:
        for name in arrays.files:
            arrays[name]
    return time.process_time() - begun


def best(work: Callable[[Path], float], path: Path, runs: int) -> tuple[float, int]:
    """Least seconds, and the memory of that run."""
    return min(in_fresh_process(work, path) for _ in range(runs))


def main() -> int:
    """Measure, print, judge."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true")
    rows = ROWS // 10 if parser.parse_args().quick else ROWS
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "bomb.npz"
        write_bomb(path, rows)
        print(f"{path.stat().st_size / 1e6:.1f} MB that become {24 * rows / 1e6:,.0f} MB")
        seconds, grown = best(refused, path, RUNS)
        print(f"refused    {1e3 * seconds:9.1f} ms {grown / 1e6:9.1f} MB")
        theirs, their_growth = best(loaded, path, 1)
        print(f"numpy.load {1e3 * theirs:9.1f} ms {their_growth / 1e6:9.1f} MB")
        results = [(seconds, grown)]
        for lie in write_promises(Path(folder)):
            results.append(best(refused, lie, RUNS))
            seconds, grown = results[-1]
            print(f"{lie.name:<14} {1e3 * seconds:9.1f} ms {grown / 1e6:9.1f} MB")
    holds = all(s <= MOST_SECONDS and b <= MOST_BYTES for s, b in results)
    print("the claim holds" if holds else "THE CLAIM DOES NOT HOLD")
    return 0 if holds else 1


if __name__ == "__main__":
    sys.exit(main())
