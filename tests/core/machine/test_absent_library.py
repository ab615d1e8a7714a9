"""Where a library has no build, baking says so, and everything else goes on."""

import subprocess
import sys

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from palpate.core.errors import PalpateError
from palpate.core.machine.absent_library import library
from palpate.core.mesh.surface import Surface
from palpate.core.mesh.tetrahedralize import tetrahedralize

CORNERS = np.array([[x, y, z] for x in (0.0, 1.0) for y in (0.0, 1.0) for z in (0.0, 1.0)])
CUBE = Surface(CORNERS, ConvexHull(CORNERS).simplices.astype(np.int64))


def test_a_library_that_is_there_is_handed_over():
    assert library("json", "JSON").dumps([]) == "[]"


def test_a_bake_without_ftetwild_says_where_it_can_be_done(monkeypatch):
    monkeypatch.setitem(sys.modules, "pytetwild.pytetwild", None)
    with pytest.raises(PalpateError, match=r"fTetWild cannot be loaded .* another computer"):
        tetrahedralize(CUBE, 0.1, 1e-3)


def test_everything_else_starts_without_them():
    """As on Windows on ARM: nothing that is imported at the start needs what is absent there."""
    program = (
        "import sys\n"
        "for name in ('pytetwild', 'pytetwild.pytetwild', 'fast_simplification', 'coacd'):\n"
        "    sys.modules[name] = None\n"
        "import palpate.cli.main, palpate.core.bake.steps, palpate.core.bake.job\n"
        "palpate.cli.main.main(['materials'])\n"
    )
    done = subprocess.run([sys.executable, "-c", program], check=False, capture_output=True)
    assert done.returncode == 0, done.stderr.decode()
