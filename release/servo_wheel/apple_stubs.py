"""Stubs of Apple's frameworks for the linker: where there is no SDK, a name to bind to is enough.

zig brings the symbols of libSystem. Of the frameworks that the crate `serialport` names, nothing is
called here: ports are listed by Python.
"""

from __future__ import annotations

from pathlib import Path

FRAMEWORKS = ("CoreFoundation", "IOKit")
STUB = """\
--- !tapi-tbd
tbd-version: 4
targets: [ x86_64-macos, arm64-macos ]
install-name: '/System/Library/Frameworks/{name}.framework/Versions/A/{name}'
exports:
  - targets: [ x86_64-macos, arm64-macos ]
    symbols: [ ]
...
"""


def write(folder: Path) -> Path:
    """Write the stubs into a folder and return it, as the linker's `-F` takes it."""
    for name in FRAMEWORKS:
        framework = folder / f"{name}.framework"
        framework.mkdir(parents=True, exist_ok=True)
        (framework / f"{name}.tbd").write_text(STUB.format(name=name), encoding="utf-8")
    return folder
