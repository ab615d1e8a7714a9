"""Sentences for users, translatable after they were filled in."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from string import Formatter
from typing import Any, Self, TypeAlias

import numpy as np

LONGEST_LINE = 10_000
# Thousands, digits and kind; no width.
USUAL_FORMAT = re.compile(r",?(\.\d)?[defgs%]?")

Value: TypeAlias = str | int | float


class Sentence(str):
    """English text that keeps its template and values; otherwise a plain string.

    Sentences and errors may be values of another:

    >>> edited = Sentence("the shape of {name} was edited", name="Hare")
    >>> Sentence("{reason}; press Make Soft", reason=edited)
    'the shape of Hare was edited; press Make Soft'

    Attributes
    ----------
    template : English with {names}, formats included; what translators see.
    values : text, numbers or sentences, by name.
    """

    __slots__ = ("template", "values")
    template: str
    values: dict[str, Value]

    def __new__(cls, template: str, /, **values: object) -> Self:
        """Fill in; a template without values stays as it is, also with braces."""
        plain = {name: _plain(value) for name, value in values.items()}
        text = super().__new__(cls, template.format(**plain) if plain else template)
        text.template, text.values = template, plain
        return text

    def translated(self, translate: Callable[[str], str]) -> str:
        """The sentence with its template, and those of its values, mapped by ``translate``."""
        values = {
            name: value.translated(translate) if isinstance(value, Sentence) else value
            for name, value in self.values.items()
        }
        template = translate(self.template)
        return template.format(**values) if values else template

    def as_line(self) -> str:
        """Line for a file or another process; inverse of :meth:`of_line`."""
        return json.dumps(_parts(self))

    @classmethod
    def of_line(cls, line: str) -> Self:
        """Sentence from a line of :meth:`as_line`; any other line is plain text.

        The line may come with a stranger's file: a template that asks for more than its values in
        usual formats, such as their attributes or a billion blanks, is plain text, too.
        """
        if not line.startswith("["):
            return cls(line)
        try:
            return cls._of_parts(*json.loads(line[:LONGEST_LINE]))
        except (
            ValueError,
            TypeError,
            LookupError,
            AttributeError,
            ArithmeticError,
            RecursionError,
        ):
            return cls(line[:LONGEST_LINE])

    @classmethod
    def _of_parts(cls, template: str, values: dict[str, Any]) -> Self:
        known = {
            name: cls._of_parts(*value) if isinstance(value, list) else value
            for name, value in values.items()
        }
        if not isinstance(template, str):
            raise TypeError(f"{template!r} is no text")
        if not known:
            return cls(template)
        for _, name, form, conversion in Formatter().parse(template):
            if name is None:
                continue
            if name not in known or conversion or not USUAL_FORMAT.fullmatch(form or ""):
                raise ValueError(f"{template!r} is no sentence's")
            if not isinstance(known[name], str | int | float):
                raise TypeError(f"{name} is neither text nor a number")
        return cls(template, **known)


def _parts(sentence: Sentence) -> list[Any]:
    values = {
        name: _parts(value) if isinstance(value, Sentence) else value
        for name, value in sentence.values.items()
    }
    return [sentence.template, values]


def _plain(value: object) -> Value:
    """Value for JSON: an error's sentence, a Python number, or text."""
    if isinstance(value, BaseException) and value.args and isinstance(value.args[0], Sentence):
        return value.args[0]
    if isinstance(value, np.generic):
        value = value.item()
    return value if isinstance(value, str | int | float) else str(value)
