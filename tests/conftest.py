"""What every test process needs before it imports numpy."""

from __future__ import annotations

import os

# One thread for BLAS: results do not depend on the number of cores, and the servo keeps its own.
for _name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_name] = "1"
