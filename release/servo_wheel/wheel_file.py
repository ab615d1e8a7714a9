"""Wheels with files that were changed after they were packed, or added."""

from __future__ import annotations

import base64
import hashlib
import zipfile
from collections.abc import Mapping
from pathlib import Path


def rewrite(wheel: Path, files: Mapping[str, bytes]) -> None:
    """Write a wheel anew with other contents of some files, and what its record says of them."""
    with zipfile.ZipFile(wheel) as archive:
        members = [(info, archive.read(info)) for info in archive.infolist()]
    added = sorted(set(files) - {info.filename for info, _ in members})
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in added:
            archive.writestr(zipfile.ZipInfo(name), files[name], zipfile.ZIP_DEFLATED)
        for info, content in members:
            now = files.get(info.filename, content)
            if info.filename.endswith(".dist-info/RECORD"):
                now = _record(content.decode(), files, added).encode()
            archive.writestr(info, now)


def _record(lines: str, files: Mapping[str, bytes], added: list[str]) -> str:
    """A wheel's record with the digests and lengths of what has changed or come."""
    rows = [[name, "", ""] for name in added] + [line.split(",") for line in lines.splitlines()]
    for row in rows:
        if row[0] in files:
            content = files[row[0]]
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).decode()
            row[1:] = [f"sha256={digest.rstrip('=')}", str(len(content))]
    return "\n".join(",".join(row) for row in rows) + "\n"
