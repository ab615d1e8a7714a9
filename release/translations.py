"""Words of the interface: those in the sources, and what translators made of them.

`addon/translations/` holds one .po file a language, which any editor for translators opens. To add
what is new in the sources to all of them, and to take out what is gone (`make translations`):

    python release/translations.py

The package holds all languages in one file that Blender's Python reads without a library.
"""

from __future__ import annotations

import ast
import json
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from babel.messages.catalog import Catalog
from babel.messages.pofile import read_po, write_po

REPOSITORY = Path(__file__).resolve().parent.parent
FOLDER = Path("addon") / "translations"
PACKAGED = FOLDER / "words.json"
# Where every text that begins like a sentence or a label is shown, and where only these are: the
# first text of such calls and of errors, and all in such tables.
SHOWING, MARKING = ("addon", "operators"), ("core", "simulated")
CALLS = {"Sentence", "reported", "shown", "Material", "_silicone", "Relaxation", "super().__init__"}
TABLES = {"EXPLANATIONS", "STAGES", "STEP_TEXTS"}
# Read by whoever types commands, in English.
COMMANDS = (
    *(
        "addon/command.py",
        "addon/command_options.py",
        "addon/blend_file.py",
        "core/mesh/read_mesh.py",
    ),
    "core/servo/haply_models.py",
    *("simulated/board", "simulated/hand", "simulated/device_process.py"),
    # Names of nodes and of their inputs, by which files know them.
    *("operators/layer/group_building.py", "operators/layer/layer_groups.py"),
)
LIKE_WORDS = re.compile(r"[A-Z][a-z]|[A-Z0-9]+ [A-Za-z]|\{\w")
# The same in every language, in Blender's own dictionary, or names in files.
UNTRANSLATED = {
    *("2DIY 2", "2DIY 3.0", "2DIY 3.1", "Dragon Skin 10", "Dragon Skin 20", "Dragon Skin 30"),
    *("Ecoflex 00-10", "Ecoflex 00-20", "Ecoflex 00-30", "Ecoflex 00-50", "Palpate"),
    *("Empty", "Format", "Group", "Height", "Material", "None", "Port", "Vertex Group"),
    *("Basis", "Body File", "Body Key", "Fingerprint", "Operator", "Palpate Softness"),
    *("Palpate Animation", "Palpate Pressers", "Palpate Probe", "Palpate Live", "Palpate Places"),
    *("Pinned", "Press at"),
    "Object Mode",
}


def languages() -> dict[str, Path]:
    """Return the file of each language, by its name in Blender: `de`."""
    return {path.stem: path for path in sorted((REPOSITORY / FOLDER).glob("*.po"))}


def catalog(path: Path) -> Catalog:
    """Read one language."""
    with path.open("rb") as file:
        return read_po(file, locale=path.stem, abort_invalid=True)


def compiled() -> str:
    """Return all languages for the package: `{language: {context: {text: translation}}}`.

    Texts without a context, which are nearly all, stand under `*`.
    """
    words: dict[str, dict[str, dict[str, str]]] = {}
    for language, path in languages().items():
        contexts = words.setdefault(language, {})
        for message in catalog(path):
            text, said = message.id, message.string
            if isinstance(text, str) and isinstance(said, str) and text and said:
                contexts.setdefault(message.context or "*", {})[text] = said
    return json.dumps(words, ensure_ascii=False, separators=(",", ":"))


def shown_sources() -> Iterator[tuple[Path, bool]]:
    """Yield each source with texts for Blender, and whether only its marked ones are shown."""
    for folder in (*SHOWING, *MARKING):
        for path in sorted((REPOSITORY / folder).rglob("*.py")):
            if not path.relative_to(REPOSITORY).as_posix().startswith(COMMANDS):
                yield path, folder in MARKING


def texts_in_sources() -> set[str]:
    """Return every text that Palpate may show in Blender, read from its sources."""
    found: set[str] = set()
    for path, marked in shown_sources():
        found |= set(texts(path.read_text(encoding="utf-8"), marked=marked))
    return found - UNTRANSLATED


def texts(source: str, *, marked: bool) -> Iterator[str]:
    """Yield the shown texts of one source: all that read like words, or only those `marked`."""
    nodes = list(ast.walk(ast.parse(source)))
    for node in nodes:
        match node:
            case ast.Call(args=[first, *_]) if is_mark(node):
                yield from filter(None, [_text(first)])
            case (
                ast.AnnAssign(target=ast.Name(name), value=ast.Dict(values=values))
                | ast.Assign(targets=[ast.Name(name)], value=ast.Dict(values=values))
            ) if name in TABLES:
                yield from map(_text, values)
    if not marked:
        # Docstrings, and what stands between the figures of an f-string.
        left_out = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
        for text in (node for node in nodes if isinstance(node, ast.JoinedStr)):
            left_out |= {id(piece) for piece in text.values}
        for node in nodes:
            if id(node) not in left_out and LIKE_WORDS.match(_text(node)):
                yield _text(node)


def is_mark(call: ast.Call) -> bool:
    """Whether the first text of a call is shown: one of CALLS, or an error for users."""
    name = ast.unparse(call.func)
    return name in CALLS or name in error_names()


@cache
def error_names() -> frozenset[str]:
    """Return the names of PalpateError and of all errors that derive from it."""
    bases = {
        node.name: {ast.unparse(base) for base in node.bases}
        for folder in MARKING
        for path in (REPOSITORY / folder).rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.ClassDef)
    }
    found, more = set(), {"PalpateError"}
    while more:
        found |= more
        more = {name for name in bases if bases[name] & found} - found
    return frozenset(found)


def update() -> None:
    """Bring all files to the texts of the sources; say how many wait for a translator."""
    shown = texts_in_sources()
    for language, path in languages().items():
        words, template = catalog(path), Catalog()
        for text in shown:
            template.add(text)
        for message in words:
            if message.context and message.id in shown:
                template.add(message.id, context=message.context)
        words.update(template, update_creation_date=False)
        with path.open("wb") as file:
            write_po(file, words, width=100, sort_output=True, ignore_obsolete=True)
        waiting = sum(not message.string or message.fuzzy for message in words if message.id)
        print(f"{path.relative_to(REPOSITORY)}: {waiting} of {len(words)} wait for {language}")


def _text(node: ast.AST) -> str:
    """The text that a node is; empty for any other node."""
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""


if __name__ == "__main__":
    update()
