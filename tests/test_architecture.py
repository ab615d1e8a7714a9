"""The one-way wall: `__init__ -> addon -> operators -> core -> palpate_servo`, and `cli -> core`.

Imports are read from the source, so that a forbidden one is found wherever it stands, also inside a
function or under TYPE_CHECKING.
"""

from __future__ import annotations

import ast
import re
import tomllib
from collections.abc import Callable, Iterable
from pathlib import Path

import pytest
import source_imports
from house_rules import (
    KNOWN,
    LAYERS,
    MOST_FILES,
    MOST_LINES,
    MOST_LINES_OF_TESTS,
    ROOMS_OF_PYTHON,
    ROOMS_OF_RUST,
)
from source_imports import (
    CRATE,
    REPOSITORY,
    imports_of,
    python_files_imported,
    python_imports,
    rust_files_imported,
)

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


SOURCES = sources()
IMPORTS = [
    (layer_of(path), f"{path.relative_to(REPOSITORY)}, line {line}", name)
    for path in SOURCES
    for line, name in imports_of(path)
]


def test_reading_imports_sees_through_functions_and_relative_names():
    source = (
        "import bpy.types\ndef f():\n    from ..operators.press import Press\nfrom . import x\n"
    )
    assert python_imports(source, ("core",)) == [
        (1, "bpy.types"),
        (4, ".core"),
        (3, ".operators.press"),
    ]
    assert python_imports("from .. import addon", ("core",)) == [(1, ".addon")]
    assert python_imports("from ...cli import main", ("core", "devices")) == [(1, ".cli")]


def test_layers_import_only_downwards():
    assert not [
        f"{where}: {name}"
        for layer, where, name in IMPORTS
        if name.startswith(".") and name.split(".")[1] not in {layer, *LAYERS[layer]}
    ]


def test_palpate_imports_itself_only_by_relative_names():
    """Inside Blender the package is called bl_ext.<repository>.palpate."""
    names = {"palpate", *LAYERS}
    assert not [f"{where}: {name}" for _, where, name in IMPORTS if name.split(".")[0] in names]


def test_core_and_command_line_do_not_know_blender():
    assert not [
        f"{where}: {name}"
        for layer, where, name in IMPORTS
        if layer in {"core", "simulated", "cli"} and name.split(".")[0] in BLENDER
    ]


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
    assert {layer for layer, _, name in IMPORTS if name.split(".")[0] == "palpate_servo"} <= {
        "core"
    }


def test_nobody_uses_what_only_tests_have_of_the_servo_but_who_says_so():
    users = [path for path in SOURCES if "palpate_servo.harness" in path.read_text("utf-8")]
    assert users == [REPOSITORY / "core/servo/stepped.py"]


def test_names_of_modules_say_what_they_are_for():
    assert not [path for path in SOURCES if NAMES_THAT_SAY_NOTHING & set(path.stem.split("_"))]


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


RUST = sorted(CRATE.rglob("*.rs"))
PYTHON = [path for path in SOURCES if path.parent != REPOSITORY]


def place_in(rooms: list[str], file: str) -> int:
    """Return where in the written order a file's room stands: the longest line that fits it."""
    fitting = [room for room in rooms if file == room or file.startswith(f"{room}/")]
    assert fitting, f"{file} stands in no room of tests/house_rules.py"
    return rooms.index(max(fitting, key=len))


def importing_upwards(rooms: list[str], imports: dict[str, set[str]]) -> list[str]:
    return [
        f"{file} imports {other}"
        for file, others in imports.items()
        for other in sorted(others)
        if file.split("/")[0] == other.split("/")[0] or rooms is ROOMS_OF_RUST
        if place_in(rooms, other) > place_in(rooms, file)
    ]


def in_circles(imports: dict[str, set[str]]) -> list[str]:
    """Name the files that import themselves by way of others."""

    def reached(file: str) -> set[str]:
        seen: set[str] = set()
        ahead = [*imports[file]]
        while ahead:
            if (other := ahead.pop()) not in seen:
                seen.add(other)
                ahead += imports.get(other, ())
        return seen

    return [f"{file} imports itself in a circle" for file in imports if file in reached(file)]


def unknown(violations: Iterable[str]) -> list[str]:
    return sorted(violation for violation in violations if not violation.startswith(KNOWN))


def imports_among(
    files: list[Path], imported: Callable[[Path], Iterable[Path]], root: Path
) -> dict[str, set[str]]:
    """Return {file: the files that it imports}, all named from the root."""
    return {
        file.relative_to(root).as_posix(): {
            other.relative_to(root).as_posix() for other in imported(file) if other != file
        }
        for file in files
    }


RUST_IMPORTS = imports_among(RUST, rust_files_imported, CRATE)
PYTHON_IMPORTS = imports_among(PYTHON, python_files_imported, REPOSITORY)


def test_reading_rust_sees_braces_parents_and_children(tmp_path, monkeypatch):
    (tmp_path / "a").mkdir()
    for name in ("lib", "a/mod", "a/b", "a/c", "d"):
        (tmp_path / f"{name}.rs").touch()
    monkeypatch.setattr(source_imports, "CRATE", tmp_path)
    (tmp_path / "a/b.rs").write_text(
        "use crate::{d::{self, D}, a::c::C}; // use super::F;\nfn f() { super::g() }\n"
        "#[cfg(test)]\nmod tests {\n    use super::*;\n}\n"
    )
    names = [
        path.relative_to(tmp_path).as_posix() for path in rust_files_imported(tmp_path / "a/b.rs")
    ]
    assert names == ["d.rs", "d.rs", "a/c.rs", "a/mod.rs", "a/b.rs"]
    (tmp_path / "a/mod.rs").write_text("pub mod c;\nfn f() -> c::C { c::new() }\n")
    assert {*rust_files_imported(tmp_path / "a/mod.rs")} == {tmp_path / "a/c.rs"}


@pytest.mark.parametrize(
    ("rooms", "imports"),
    [(ROOMS_OF_PYTHON, PYTHON_IMPORTS), (ROOMS_OF_RUST, RUST_IMPORTS)],
    ids=["python", "rust"],
)
def test_rooms_import_only_rooms_before_them(rooms, imports):
    assert not unknown(importing_upwards(rooms, imports))


@pytest.mark.parametrize("imports", [PYTHON_IMPORTS, RUST_IMPORTS], ids=["python", "rust"])
def test_files_do_not_import_in_circles(imports):
    assert not unknown(in_circles(imports))


def every_file() -> list[Path]:
    """Return all sources written by hand: the product's, the crate's, tests' and benchmarks'."""
    python = [*PYTHON]
    for folder in ("tests", "benchmarks"):
        python += (REPOSITORY / folder).rglob("*.py")
    return [*python, *RUST, *(REPOSITORY / "native" / "tests").rglob("*.rs")]


def test_rooms_and_files_are_small():
    files = every_file()
    rooms = [file.parent.relative_to(REPOSITORY).as_posix() for file in files]
    crowded = [f"{room} holds too many" for room in set(rooms) if rooms.count(room) > MOST_FILES]
    too_long = [
        f"{name} is too long"
        for file in files
        for name in [file.relative_to(REPOSITORY).as_posix()]
        for most in [MOST_LINES_OF_TESTS if "tests" in file.parts else MOST_LINES]
        if len(file.read_text(encoding="utf-8").splitlines()) > most
    ]
    assert not unknown(crowded + too_long)


def test_tests_do_not_import_from_benchmarks():
    rooms = [room for room in (REPOSITORY / "benchmarks").iterdir() if room.is_dir()]
    scripts = {path.stem for room in rooms if room.stem != "measuring" for path in room.iterdir()}
    benchmarks = {"benchmarks", "measuring", *scripts}
    foreign = [
        f"{path.relative_to(REPOSITORY)} imports {name}"
        for path in (REPOSITORY / "tests").rglob("*.py")
        for _, name in imports_of(path)
        if name.split(".")[0] in benchmarks or name.startswith("palpate.benchmarks")
    ]
    assert not unknown(foreign)
