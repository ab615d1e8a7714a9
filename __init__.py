"""Palpate: soft props that can be touched at 1 kHz.

Blender's door. Nothing here imports bpy before Blender calls :func:`register`, so that tests and
notebooks import the same package as ``palpate``.
"""


def register() -> None:
    """Add Palpate to Blender."""
    from . import addon

    addon.register()


def unregister() -> None:
    """Take Palpate out of Blender, ending whatever it is doing."""
    from . import addon

    addon.unregister()
