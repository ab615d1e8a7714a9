"""Rust's standard library for a target: rustup's, or one compiled from its source.

Where rustup is not there or may not fetch, a compiler that has the library's source beside it will
do, such as Debian's `rustc-web` with `rust-web-src`. The result is laid out as rustup does it.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
from collections.abc import Mapping
from pathlib import Path

from bundled_wheels import PackagingError

# Debian's, beside that of rustup.
COMPILERS = ("rustc", "/usr/bin/rustc")
SOURCE = Path("lib/rustlib/src/rust/library")
EMPTY_CRATE = '[package]\nname = "nothing"\nversion = "0.0.0"\nedition = "2021"\n'


def provide(triple: str, work: Path) -> Mapping[str, str]:
    """See to it that the compiler has a standard library for a target.

    Parameters
    ----------
    work : a folder for what has to be compiled for that.

    Returns
    -------
    variables that name another compiler than the usual one; none where that one has it.

    Raises
    ------
    PackagingError
        rustup cannot add it, and no compiler has its source.
    """
    if _is_there(triple) or _is_added(triple):
        return {}
    for compiler in COMPILERS:
        sysroot = _said(compiler, "--print", "sysroot")
        if sysroot and (Path(sysroot) / SOURCE).is_dir():
            return _compiled(compiler, Path(sysroot), triple, work / "standard-library")
    message = (
        f"Rust has no standard library for {triple} here: run `rustup target add {triple}`, or "
        "install the library's source (rustup component add rust-src; Debian: rust-web-src)"
    )
    raise PackagingError(message)


def _is_there(triple: str) -> bool:
    folder = _said("rustc", "--print", "target-libdir", "--target", triple)
    return bool(folder) and any(Path(folder).glob("libstd-*.rlib"))


def _is_added(triple: str) -> bool:
    if shutil.which("rustup") is None:
        return False
    return subprocess.run(["rustup", "target", "add", triple], check=False).returncode == 0


def _said(*command: str) -> str:
    """What a command prints; empty where it fails or is not there."""
    if shutil.which(command[0]) is None:
        return ""
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else ""


def _compiled(compiler: str, sysroot: Path, triple: str, work: Path) -> Mapping[str, str]:
    """A compiler whose system root has the library for `triple`, compiled with an empty crate."""
    cargo = shutil.which("cargo", path=str(Path(shutil.which(compiler) or compiler).parent))
    if cargo is None:
        message = f"there is no cargo beside {compiler}: install it (Debian: cargo-web)"
        raise PackagingError(message)
    crate, root = work / "nothing", work / "root"
    (crate / "src").mkdir(parents=True, exist_ok=True)
    (crate / "Cargo.toml").write_text(EMPTY_CRATE, encoding="utf-8")
    (crate / "src" / "lib.rs").write_text("", encoding="utf-8")
    environment = {**os.environ, "RUSTC": compiler, "RUSTC_BOOTSTRAP": "1"}
    call = [cargo, "build", "--release", "--quiet", "--target", triple]
    call += ["-Z", "build-std=std,panic_unwind", "--manifest-path", str(crate / "Cargo.toml")]
    done = subprocess.run([*call, "--target-dir", str(work)], env=environment, check=False)
    if done.returncode != 0:
        message = f"{compiler} cannot compile Rust's standard library for {triple}"
        raise PackagingError(message)
    libraries = root / "lib" / "rustlib" / triple / "lib"
    libraries.mkdir(parents=True, exist_ok=True)
    for library in (work / triple / "release" / "deps").glob("lib*.rlib"):
        if not library.name.startswith("libnothing-"):
            shutil.copy2(library, libraries)
    # The compiler's own system, for build scripts and macros.
    for folder in (sysroot / "lib" / "rustlib").iterdir():
        beside = root / "lib" / "rustlib" / folder.name
        if folder.name != triple and not beside.is_symlink():
            beside.symlink_to(folder)
    wrapper = work / "rustc"
    wrapper.write_text(
        f'#!/bin/sh\nexec {shlex.quote(compiler)} --sysroot {shlex.quote(str(root))} "$@"\n',
        encoding="utf-8",
    )
    wrapper.chmod(0o755)
    return {"RUSTC": str(wrapper), "CARGO": cargo}
