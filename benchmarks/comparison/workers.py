"""A peer at work in a process of its own, which is spoken to by JSON lines over pipes."""

from __future__ import annotations

import json
import os
import subprocess
import tempfile
import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
from adapters.wire import pack, unpack
from numpy.typing import NDArray

from .arms import Arm
from .peer import Peer

__all__ = ["Worker", "WorkerError"]

ADAPTERS = Path(__file__).resolve().parent.parent / "adapters"
LOAD_AT_MOST = 300.0  # [s]
SOLVE_AT_MOST = 120.0  # [s] beyond the time that the worker was given


class WorkerError(RuntimeError):
    """A peer could not do what it was asked; the message says why."""


class Worker:
    """One peer with one arm loaded; a context manager that ends the process.

    Attributes:
        versions: The versions of the peer's packages.
    """

    def __init__(
        self,
        python: Path,
        peer: Peer,
        arm: Arm,
        warm_up: tuple[Sequence[pinocchio.SE3], NDArray[np.float64]],
        core: int | None,
    ) -> None:
        self._log = tempfile.TemporaryFile("w+")  # noqa: SIM115 (`close` closes it)
        file, class_name = peer.adapter
        self._process = subprocess.Popen(
            [str(python), str(ADAPTERS / "worker.py"), str(ADAPTERS / file), class_name],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._log,
            text=True,
            env=_environment(peer),
        )
        try:
            reply = self._ask(
                {
                    "load": arm.as_json(),
                    "options": peer.options,
                    "packages": peer.packages,
                    "core": core,
                    "warm_up": [_packed(warm_up[0]), pack(warm_up[1])],
                },
                LOAD_AT_MOST,
            )
        except WorkerError:
            self.close()
            raise
        self.versions: dict[str, str] = reply["versions"]

    def __enter__(self) -> Worker:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def solve(
        self,
        targets: Sequence[pinocchio.SE3],
        starts: NDArray[np.float64] | None,
        *,
        carry: bool,
        seconds: float,
    ) -> dict[str, Any]:
        """Answers and times of the first targets, as many as fit into the time [s].

        Args:
            targets: Where the tip should be.
            starts: Joint values to start from; with `carry` the first one, or None to go on from the last answer.
            carry: Whether each start is the last answer.
            seconds: What the peer may take.
        """
        request = {
            "solve": _packed(targets),
            "starts": None if starts is None else pack(starts),
            "carry": carry,
            "seconds": seconds,
        }
        reply = self._ask(request, seconds + SOLVE_AT_MOST)
        return {**reply, "answers": unpack(reply["answers"])}

    def close(self) -> None:
        """End the process."""
        self._process.kill()
        self._process.communicate()
        self._log.close()

    def _ask(self, request: dict[str, Any], at_most: float) -> dict[str, Any]:
        assert self._process.stdin is not None
        assert self._process.stdout is not None
        timer = threading.Timer(at_most, self._process.kill)
        timer.start()
        try:
            self._process.stdin.write(json.dumps(request) + "\n")
            self._process.stdin.flush()
            line = self._process.stdout.readline()
        except BrokenPipeError:
            line = ""
        finally:
            timed_out = not timer.is_alive()
            timer.cancel()
        if not line:
            raise WorkerError(f"no answer within {at_most:g} s" if timed_out else self._last_words())
        reply: dict[str, Any] = json.loads(line)
        if "error" in reply:
            raise WorkerError(reply["error"])
        return reply

    def _last_words(self) -> str:
        status = self._process.wait()
        self._log.seek(0)
        said = self._log.read().strip().splitlines()
        return f"its process ended with status {status}" + (f": {said[-1]}" if said else "")


def _packed(targets: Sequence[pinocchio.SE3]) -> dict[str, Any]:
    return pack([target.homogeneous for target in targets])


def _environment(peer: Peer) -> dict[str, str]:
    """The variables of this process; what PYTHONPATH names is not for an environment of a peer's own."""
    return {name: value for name, value in os.environ.items() if name != "PYTHONPATH" or not peer.requirements}
