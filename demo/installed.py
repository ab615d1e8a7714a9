"""Palpate as users have it: the package installed by Blender, in a separate home."""

import importlib
import os
import sys
from pathlib import Path
from types import ModuleType

REPOSITORY = "user_default"


def install(package: Path, home: Path) -> None:
    """Install and enable the extension's package; Blender's settings live in `home`.

    Import bpy only after this: Blender takes its home from the environment when it starts.
    """
    if "bpy" in sys.modules:
        raise RuntimeError("Blender has started already and keeps its settings elsewhere")
    home.mkdir(parents=True, exist_ok=True)
    os.environ["BLENDER_USER_RESOURCES"] = str(home)
    import bpy

    bpy.ops.preferences.addon_enable(module="cycles")
    bpy.ops.preferences.addon_enable(module="bl_pkg")
    bpy.ops.extensions.package_install_files(
        filepath=str(package), repo=REPOSITORY, enable_on_install=True, overwrite=True
    )
    name = f"bl_ext.{REPOSITORY}.palpate"
    if name not in bpy.context.preferences.addons:
        raise RuntimeError(f"{package.name} was installed, but Blender could not enable it")


def palpate(module: str) -> ModuleType:
    """Module of the installed extension, for instance `operators.session.press_session`."""
    return importlib.import_module(f"bl_ext.{REPOSITORY}.palpate.{module}")
