"""Bytes that nobody meant, ten minutes for each kind of them, by the tests' own properties.

    python benchmarks/files/fuzz.py [bodies|meshes|recordings|link|blend ...] [--seconds 600]

In ``make test`` the same properties see the same hundred examples each; here they see others, round
after round with a new seed, for as long as there is time. All but ``blend`` are tried unless named:
what a .blend says in its properties takes a built package and the Python of an environment that has
Blender as a module (``--blender``). A failure is printed with its seed and its smallest example,
and the exit status is 1.
"""

from __future__ import annotations

import argparse
import secrets
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROPERTIES = {
    "bodies": ("tests/core/files/test_fuzzed_bodies.py", "tests/core/files/test_own_files.py"),
    "meshes": ("tests/core/mesh/test_mesh_formats.py",),
    "recordings": ("tests/core/record/test_hostile_recordings.py",),
    "link": (
        "tests/core/servo/test_codecs_agree.py",
        "tests/core/servo/test_link.py",
        "tests/servo/device/test_any_device.py",
    ),
    "blend": ("tests/addon/bake/test_fuzzed_properties.py",),
}
PROFILE = "long"


def main() -> int:
    """Try all that there is; 1 where anything was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", nargs="*", choices=[*PROPERTIES, []], help="all unless given")
    parser.add_argument("--seconds", type=float, default=600.0, help="for each")
    parser.add_argument("--blender", help="Python of an environment with Blender as a module")
    given = parser.parse_args()
    chosen = given.what or [name for name in PROPERTIES if given.blender or name != "blend"]
    if "blend" in chosen and not given.blender:
        parser.error("blend needs --blender PYTHON, of an environment with Blender as a module")
    pythons = {name: given.blender if name == "blend" else sys.executable for name in chosen}
    return max(tried(name, python, given.seconds) for name, python in pythons.items())


def tried(name: str, python: str, seconds: float) -> int:
    """Go round with new seeds until the time, s, is over; 1 where anything was found."""
    end = time.monotonic() + seconds
    rounds = 0
    while (left := end - time.monotonic()) > 0:
        seed = secrets.randbelow(2**31)
        options = [f"--hypothesis-profile={PROFILE}", f"--hypothesis-seed={seed}", "--timeout=0"]
        # With what is played at length only, too.
        command = [python, "-m", "pytest", "-q", "-x", "-m", "", *options, *PROPERTIES[name]]
        try:
            ended = subprocess.run(
                command, cwd=ROOT, check=False, timeout=left, capture_output=True, text=True
            )
        except subprocess.TimeoutExpired:
            break
        if ended.returncode:
            print(f"{name}: failed with the seed {seed}\n{ended.stdout}{ended.stderr}", flush=True)
            return 1
        rounds += 1
    print(f"{name}: nothing found in {rounds} whole rounds and the part of one", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
