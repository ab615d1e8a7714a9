"""Ten minutes of bytes that nobody meant, by the tests' own properties: bodies, meshes, the link.

    python benchmarks/files/fuzz.py [--seconds 600]

In ``make test`` the same properties see the same hundred examples each; here they see others for as
long as there is time. A failure is printed with its smallest example, and the exit status is 1.
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
# Examples of a property in one round: a few minutes on a usual machine.
PROFILE = "long"


def main() -> int:
    """Go round with new seeds until the time is over."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=600.0)
    end = time.monotonic() + parser.parse_args().seconds
    rounds = 0
    while (left := end - time.monotonic()) > 0:
        seed = secrets.randbelow(2**31)
        options = [f"--hypothesis-profile={PROFILE}", f"--hypothesis-seed={seed}", "--timeout=0"]
        command = [sys.executable, "-m", "pytest", "-q", "-x", *options, *PROPERTIES]
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
