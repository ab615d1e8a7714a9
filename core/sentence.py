"""Sentences for users that can be said in other languages after they were filled in."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any, Self, TypeAlias

import numpy as np

Value: TypeAlias = str | int | float


class Sentence(str):
    """English text that remembers its template and what was filled in.

    It is a plain string to whoever only reads it. Sentences and errors may be values of another:

    >>> edited = Sentence("the shape of {name} was edited", name="Hare")
    >>> Sentence("{reason}; press Make Soft", reason=edited)
    'the shape of Hare was edited; press Make Soft'

    Attributes
    ----------
    template : English with {names}, formats included; what translators see.
    values : what stands for the names: text, numbers or sentences.
    """

    __slots__ = ("template", "values")
    template: str
    values: dict[str, Value]

    def __new__(cls, template: str, /, **values: object) -> Self:
        """Fill in; a template without values is taken as it is, also with braces."""
        plain = {name: _plain(value) for name, value in values.items()}
        text = super().__new__(cls, template.format(**plain) if plain else template)
        text.template, text.values = template, plain
        return text

    def retold(self, tell: Callable[[str], str]) -> str:
        """The sentence in the language of ``tell``, which translates a template."""
        values = {
            name: value.retold(tell) if isinstance(value, Sentence) else value
            for name, value in self.values.items()
        }
        return tell(self.template).format(**values) if values else tell(self.template)

    def as_line(self) -> str:
        """A line for a file or another process, from which :meth:`of_line` makes it again."""
        return json.dumps(_parts(self))

    @classmethod
    def of_line(cls, line: str) -> Self:
        """The sentence of a line; a line that is not of :meth:`as_line` is taken as it is."""
        return cls._of_parts(*json.loads(line)) if line.startswith("[") else cls(line)

    @classmethod
    def _of_parts(cls, template: str, values: dict[str, Any]) -> Self:
        whole = {
            name: cls._of_parts(*value) if isinstance(value, list) else value
            for name, value in values.items()
        }
        return cls(template, **whole)


def _parts(sentence: Sentence) -> list[Any]:
    values = {
        name: _parts(value) if isinstance(value, Sentence) else value
        for name, value in sentence.values.items()
    }
    return [sentence.template, values]


def _plain(value: object) -> Value:
    """What JSON can keep: an error's sentence, a number of Python's own, or its text."""
    if isinstance(value, BaseException) and value.args and isinstance(value.args[0], Sentence):
        return value.args[0]
    if isinstance(value, np.generic):
        value = value.item()
    return value if isinstance(value, str | int | float) else str(value)
