"""Child process that takes one mesh apart into convex parts by CoACD.

Standard input: a line of JSON, then vertices (v, 3) and triangles (f, 3) as npy. Standard output:
how many corners each part has, and all corners (k, 3), as npy.
"""

import ctypes
import faulthandler
import importlib.util
import io
import json
import os
import sys
from pathlib import Path

# Of a shape in a box of side 1, by which a part may still be hollow, and how long better cuts are
# searched for: half of the library's own take half of its time, for a bowl as well filled.
CONCAVITY, NODES, ITERATIONS, SAMPLES = 0.03, 10, 60, 1000
SEED = 0
# How this ends where CoACD's library cannot be loaded.
NOT_LOADED = 3


def main() -> int:
    """Answer one request."""
    request = io.BytesIO(sys.stdin.buffer.read())
    told = json.loads(request.readline())
    # For a parent that died unnoticed.
    faulthandler.dump_traceback_later(told["seconds"], exit=True)
    sys.path[:] = told["path"]
    # What the library prints is no answer.
    output = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    import numpy as np

    try:
        load_openmp()
        import coacd
    except OSError as problem:
        sys.stderr.write(f"{problem}\n")
        return NOT_LOADED
    vertices, triangles = np.load(request), np.load(request)
    coacd.set_log_level("off")
    found = coacd.run_coacd(
        coacd.Mesh(vertices, triangles),
        threshold=CONCAVITY,
        max_convex_hull=told["most"],
        resolution=SAMPLES,
        mcts_nodes=NODES,
        mcts_iterations=ITERATIONS,
        seed=SEED,
    )
    parts = [np.asarray(corners, dtype=np.float64) for corners, _ in found]
    answer = io.BytesIO()
    np.save(answer, np.array([len(one) for one in parts]))
    np.save(answer, np.concatenate(parts))
    with output:
        output.write(answer.getvalue())
    return 0


def load_openmp() -> None:
    """On Windows: load the servo's, so that CoACD's library need not find Microsoft's."""
    if sys.platform == "win32":
        servo = importlib.util.find_spec("palpate_servo")
        # Whoever compiles the servo on Windows itself has none, and needs Microsoft's.
        library = Path(servo.origin if servo and servo.origin else ".").with_name("vcomp140.dll")
        if library.exists():
            ctypes.WinDLL(str(library))
