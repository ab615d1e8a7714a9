"""What the documentation names exists: files, links, headings, commands and their options, imports.

Read from the text alone; no command runs.
"""

from __future__ import annotations

import argparse
import ast
import importlib
import importlib.util
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from palpate.cli.main import make_parser

REPOSITORY = Path(__file__).resolve().parent.parent
PAGES = sorted(
    [
        REPOSITORY / "README.md",
        REPOSITORY / "CONTRIBUTING.md",
        *(REPOSITORY / "docs").glob("*.md"),
        *(REPOSITORY / "firmware").glob("*.md"),
    ]
)
# Benchmarks have each other and the tests, too.
OURS = ("palpate.core", "palpate.cli", "palpate.simulated")
BENCHMARKS = sorted((REPOSITORY / "benchmarks").rglob("*.py"))
FOLDERS = (
    "addon|benchmarks|cli|core|demo|docs|firmware|native|operators|release|sample_scenes|simulated|"
    "tests"
)
NAMED_FILE = re.compile(rf"(?<![\w/.-])((?:{FOLDERS})/[\w./*-]*[\w*/])")
LINK = re.compile(r"\[[^\]]*\]\(([^)\s]+)\)")
COMMAND = re.compile(r"(?<![\w-])palpate ((?:[a-z]+ ?)+)((?:(?!palpate ).)*)")
OPTION = re.compile(r"(?<![\w-])(--?[a-z][\w-]*)")


def name_of(page: Path) -> str:
    return str(page.relative_to(REPOSITORY))


def code_lines(text: str) -> Iterator[str]:
    """Lines of indented and fenced blocks, continuation lines joined, and code within lines."""
    joined = re.sub(r"\\\n\s*", " ", text)
    fenced = False
    block: list[str] = []
    for line in joined.splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or line.startswith("    "):
            # An option or more alone on a line goes on from the line before.
            if block and line.strip().startswith(("-", "[-")):
                block[-1] += " " + line.strip()
            else:
                block.append(line.strip())
        else:
            yield from block
            block = []
            yield from re.findall(r"`([^`]+)`", line)
    yield from block


def heading_anchor(heading: str) -> str:
    """As GitHub makes it."""
    words = re.sub(r"[^\w\- ]", "", heading.strip().lower())
    return words.replace(" ", "-")


def anchors(page: Path) -> set[str]:
    headings = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {heading_anchor(heading) for heading in headings}


def is_there(page: Path, target: str) -> bool:
    name, _, anchor = target.partition("#")
    found = (page.parent / name).resolve() if name else page
    return found.exists() and (not anchor or anchor in anchors(found))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_link_leads_somewhere(page):
    links = LINK.findall(page.read_text(encoding="utf-8"))
    dead = [link for link in links if "://" not in link and not is_there(page, link)]
    assert not dead


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_file_that_is_named_exists(page):
    named = set(NAMED_FILE.findall(page.read_text(encoding="utf-8")))
    missing = [name for name in named if not list(REPOSITORY.glob(name.rstrip("/")))]
    assert not missing


def tree_paths(lines: list[str]) -> list[str]:
    """Full names of the folders that a tree, indented by four, stands for."""
    found: list[str] = []
    above: list[tuple[int, str]] = []
    for line in lines:
        depth = len(line) - len(line.lstrip())
        above = [(d, name) for d, name in above if d < depth]
        found.append("".join(name for _, name in above) + line.split()[0])
        above.append((depth, line.split()[0]))
    return found


def test_the_tree_of_the_architecture_is_true():
    text = (REPOSITORY / "docs/architecture.md").read_text(encoding="utf-8")
    section = text.split("## The tree")[1].split("##")[0]
    tree = [line for line in section.splitlines() if line.startswith("    ")]
    paths = tree_paths(tree)
    assert len(paths) > 30
    assert not [path for path in paths if not (REPOSITORY / path).exists()]


def options_of(parser: argparse.ArgumentParser) -> set[str]:
    return {option for action in parser._actions for option in action.option_strings}


def subcommands(parser: argparse.ArgumentParser) -> dict[str, argparse.ArgumentParser]:
    for action in parser._actions:
        if isinstance(action, argparse._SubParsersAction):
            return dict(action.choices)
    return {}


def wrong_options(line: str) -> list[str]:
    """What a line of code asks of `palpate` that it does not have."""
    wrong = []
    for words, rest in COMMAND.findall(line):
        parser, chain = make_parser(), []
        for word in words.split():
            if word not in subcommands(parser):
                break
            parser = subcommands(parser)[word]
            chain.append(word)
        if not chain:
            continue
        known = options_of(parser).union(*map(options_of, subcommands(parser).values()))
        # What a pipe or a remark leads to is another program's.
        asked = OPTION.findall(re.split(r"[|#;]\s", rest)[0])
        wrong += [f"{' '.join(chain)} {option}" for option in asked if option not in known]
    return wrong


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_command_and_option_exists(page):
    lines = code_lines(page.read_text(encoding="utf-8"))
    # `blender -c palpate` is another program with options of its own.
    ours = [line for line in lines if "palpate " in line and "blender" not in line]
    assert not [problem for line in ours for problem in wrong_options(line)]


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_option_of_a_benchmark_exists(page):
    text = page.read_text(encoding="utf-8")
    for program, rest in re.findall(r"python ((?:benchmarks|demo)/[\w/]+\.py)([^`|\n]*)", text):
        source = (REPOSITORY / program).read_text(encoding="utf-8")
        # An option as it is written where it is declared.
        assert not [o for o in OPTION.findall(rest) if f'"{o}"' not in source], program


def test_an_option_that_does_not_exist_is_noticed():
    assert wrong_options("palpate press B.npz --att 0 0 0") == ["press --att"]
    assert not wrong_options("palpate press B.npz --at 0 0 0")


def missing_imports(source: str) -> list[str]:
    """Names that Python imports from the product and that are not there."""
    missing = []
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(OURS):
            module = importlib.import_module(str(node.module))
            missing += [
                f"{node.module}.{alias.name}"
                for alias in node.names
                if not hasattr(module, alias.name)
                and not importlib.util.find_spec(f"{node.module}.{alias.name}")
            ]
    return missing


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_example_in_python_imports_what_exists(page):
    text = page.read_text(encoding="utf-8")
    for source in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        assert not missing_imports(source)


@pytest.mark.parametrize("script", BENCHMARKS, ids=name_of)
def test_every_benchmark_imports_what_exists(script):
    """They run for minutes, seldom; what they need of the product must not go unnoticed."""
    assert not missing_imports(script.read_text(encoding="utf-8"))


@pytest.mark.parametrize("page", PAGES, ids=name_of)
def test_every_target_of_make_exists(page):
    rules = (REPOSITORY / "Makefile").read_text(encoding="utf-8")
    asked = re.findall(
        r"(?:`|^    )make ([a-z][\w-]*)", page.read_text(encoding="utf-8"), re.MULTILINE
    )
    assert not [
        target for target in asked if not re.search(rf"^{target}\b[^:=]*:", rules, re.MULTILINE)
    ]
