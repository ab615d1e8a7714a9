"""Lets tests import what Blender and the demo start by path."""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "sample_scenes"), str(ROOT / "demo")]
