"""The one exception that is meant for a person to read."""

from .sentence import Sentence


class PalpateError(Exception):
    """Something the user can act on.

    The message is one line and names the thing, the reason and the remedy. The command line shows
    it as it is; Blender translates its template, so what differs is given by name:

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
    """A body file that cannot be used. A new bake replaces it."""
