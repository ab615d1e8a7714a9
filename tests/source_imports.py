"""What a source file of Palpate imports, read from its text: Python and Rust."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
CRATE = REPOSITORY / "native" / "src"


def python_imports(source: str, package: tuple[str, ...]) -> list[tuple[int, str]]:
    """Return (line, dotted name) of every import; those of Palpate itself begin with a dot.

    `package` is where the file stands: `("core", "servo")` for core/servo/link.py. Imports inside
    functions and under TYPE_CHECKING count.
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
    """Return `python_imports` of a file of the repository."""
    package = path.relative_to(REPOSITORY).parent.parts
    return python_imports(path.read_text(encoding="utf-8"), package)


def python_files_imported(path: Path) -> Iterator[Path]:
    """Yield the files of Palpate that a Python file imports, also `from package import module`."""
    package = path.relative_to(REPOSITORY).parent
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.ImportFrom) or node.level == 0:
            continue
        base = REPOSITORY / [package, *package.parents][node.level - 1]
        base = base.joinpath(*(node.module or "").split(".")) if node.module else base
        for name in (alias.name for alias in node.names):
            inside = base / f"{name}.py", base / name / "__init__.py"
            whole = base.with_suffix(".py"), base / "__init__.py"
            yield next(file for file in (*inside, *whole) if file.is_file())


def rust_file(names: tuple[str, ...]) -> Path:
    """Return the file of the module that a path such as ("body", "tree", "Tree") leads into."""
    for end in range(len(names), 0, -1):
        module = CRATE.joinpath(*names[:end])
        for file in (module.with_suffix(".rs"), module / "mod.rs"):
            if file.is_file():
                return file
    return CRATE / "lib.rs"


def module_of(path: Path) -> tuple[str, ...]:
    """Return the module's names: ("device", "link") for native/src/device/link/mod.rs."""
    names = path.relative_to(CRATE).with_suffix("").parts
    return names[:-1] if names[-1] in {"mod", "lib"} else names


def rust_files_imported(path: Path) -> Iterator[Path]:
    """Yield the files of the crate that a Rust file names, also inside functions and its tests."""
    module = module_of(path)
    text = re.sub(r"//[^\n]*", "", path.read_text(encoding="utf-8"))
    tests = re.search(r"#\[cfg\(test\)\]\s*mod \w+ \{", text)
    inline_tests = tests.start() if tests else len(text)
    children = re.findall(r"\bmod (\w+);", text)
    starts = "|".join(["crate", "super", "self", *children])
    for match in re.finditer(rf"(?<![\w:])({starts})::", text):
        first = match[1]
        if first == "super":
            # A test module inside a file has this file for its parent.
            base = module if match.start() > inline_tests else module[:-1]
        elif first == "crate":
            base = ()
        else:
            base = module if first == "self" else (*module, first)
        for names in _paths(text[match.end() :]):
            higher = sum(name == "super" for name in names)
            yield rust_file((*base[: len(base) - higher], *names[higher:]))


def _paths(text: str) -> list[tuple[str, ...]]:
    """Return the paths that a text begins with: `a::{self, b::C}` is a and a::b::C."""
    head = re.match(r"((?:\w+::)*)", text)
    assert head is not None
    names = tuple(head[1].split("::")[:-1])
    rest = text[head.end() :]
    if not rest.startswith("{"):
        last = re.match(r"\w+", rest)
        return [(*names, last[0]) if last else names]
    found, depth, begin = [], 0, 1
    for place, letter in enumerate(rest):
        depth += (letter == "{") - (letter == "}")
        if (letter == "," and depth == 1) or depth == 0:
            if item := rest[begin:place].strip():
                found += [(*names, *inner) for inner in _paths(item)]
            begin = place + 1
        if depth == 0:
            break
    return found
