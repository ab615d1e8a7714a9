"""Say which files of the repository belong into the extension, and refuse what nobody foresaw."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bundled_wheels import PackagingError

if TYPE_CHECKING:
    from pathlib import Path

TOP_FILES = ("__init__.py", "LICENSE")
FOLDERS = ("addon", "operators", "core", "simulated", "cli")
# What these folders may hold for Blender's sake; anything else is refused, not shipped by accident.
SHIPPED = {".py", ".json", ".toml", ".glsl", ".png", ".svg", ".dat"}
# Translations, which the package holds in another form: see translations.py.
SOURCES = {".po"}


def extension_files(repository: Path) -> list[Path]:
    """Return what Blender needs, as paths relative to the repository, without manifest and wheels.

    Raises PackagingError when a file is missing or of a kind that is not foreseen.
    """
    files = [repository / name for name in TOP_FILES]
    for folder in FOLDERS:
        files += sorted(
            path
            for path in (repository / folder).rglob("*")
            if path.is_file()
            and "__pycache__" not in path.parts
            and not path.name.startswith(".")
            and path.suffix not in SOURCES
        )
    missing = [name for name in (*TOP_FILES, *FOLDERS) if not (repository / name).exists()]
    if missing:
        message = f"{repository} has no {', '.join(missing)}: the extension would be incomplete"
        raise PackagingError(message)
    strange = [
        path.relative_to(repository).as_posix()
        for path in files
        if path.suffix not in SHIPPED and path.name not in TOP_FILES
    ]
    if strange:
        message = (
            f"{', '.join(strange)}: not a kind of file that the extension ships; move it out of "
            f"{', '.join(FOLDERS)} or add its suffix to SHIPPED in release/extension_files.py"
        )
        raise PackagingError(message)
    return [path.relative_to(repository) for path in files]
