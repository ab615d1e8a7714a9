"""Exceptions for users to read."""

from .sentence import Sentence


class PalpateError(Exception):
    """Error that the user can act on.

    The message is one line and names the thing, the reason and the remedy. Values are given by name
    since Blender translates the template:

    >>> PalpateError("{file}: damaged; bake again", file="hare.npz")
    PalpateError('hare.npz: damaged; bake again')
    """

    def __init__(self, template: str, /, **values: object) -> None:
        self.sentence: Sentence = (
            template if isinstance(template, Sentence) else Sentence(template, **values)
        )
        super().__init__(self.sentence)


class CancelledError(PalpateError):
    """The user asked to stop; nothing was kept."""


class BodyFileError(PalpateError):
    """Unusable body file. A new bake replaces it."""
