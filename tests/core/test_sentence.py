"""Sentences are English strings that can still be said in other languages."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from palpate.core.errors import CancelledError, PalpateError
from palpate.core.sentence import Sentence

GERMAN = {
    "{name}: {reason}; bake again": "{name}: {reason}; neu berechnen",
    "only {share:.0f} % is left": "nur {share:.0f} % sind übrig",
}


def in_german(template):
    return GERMAN.get(template, template)


@pytest.fixture
def sentence():
    reason = Sentence("only {share:.0f} % is left", share=np.float32(12.3))
    return Sentence("{name}: {reason}; bake again", name="{Hare}", reason=reason)


def test_it_is_an_english_string(sentence):
    assert sentence == "{Hare}: only 12 % is left; bake again"
    assert Sentence("without {values}") == "without {values}"


def test_it_is_said_in_another_language_with_what_stands_inside(sentence):
    assert sentence.translated(in_german) == "{Hare}: nur 12 % sind übrig; neu berechnen"
    assert Sentence("without {values}").translated(in_german) == "without {values}"


@pytest.mark.parametrize(
    "travel",
    [
        lambda sentence: Sentence.of_line(sentence.as_line()),
        lambda sentence: pickle.loads(pickle.dumps(sentence)),  # noqa: S301  our own
        copy.deepcopy,
    ],
    ids=["line", "pickle", "copy"],
)
def test_it_keeps_its_parts_on_the_way_to_another_process(sentence, travel):
    there = travel(sentence)
    assert there == sentence
    assert there.translated(in_german) == sentence.translated(in_german)


def test_a_line_of_an_older_file_is_taken_as_it_is():
    assert Sentence.of_line("the body is {thin}") == "the body is {thin}"


def test_an_error_is_its_sentence_and_may_stand_in_another():
    inner = CancelledError("only {share:.0f} % is left", share=3)
    error = PalpateError("{name}: {reason}; bake again", name="Hare", reason=inner)
    assert str(error) == "Hare: only 3 % is left; bake again"
    known = pickle.loads(pickle.dumps(error))  # noqa: S301  our own
    assert str(known) == str(error)
    assert known.sentence.translated(in_german) == "Hare: nur 3 % sind übrig; neu berechnen"
    assert PalpateError(error.sentence).sentence is error.sentence
