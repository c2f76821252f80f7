"""Where pinik keeps what it can compute again: the user's cache folder."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from .files import write_whole

__all__ = ["cache_folder", "digest", "keep"]


def cache_folder(part: str) -> Path | None:
    """The folder for one part in pinik's cache folder, or in PINIK_CACHE_DIR if that is set.

    None if the user has no home folder, or if platformdirs, which knows where it is, is not installed; then nothing is
    kept.
    """
    chosen = os.environ.get("PINIK_CACHE_DIR")
    if chosen:
        return Path(chosen).absolute() / part
    try:
        import platformdirs
    except ModuleNotFoundError:
        return None
    folder = Path(platformdirs.user_cache_dir("pinik", appauthor=False)) / part
    return folder if folder.is_absolute() else None


def digest(*pieces: bytes) -> str:
    """The SHA-256 of several pieces, whose boundaries count."""
    from hashlib import sha256  # it loads OpenSSL, which few runs need

    whole = sha256()
    for piece in pieces:
        whole.update(len(piece).to_bytes(8, "little"))
        whole.update(piece)
    return whole.hexdigest()


def keep(path: Path, content: bytes) -> None:
    """Write a file of the cache, and its folder if need be.

    Raises:
        OSError: It cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    if os.path.lexists(path) and not stat.S_ISREG(path.lstat().st_mode):
        path.unlink()  # for a pipe or a device would be written to, and a pipe would wait for a reader
    write_whole(path, content)
