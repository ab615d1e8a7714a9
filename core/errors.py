"""The one exception that is meant for a person to read."""


class PalpateError(Exception):
    """Something the user can act on.

    The message is one line and names the thing, the reason and the remedy; command
    line, panel and report show it as it is.
    """


class CancelledError(PalpateError):
    """The user asked to stop; nothing was kept."""


class BodyFileError(PalpateError):
    """A body file that cannot be used. A new bake replaces it."""
