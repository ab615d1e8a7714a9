"""Microsoft's C runtime for children in Python, on Windows.

Blender brings it in a folder `blender.crt`, of which only blender.exe is told. Beside Blender's
python.exe there is none: where no other program has installed it, a child does not even start. So
children are shown the folder that this process has it from.
"""

from __future__ import annotations

import ctypes
import os
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

LIBRARY = "vcruntime140.dll"
VARIABLE = "PALPATE_C_RUNTIME"
LONGEST_PATH = 32768
# A Blender without a console would have one opened for each child.
NO_WINDOW: int = getattr(subprocess, "CREATE_NO_WINDOW", 0)


def folder() -> Path | None:
    """Return where this process has the runtime from; None on other systems."""
    if sys.platform != "win32":
        return None
    kernel32 = ctypes.WinDLL("kernel32")
    kernel32.GetModuleHandleW.restype = ctypes.c_void_p
    kernel32.GetModuleHandleW.argtypes = (ctypes.c_wchar_p,)
    kernel32.GetModuleFileNameW.argtypes = (ctypes.c_void_p, ctypes.c_wchar_p, ctypes.c_uint32)
    module = kernel32.GetModuleHandleW(LIBRARY)
    path = ctypes.create_unicode_buffer(LONGEST_PATH)
    if not (module and kernel32.GetModuleFileNameW(module, path, LONGEST_PATH)):
        return None
    return Path(path.value).parent


def environment(inherited: Mapping[str, str], runtime: Path | None) -> dict[str, str]:
    """Return the variables for a child that is to find the runtime.

    It comes last on PATH, by which Windows finds what a program itself is linked to: nothing that
    the user has is hidden by it.
    """
    if runtime is None:
        return dict(inherited)
    folders = [one for one in (inherited.get("PATH", ""), str(runtime)) if one]
    return {**inherited, "PATH": os.pathsep.join(folders), VARIABLE: str(runtime)}


def for_a_child() -> dict[str, str]:
    """Return the variables of this process, with its runtime."""
    return environment(os.environ, folder())


def take() -> None:
    """In the child: let libraries find the runtime too, for which Python does not look at PATH."""
    runtime = os.environ.get(VARIABLE)
    if sys.platform == "win32" and runtime:
        os.add_dll_directory(runtime)
