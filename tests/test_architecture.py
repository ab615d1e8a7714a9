"""The one-way wall: `__init__ -> addon -> operators -> core -> palpate_servo`, and `cli -> core`.

Imports are read from the source, so that a forbidden one is found wherever it stands, also inside a
function or under TYPE_CHECKING.
"""

from __future__ import annotations

import ast
import re
import tomllib
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
LAYERS = {
    # layer: which layers it may import besides itself
    "__init__": {"addon", "operators"},
    "addon": {"operators", "simulated", "core"},
    "operators": {"simulated", "core"},
    "cli": {"simulated", "core"},
    "simulated": {"core"},
    "core": set(),
}
BLENDER = {"bpy", "bpy_extras", "bl_ext", "bl_operators", "bl_ui", "addon_utils", "mathutils"} | {
    "gpu",
    "gpu_extras",
    "blf",
    "bgl",
    "bmesh",
    "imbuf",
    "idprop",
    "aud",
}
NAMES_THAT_SAY_NOTHING = {"util", "utils", "helper", "helpers", "manager", "common", "misc"}


def layer_of(path: Path) -> str:
    return path.relative_to(REPOSITORY).with_suffix("").parts[0]


def sources() -> list[Path]:
    found = [REPOSITORY / "__init__.py"]
    for layer in LAYERS:
        found += sorted((REPOSITORY / layer).rglob("*.py"))
    return found


def imports(source: str, package: tuple[str, ...]) -> list[tuple[int, str]]:
    """Return (line, dotted name) of every import; those of Palpate itself begin with a dot.

    `package` is where the file stands: `("core", "devices")` for core/servo/link.py.
    """
    found = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Import):
            found += [(node.lineno, alias.name) for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            found.append((node.lineno, node.module or ""))
        elif isinstance(node, ast.ImportFrom):
            assert node.level <= len(package) + 1, f"line {node.lineno} leaves the package"
            base = package[: len(package) + 1 - node.level]
            inside = [*base, *(node.module or "").split(".")] if node.module else [*base]
            # `from .. import core` names the layer only after the word import.
            names = [".".join(inside)] if inside else [alias.name for alias in node.names]
            found += [(node.lineno, f".{name}") for name in names]
    return found


def imports_of(path: Path) -> list[tuple[int, str]]:
    package = path.relative_to(REPOSITORY).parent.parts
    return imports(path.read_text(encoding="utf-8"), package)


SOURCES = sources()
every_source = pytest.mark.parametrize(
    "path", SOURCES, ids=[path.relative_to(REPOSITORY).as_posix() for path in SOURCES]
)


def test_reading_imports_sees_through_functions_and_relative_names():
    source = (
        "import bpy.types\ndef f():\n    from ..operators.press import Press\nfrom . import x\n"
    )
    assert imports(source, ("core",)) == [
        (1, "bpy.types"),
        (4, ".core"),
        (3, ".operators.press"),
    ]
    assert imports("from .. import addon", ("core",)) == [(1, ".addon")]
    assert imports("from ...cli import main", ("core", "devices")) == [(1, ".cli")]


@every_source
def test_layers_import_only_downwards(path):
    layer = layer_of(path)
    allowed = {layer, *LAYERS[layer]}
    upwards = [
        f"line {line}: {name}"
        for line, name in imports_of(path)
        if name.startswith(".") and name.split(".")[1] not in allowed
    ]
    assert not upwards


@every_source
def test_palpate_imports_itself_only_by_relative_names(path):
    """Inside Blender the package is called bl_ext.<repository>.palpate."""
    assert not [n for _, n in imports_of(path) if n.split(".")[0] in {"palpate", *LAYERS}]


@every_source
def test_core_and_command_line_do_not_know_blender(path):
    if layer_of(path) not in {"core", "simulated", "cli"}:
        return
    foreign = [
        f"line {line}: {name}" for line, name in imports_of(path) if name.split(".")[0] in BLENDER
    ]
    assert not foreign


def test_blenders_door_imports_nothing_before_register():
    """So that `import palpate` needs no Blender, and a failing import is reported by register()."""
    module = ast.parse((REPOSITORY / "__init__.py").read_text(encoding="utf-8"))
    early = [
        ast.unparse(node)
        for node in module.body
        if isinstance(node, ast.Import)
        or (isinstance(node, ast.ImportFrom) and node.module != "__future__")
    ]
    assert not early


def test_only_core_starts_the_servo():
    users = {
        layer_of(path)
        for path in SOURCES
        for _, name in imports_of(path)
        if name.split(".")[0] == "palpate_servo"
    }
    assert users <= {"core"}


@every_source
def test_names_of_modules_say_what_they_are_for(path):
    assert not NAMES_THAT_SAY_NOTHING & set(path.stem.split("_"))


def test_every_python_package_is_installed():
    """The explicit list in pyproject.toml and the folders agree."""
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    listed = set(project["tool"]["setuptools"]["packages"])
    folders = {
        path.relative_to(REPOSITORY).parent for path in SOURCES if path.name == "__init__.py"
    }
    assert listed == {".".join(("palpate", *folder.parts)) for folder in folders}


def test_one_version_everywhere():
    project = tomllib.loads((REPOSITORY / "pyproject.toml").read_text(encoding="utf-8"))
    manifest = tomllib.loads((REPOSITORY / "blender_manifest.toml").read_text(encoding="utf-8"))
    crate = tomllib.loads((REPOSITORY / "native" / "Cargo.toml").read_text(encoding="utf-8"))
    changes = (REPOSITORY / "CHANGELOG.md").read_text(encoding="utf-8")
    latest = re.search(r"^## (\S+)", changes, re.MULTILINE)
    assert latest is not None
    assert {
        manifest["version"],
        crate["package"]["version"],
        project["project"]["version"],
        latest[1],
    } == {project["project"]["version"]}
