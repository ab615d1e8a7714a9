"""Patience with files that Windows does not let go while another process has them open.

Virus scanners, indexers and readers have them for moments. Other systems refuse nothing for that.
"""

from __future__ import annotations

import shutil
import time
from collections.abc import Callable
from pathlib import Path

PAUSES = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0)
"""Seconds between attempts: two in all, longer than a scanner takes for a file."""


def patiently(action: Callable[[], object], sleep: Callable[[float], None] = time.sleep) -> None:
    """Do ``action``, again after a pause where it was refused; the last refusal is raised."""
    for pause in PAUSES:
        try:
            action()
        except PermissionError:
            sleep(pause)
        else:
            return
    action()


def remove_file(path: Path) -> None:
    """Remove a file, if it is there."""
    patiently(lambda: path.unlink(missing_ok=True))


def remove_folder(path: Path) -> None:
    """Remove a folder with everything in it, if it is there."""
    if path.exists():
        patiently(lambda: shutil.rmtree(path))
