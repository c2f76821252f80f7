"""Files: read if they are regular ones of a bounded size, and written whole or not at all."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from pathlib import Path

__all__ = ["FileError", "check_writable", "followed", "is_special", "megabytes", "read_within", "write_whole"]


# So that opening a pipe that nobody writes to does not wait; Windows has no such flag, and no such pipes.
_WITHOUT_WAITING = getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0) | getattr(os, "O_CLOEXEC", 0)


class FileError(Exception):
    """A file cannot be read; the message says why, without the file's name."""


def read_within(path: Path, most: int, what: str, *, streams: bool = False) -> bytes:
    """The contents of a regular file.

    Args:
        path: The file.
        most: The largest size [bytes].
        what: What the file should be, for messages: "a URDF file".
        streams: Whether streams that are open already are read too, such as "<(xacro ...)" or "/dev/stdin".

    Raises:
        FileError: There is no such file, it is no regular file, it is larger, or it cannot be read.
    """
    waits = streams and _is_open_already(path)
    try:
        descriptor = os.open(path, os.O_RDONLY | (0 if waits else _WITHOUT_WAITING))
        with open(descriptor, "rb") as file:
            kind = os.fstat(descriptor).st_mode
            if stat.S_ISDIR(kind):
                raise FileError(f"this is a directory, not {what}")
            if not (stat.S_ISREG(kind) or waits):
                raise FileError(f"this is a pipe or a device, not {what}")
            contents = file.read(most + 1)
    except FileNotFoundError:
        raise FileError("there is no such file") from None
    except (OSError, ValueError) as error:
        if os.path.isdir(path):
            raise FileError(f"this is a directory, not {what}") from None
        raise FileError(f"the file cannot be read: {getattr(error, 'strerror', None) or error}") from None
    if len(contents) > most:
        raise FileError(f"larger than {megabytes(most)}, too large for {what}")
    return contents


def megabytes(size: int) -> str:
    """A size in bytes as text."""
    return f"{size // 1024**2} MB" if size >= 1024**2 else f"{size // 1024} KB"


def _is_open_already(path: Path) -> bool:
    return os.path.abspath(path).startswith(("/dev/fd/", "/proc/self/fd/", "/dev/stdin"))


def check_writable(path: Path) -> None:
    """Check that `write_whole` can write a file here, before time is spent on its content.

    Raises:
        OSError: There is no such folder, it cannot be written, or the path is a folder.
    """
    target = followed(path)
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, "this is a folder", str(path))
    if not target.parent.is_dir():
        raise FileNotFoundError(errno.ENOENT, "no such folder", str(path))
    place = target if is_special(target) else target.parent
    if not _may_write(place) or (target.exists() and not _may_write(target)):
        raise PermissionError(errno.EACCES, "no permission to write it", str(path))


def write_whole(path: str | os.PathLike[str], content: bytes) -> None:
    """Write a file in one step: whatever happens meanwhile, it holds either all of `content` or what it held before.

    A link is followed. Devices and pipes, which cannot be replaced, are written directly.

    Args:
        path: The file; one that exists is replaced and keeps its permissions.
        content: All of its bytes.

    Raises:
        OSError: The file cannot be written.
    """
    target = followed(Path(path))
    if is_special(target):
        target.write_bytes(content)
        return
    if target.is_dir():
        raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
    mode = stat.S_IMODE(target.stat().st_mode) if target.exists() else None
    if mode is not None and not _may_write(target):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
    unfinished = target.with_name(f".{os.urandom(8).hex()}.unfinished")
    try:
        with open(_new(unfinished, path), "wb") as file:
            file.write(content)
            file.flush()
            if mode is not None:
                os.fchmod(file.fileno(), mode)
            os.fsync(file.fileno())
        os.replace(unfinished, target)
    except BaseException:
        with contextlib.suppress(OSError):
            os.unlink(unfinished)
        raise


def _new(unfinished: Path, path: str | os.PathLike[str]) -> int:
    """Open a new file to write; an error names the file that it stands for."""
    try:
        return os.open(unfinished, os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_CLOEXEC, 0o666)
    except OSError as error:
        raise OSError(error.errno, error.strerror, os.fspath(path)) from None


def _may_write(path: Path) -> bool:
    """Whether this process may write here as the user it acts as, which in a setuid program is not the real one."""
    return os.access(path, os.W_OK, effective_ids=os.access in os.supports_effective_ids)


def followed(path: Path) -> Path:
    """The file itself, where the path is a link to it."""
    if not path.is_symlink():
        return path
    with contextlib.suppress(FileNotFoundError):  # a link to a file that is still to be made
        path.stat()  # a link to itself is an OSError
    # The link of an open pipe, such as /dev/fd/63 of ">(gzip)", leads to a name that is in no folder.
    return path if is_special(path) else path.resolve()


def is_special(path: Path) -> bool:
    """Whether there is something that is neither a file nor a folder, such as a device or a pipe."""
    return path.exists() and not path.is_file() and not path.is_dir()
