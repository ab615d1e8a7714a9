"""How many quantised pushes fall through the surface or stick to it; none may.

    python benchmarks/servo/proxy_pushes.py [--full]

Random pushes along normals, axes, diagonals and any other way, at triangles, edges and nodes, with
positions in steps of 1, 10, 20, 50 and 60 um: into the stored mouse and into every kind of body of
the servo's own tests (needles, caps, specks, thin walls, touching parts, turned, 1 mm and 10 m
large), with the shape alone and with shading and friction. The pushes are made and judged by the
servo's example ``proxy_pushes``.

``--full`` makes 100,000 pushes a body, feel and quantum, which takes about an hour, instead of 500.
"""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from palpate.benchmarks.measuring.bodies import stored_body

PROJECT = Path(__file__).resolve().parents[2]
EXAMPLE = [
    *("cargo", "run", "--quiet", "--release", "--locked"),
    *("--manifest-path", str(PROJECT / "native" / "Cargo.toml"), "--example", "proxy_pushes", "--"),
]


def write_mouse(path: Path) -> None:
    """The stored mouse's surface as the example reads it."""
    mesh = stored_body("mouse-1.7k").mesh
    nodes = mesh.nodes[mesh.surface_nodes]
    triangles = mesh.surface_local_triangles
    with path.open("w") as file:
        file.write(f"{len(nodes)} {len(triangles)}\n")
        np.savetxt(file, nodes, fmt="%.17g")
        np.savetxt(file, triangles, fmt="%d")


def main() -> None:
    """Print the example's tables."""
    arguments = argparse.ArgumentParser(description=(__doc__ or "").split("\n", 1)[0])
    arguments.add_argument("--full", action="store_true", help="100,000 pushes instead of 500")
    pushes = 100_000 if arguments.parse_args().full else 500
    with tempfile.TemporaryDirectory() as place:
        mouse = Path(place) / "mouse.txt"
        write_mouse(mouse)
        for bodies in ([str(mouse)], []):
            subprocess.run([*EXAMPLE, "--pushes", str(pushes), *bodies], check=True)


if __name__ == "__main__":
    main()
