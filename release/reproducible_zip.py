"""Write an archive again so that its bytes follow from its contents alone."""

from __future__ import annotations

import zipfile
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

# The first time that a zip can hold.
TIME = (1980, 1, 1, 0, 0, 0)
REGULAR_FILE = 0o100644 << 16
UNIX = 3


def settle(archive: Path) -> None:
    """Order the files of an archive by name, with one time and mode for all.

    What is compressed already (wheels) is stored.
    """
    settled = archive.with_name(f"{archive.name}.settled")
    with zipfile.ZipFile(archive) as old, zipfile.ZipFile(settled, "w") as new:
        for name in sorted(name for name in old.namelist() if not name.endswith("/")):
            entry = zipfile.ZipInfo(name, TIME)
            entry.create_system, entry.external_attr = UNIX, REGULAR_FILE
            entry.compress_type = (
                zipfile.ZIP_STORED if name.endswith(".whl") else zipfile.ZIP_DEFLATED
            )
            new.writestr(entry, old.read(name))
    settled.replace(archive)
