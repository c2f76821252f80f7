"""Where the answers of a job go: to a file that appears once it is whole, or to a stream."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import BinaryIO

from ..errors import InputError
from ..files import check_writable, is_special
from .jobs.job import Job, Runner, Tally
from .jobs.parts import Parts
from .jobs.run import OnProgress, run, stream
from .tables.formats import FORMATS, format_of
from .tables.table import Column

__all__ = ["AnswersGiven", "Delivery"]

AnswersGiven = str | os.PathLike[str] | BinaryIO
"""The path of a file, or an open binary stream."""


@dataclass(frozen=True)
class Delivery:
    """Where the answers go.

    Attributes:
        output: The file, or the stream. Devices and pipes are written as streams.
        form: The name of the format.
        resume: Whether to go on with an earlier run.
    """

    output: Path | BinaryIO
    form: str
    resume: bool

    @classmethod
    def of(cls, output: AnswersGiven, form: str | None, resume: bool) -> Delivery:
        """Check where the answers are to go.

        Args:
            output: The file, or a stream.
            form: The name of the format; by the ending of the file, and CSV for a stream, when None.
            resume: Whether to go on with an earlier run.

        Raises:
            InputError: The ending tells no format, or a stream is to be resumed.
            UnknownNameError: There is no such format.
            OSError: The file cannot be written.
        """
        if isinstance(output, (str, os.PathLike)):
            path = Path(output).expanduser()
            form = format_of(path, form)
            check_writable(path)
            own, is_stream = cls(path, form, resume), is_special(path)
        else:
            own, is_stream = cls(output, format_of(Path(), form or "csv"), resume), True
        if resume and is_stream:
            raise InputError("must be False for a stream, of which nothing is kept", argument="resume")
        return own

    def check_not(self, targets: Path) -> None:
        """Check that the answers do not take the place of the targets; InputError if they would."""
        if isinstance(self.output, Path) and self.output.exists() and self.output.samefile(targets):
            raise InputError("is the file of the targets, which would be lost", argument="output")

    def run(self, job: Job, columns: Sequence[Column], runner: Runner, on_progress: OnProgress | None) -> Tally:
        """Work on a job, and deliver what it comes to."""
        if isinstance(self.output, Path) and is_special(self.output):
            with self.output.open("wb") as opened:
                return replace(self, output=opened).run(job, columns, runner, on_progress)
        writer = FORMATS[self.form].writer

        def assemble(parts: Parts, file: BinaryIO) -> None:
            writer.assemble(columns, parts, file)

        if isinstance(self.output, Path):
            return run(job, self.output, assemble, runner, resume=self.resume, on_progress=on_progress)
        output = self.output
        if writer.streams:
            output.write(writer.start(columns))
            tally = stream(job, lambda content: _put(output, content), runner, on_progress=on_progress)
        else:
            with tempfile.TemporaryDirectory(prefix="pinik-") as folder:
                whole = Path(folder) / "answers"
                tally = run(job, whole, assemble, runner, on_progress=on_progress)
                with whole.open("rb") as file:
                    shutil.copyfileobj(file, output)
        output.flush()
        return tally


def _put(output: BinaryIO, content: bytes) -> None:
    output.write(content)
    output.flush()
