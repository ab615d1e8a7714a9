"""Run one module of the package as a program: ``python run_module.py MODULE ARGUMENTS``.

Started by its path, since a child of Blender cannot import the extension by name.
"""

import importlib
import importlib.util
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NAME = "palpate"


def command(module: str) -> list[str]:
    """Arguments for the interpreter to run ``main()`` of a module such as ``core.bake.child``."""
    return [str(Path(__file__).resolve()), module]


def _load_package() -> None:
    spec = importlib.util.spec_from_file_location(
        NAME, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)]
    )
    if spec is None or spec.loader is None:
        raise ImportError(f"no package at {ROOT}")
    package = importlib.util.module_from_spec(spec)
    sys.modules[NAME] = package
    spec.loader.exec_module(package)


if __name__ == "__main__":
    # Python puts this folder first on the path: its modules would be found by their bare names.
    sys.path[:] = [folder for folder in sys.path if folder != str(Path(__file__).parent)]
    del sys.argv[0]
    _load_package()
    importlib.import_module(f"{NAME}.core.machine.c_runtime").take()
    sys.exit(importlib.import_module(f"{NAME}.{sys.argv[0]}").main())
