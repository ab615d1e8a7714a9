"""Every text that Blender may show is there in every language, and nothing else is."""

from __future__ import annotations

import ast
import json
from string import Formatter

import pytest
import translations

LANGUAGES = translations.languages()
CONTEXTS = {None, "Operator", "Palpate"}


def calls(path):
    nodes = ast.walk(ast.parse(path.read_text(encoding="utf-8")))
    return [node for node in nodes if isinstance(node, ast.Call) and node.args]


@pytest.fixture(scope="module", params=LANGUAGES)
def words(request):
    return [message for message in translations.catalog(LANGUAGES[request.param]) if message.id]


def names(text):
    """The {names} that are filled into a text, with their formats."""
    return sorted(field[1:] for field in Formatter().parse(text) if field[1] is not None)


def test_texts_are_found_in_sources():
    source = '''"""Docstring of a module."""
label = "Make Soft"
text = f"Never {label} found"
raise PalpateError("a file is missing")
STEP_TEXTS = {"start": "starting"}
'''
    marked = {"a file is missing", "starting"}
    assert set(translations.texts(source, marked=False)) == {"Make Soft", *marked}
    assert set(translations.texts(source, marked=True)) == marked


def test_what_is_filled_into_a_text_is_given_by_name():
    """An f-string is English for ever."""
    found = [
        f"{path.name}, line {call.lineno}"
        for path, _ in translations.shown_sources()
        for call in calls(path)
        if translations.is_mark(call) and isinstance(call.args[0], ast.JoinedStr)
    ]
    assert not found


def test_reports_and_tooltips_are_in_the_users_language():
    english = [
        f"{path.name}, line {call.lineno}"
        for path, marked in translations.shown_sources()
        for call in calls(path)
        if not marked and ast.unparse(call.func).endswith((".report", ".poll_message_set"))
        if not ast.unparse(call.args[-1]).startswith(("reported(", "shown(", "', '.join("))
    ]
    assert not english


def test_there_are_hundreds_of_texts():
    assert len(translations.texts_in_sources()) > 400


def test_no_text_is_missing_and_none_is_unused(words):
    shown = translations.texts_in_sources()
    known = {message.id for message in words if message.context is None}
    assert not shown - known
    assert not {message.id for message in words} - shown


def test_every_text_is_translated(words):
    assert not [message.id for message in words if not message.string or message.fuzzy]


def test_translations_fill_in_the_same_names(words):
    assert not [message.id for message in words if names(message.id) != names(message.string)]


def test_contexts_are_those_that_the_extension_registers(words):
    assert {message.context for message in words} <= CONTEXTS


def test_the_package_holds_all_translations():
    packaged = json.loads(translations.compiled())
    assert packaged.keys() == LANGUAGES.keys()
    assert packaged["de"]["*"]["Make Soft"] == "Weich machen"
    assert packaged["ja"]["Palpate"]["Depth"] != packaged["ja"]["*"]["Depth"]
