"""The folder of a job that is not finished: one file for each finished chunk, written whole or not at all.

The folder is its own journal: a chunk is finished exactly if its file is there, because files appear under their name
only once all of their bytes are on the disk. A part begins with one line of JSON, with the length and the checksum of
the content that follows, and the chunk's notes.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import stat
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import IO, Any, Self

from ...errors import InputError
from ...files import FileError, followed, read_within, write_whole
from .fingerprint import as_json, differences
from .job import Job, Result

__all__ = ["Parts", "parts_folder"]

_FORMAT = 1  # raise this whenever the folder's files are written in another way
_JOB, _LOCK, _DONE = "job.json", "lock", "done.json"
_PART = re.compile(r"(\d{9})\.part")
_MOST_BYTES = 10_000_000


def parts_folder(output: Path) -> Path:
    """The folder in which the chunks of an output are kept until it is whole: beside the file, not beside a link."""
    file = followed(output)
    return file.with_name(f"{file.name}.parts")


class Parts:
    """The finished chunks of one job; a context manager, inside which no other run can work on the same folder.

    Attributes:
        folder: The folder.
        finished: The numbers of the chunks that an earlier run finished, with their notes.
        done: The record of an output that is whole already, if the earlier run ended while it removed the folder.
    """

    def __init__(self, folder: Path, job: Job, *, resume: bool) -> None:
        """Make the folder, or take over that of an earlier run.

        Args:
            folder: The folder; its parent exists.
            job: The job.
            resume: Whether to go on with what an earlier run has finished.

        Raises:
            InputError: There is a folder, and it is not to be resumed; or it belongs to a job of another fingerprint;
                or another process is at work on it.
            OSError: The folder cannot be read or written.
        """
        self.folder = folder
        self._chunks = job.chunks
        self._record = {"format": _FORMAT, "chunks": job.chunks, "fingerprint": as_json(job.fingerprint)}
        self.finished: dict[int, Mapping[str, int | float]] = {}
        self.done: Mapping[str, Any] | None = None
        # A folder without a record was left by a run that ended before its first chunk; nothing is lost in it.
        if (folder / _JOB).exists() and not resume:
            count = sum(1 for _ in self._files())
            raise InputError(
                f"{folder} holds {count} of {job.chunks} chunks of a run that was not finished; go on with it by "
                "--resume (resume=True), or delete the folder to begin anew"
            )
        folder.mkdir(exist_ok=True)
        self._lock = _locked(folder / _LOCK)
        try:
            self._take_over()
        except BaseException:
            self.close()
            raise

    def _take_over(self) -> None:
        path = self.folder / _JOB
        if path.exists():
            before = _read_json(path)
            if before.get("format") != _FORMAT or not isinstance(before.get("fingerprint"), dict):
                raise InputError(f"{path} is not the record of a job that this version of pinik can resume")
            was = before["fingerprint"] | {"chunks": before.get("chunks")}
            changed = differences(was, self._record["fingerprint"] | {"chunks": self._chunks})  # type: ignore[operator]
            if changed:
                raise InputError(
                    f"{self.folder} belongs to another run: {changed}; give what was given then, or delete the folder "
                    "to begin anew"
                )
            if (self.folder / _DONE).exists():
                self.done = _read_json(self.folder / _DONE)
        else:
            write_whole(path, json.dumps(self._record, indent=1).encode())
        for unfinished in self.folder.glob(".*.unfinished"):
            unfinished.unlink()
        for number, part in self._files():
            notes = _notes_of(part)
            if notes is None or number >= self._chunks:
                part.unlink()
            else:
                self.finished[number] = notes

    def _files(self) -> Iterator[tuple[int, Path]]:
        for path in sorted(self.folder.iterdir()):
            named = _PART.fullmatch(path.name)
            if named:
                yield int(named.group(1)), path

    def _path(self, number: int) -> Path:
        return self.folder / f"{number:09d}.part"

    def write(self, number: int, result: Result) -> None:
        """Keep a finished chunk; any thread may call this.

        Raises:
            OSError: It cannot be written, and what was finished before is still there.
        """
        content = result.content
        header = {"length": len(content), "crc32": zlib.crc32(content), "notes": dict(result.notes)}
        write_whole(self._path(number), json.dumps(header).encode() + b"\n" + content)

    def open(self, number: int) -> IO[bytes]:
        """Open a finished chunk at the beginning of its content."""
        file = self._path(number).open("rb")
        file.readline()
        return file

    def read(self, number: int) -> bytes:
        """The content of a finished chunk."""
        with self.open(number) as file:
            return file.read()

    def __len__(self) -> int:
        return self._chunks

    def __iter__(self) -> Iterator[bytes]:
        """The contents of all chunks, in order."""
        return map(self.read, range(self._chunks))

    def publish(self, output: Path, record: Mapping[str, Any]) -> None:
        """Let the output appear, which `unpublished` holds, and note what it came to.

        A link is followed. A file that exists is replaced and keeps its permissions.

        Raises:
            OSError: It cannot be put there; all finished chunks are still there.
        """
        file = followed(output)
        if file.exists():
            self.unpublished.chmod(stat.S_IMODE(file.stat().st_mode))
        os.replace(self.unpublished, file)
        write_whole(self.folder / _DONE, json.dumps(record).encode())

    @property
    def unpublished(self) -> Path:
        """Where the output is written, on the same disk as its place, before it appears there."""
        return self.folder / ".output.unfinished"

    def remove(self) -> None:
        """Remove the folder. If this is interrupted, another run finds the record and goes on with the removal."""
        for _, path in self._files():
            path.unlink()
        for name in (_JOB, _DONE, _LOCK):
            (self.folder / name).unlink(missing_ok=True)
        with contextlib.suppress(OSError):  # somebody put a file of their own there
            self.folder.rmdir()

    def close(self) -> None:
        """Let others work on the folder."""
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _locked(path: Path) -> int | None:
    """A descriptor that holds the lock, which the system releases when the process ends, however it ends."""
    try:
        import fcntl
    except ModuleNotFoundError:  # Windows
        return None
    descriptor = os.open(path, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(descriptor)
        raise InputError(f"another process is at work on {path.parent}; wait until it has ended") from None
    except OSError:  # some network file systems have no locks
        os.close(descriptor)
        return None
    return descriptor


def _read_json(path: Path) -> dict[str, Any]:
    try:
        read = json.loads(read_within(path, _MOST_BYTES, "the record of a job"))
    except (FileError, ValueError, RecursionError) as error:
        raise InputError(f"{path}: not the record of a job: {error}") from None
    if not isinstance(read, dict):
        raise InputError(f"{path}: not the record of a job")
    return read


def _notes_of(path: Path) -> dict[str, int | float] | None:
    """The notes of a chunk; None if its file is damaged."""
    try:
        with open(path, "rb") as file:
            header = json.loads(file.readline())
            content = file.read()
        notes: dict[str, int | float] = header["notes"]
        whole = header["length"] == len(content) and header["crc32"] == zlib.crc32(content)
    except (ValueError, KeyError, TypeError):
        return None
    return notes if whole and isinstance(notes, dict) else None
