"""Ten minutes of bytes that nobody meant, by the tests' own properties: bodies, meshes, the link.

    python benchmarks/files/fuzz.py [--seconds 600] [--blender PYTHON]

In ``make test`` the same properties see the same hundred examples each; here they see others for as
long as there is time. With the Python of an environment that has Blender as a module, and a built
package, what a .blend says in its properties has half of it. A failure is printed with its smallest
example, and the exit status is 1.
"""

from __future__ import annotations

import argparse
import secrets
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROPERTIES = (
    "tests/core/files/test_fuzzed_bodies.py",
    "tests/core/files/test_own_files.py",
    "tests/core/mesh/test_mesh_formats.py",
    "tests/core/servo/test_codecs_agree.py",
    "tests/core/record/test_hostile_recordings.py",
    "tests/core/servo/test_link.py",
)
OF_BLEND_FILES = ("tests/addon/bake/test_fuzzed_properties.py",)
# Examples of a property in one round: a few minutes on a usual machine.
PROFILE = "long"


def main() -> int:
    """Try all that there is; 1 where anything was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=600.0)
    parser.add_argument("--blender", help="Python of an environment with Blender as a module")
    given = parser.parse_args()
    parts = [(sys.executable, PROPERTIES)]
    if given.blender:
        parts.append((given.blender, OF_BLEND_FILES))
    return max(tried(python, tests, given.seconds / len(parts)) for python, tests in parts)


def tried(python: str, tests: tuple[str, ...], seconds: float) -> int:
    """Go round with new seeds until the time, s, is over; 1 where anything was found."""
    end = time.monotonic() + seconds
    rounds = 0
    while (left := end - time.monotonic()) > 0:
        seed = secrets.randbelow(2**31)
        options = [f"--hypothesis-profile={PROFILE}", f"--hypothesis-seed={seed}", "--timeout=0"]
        command = [python, "-m", "pytest", "-q", "-x", *options, *tests]
        try:
            ended = subprocess.run(command, cwd=ROOT, check=False, timeout=left)
        except subprocess.TimeoutExpired:
            break
        if ended.returncode:
            print(f"failed with the seed {seed}")
            return 1
        rounds += 1
    print(f"nothing found in {rounds} whole rounds and the part of one")
    return 0


if __name__ == "__main__":
    sys.exit(main())
