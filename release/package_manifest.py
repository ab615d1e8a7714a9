"""Turn the repository's blender_manifest.toml into that of one platform's package."""

from __future__ import annotations

import re
import tomllib

from bundled_wheels import PackagingError


def package_manifest(source: str, platform: str, wheels: list[str]) -> str:
    """Return the manifest's text with `platforms` narrowed to one and `wheels` filled in.

    Everything else, comments too, stays as it is. Raises PackagingError when the source does not
    have the form that this relies on: one `platforms` line and no `wheels`.
    """
    listed = "".join(f'    "./wheels/{name}",\n' for name in sorted(wheels))
    replacement = f'platforms = ["{platform}"]\n\nwheels = [\n{listed}]'
    text, count = re.subn(r"^platforms = \[.*\]$", replacement, source, flags=re.MULTILINE)
    before = tomllib.loads(source)
    if count != 1 or "wheels" in before:
        message = "blender_manifest.toml must have its platforms on one line, and no wheels"
        raise PackagingError(message)
    if platform not in before["platforms"]:
        message = f"blender_manifest.toml does not list the platform {platform}"
        raise PackagingError(message)
    return text
