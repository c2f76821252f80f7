"""Parts of pinik that need more packages than it installs by itself, and the install line that brings them."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from .errors import PinikError

__all__ = ["MissingExtraError", "needed_by"]

_INSTALLED_AS = {
    "PIL": "pillow",
    "umsgpack": "u-msgpack-python",
    "collada": "pycollada",
    "rerun": "rerun-sdk",
    "fast_simplification": "fast-simplification",
}


class MissingExtraError(PinikError, ImportError):
    """A part of pinik was used whose packages are not installed; the message names the line that installs them."""


@contextmanager
def needed_by(part: str, extra: str) -> Iterator[None]:
    """Import the packages of an optional part inside this block.

    Args:
        part: What needs them, such as "the live view".
        extra: The extra of pyproject.toml that installs them.

    Raises:
        MissingExtraError: A package is not installed.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        package = (error.name or "").split(".")[0]
        if package in ("", "pinik"):
            raise
        name = _INSTALLED_AS.get(package, package)
        raise MissingExtraError(f"{part} needs {name}: pip install 'pinik[{extra}]'", name=error.name) from None
