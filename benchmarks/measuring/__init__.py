"""What benchmarks share, beside the bodies and trials that they have in common with the tests."""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[2] / "tests"))
