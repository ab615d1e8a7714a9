"""Compile `palpate_servo` for any platform, from Linux: maturin, with zig as linker and C compiler.

The same commit, compiler and versions of the tools (pyproject.toml) give the same bytes, wherever
the checkout and the crates lie.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

from bundled_wheels import PackagingError
from servo_wheel import apple_stubs, openmp, standard_library
from servo_wheel.settled_uuid import settle_wheel
from servo_wheel.target import MACOS_DEPLOYMENT_TARGET, Target

# What a compiler may read from the environment and put into an image.
LEFT_OUT = {"RUSTFLAGS", "CFLAGS", "CXXFLAGS", "LDFLAGS", "SDKROOT", "PYO3_PYTHON"} | {
    "MAKEFLAGS",
    "MFLAGS",
}
# Any time: that of a commit would change wheels that have not changed.
SOURCE_DATE_EPOCH = "315532800"


def compile_wheel(
    target: Target, repository: Path, work: Path, output: Path, features: str = "python"
) -> Path:
    """Compile the wheel of one target into the folder `output`, where its tag tells it from others.

    Parameters
    ----------
    work : cargo's target folder.
    features : of the crate; `python,harness` for tests.

    Raises
    ------
    PackagingError
        There is no standard library for the target, or the crate does not compile.
    """
    toolchain = standard_library.provide(target.triple, work)
    environment = {key: value for key, value in os.environ.items() if key not in LEFT_OUT}
    environment |= dict(settings(target, repository, work, environment)) | dict(toolchain)
    for older in output.glob(f"palpate_servo-*-{target.tag}.whl"):
        older.unlink()
    done = subprocess.run(
        command(target, repository, output, features), env=environment, check=False, text=True
    )
    if done.returncode != 0:
        message = f"palpate_servo does not compile for {target.platform} ({target.triple})"
        raise PackagingError(message)
    (wheel,) = output.glob(f"palpate_servo-*-{target.tag}.whl")
    if target.is_macos:
        settle_wheel(wheel)
    if openmp.is_wanted(target):
        openmp.add_to(wheel, repository)
    return wheel


def command(target: Target, repository: Path, output: Path, features: str) -> list[str]:
    """Return the call of maturin."""
    call = [sys.executable, "-m", "maturin", "build", "--release", "--quiet", "--locked"]
    call += ["--manifest-path", str(repository / "native" / "Cargo.toml"), "--features", features]
    call += ["--zig", "--target", target.triple, "--out", str(output)]
    if target.is_linux:
        call += ["--compatibility", target.tag.rsplit("_", 2 if "x86_64" in target.tag else 1)[0]]
    return call


def settings(
    target: Target, repository: Path, work: Path, environment: Mapping[str, str]
) -> Iterator[tuple[str, str]]:
    """Yield the variables that cargo, the compilers and maturin read."""
    crates = environment.get("CARGO_HOME") or str(Path.home() / ".cargo")
    # The last that fits wins: folders first, then what lies in them.
    places = {crates: "/cargo", str(repository): "/palpate", str(work): "/target"}
    flags = [f"--remap-path-prefix={place}={name}" for place, name in places.items()]
    if target.is_macos:
        flags += [f"-Clink-arg=-F{apple_stubs.write(work / 'apple-frameworks')}"]
        yield "MACOSX_DEPLOYMENT_TARGET", MACOS_DEPLOYMENT_TARGET
    yield "CARGO_ENCODED_RUSTFLAGS", "\x1f".join(flags)
    prefixes = [f"-ffile-prefix-map={place}={name}" for place, name in places.items()]
    yield "TARGET_CFLAGS", " ".join(prefixes)
    yield "CARGO_TARGET_DIR", str(work)
    yield "SOURCE_DATE_EPOCH", SOURCE_DATE_EPOCH
    yield "CARGO_ZIGBUILD_PYTHON_PATH", sys.executable
