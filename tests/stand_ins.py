"""Stand-ins for time, tabs and threads, well-formed messages, and a reader of frames, for the live view's tests."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from pinik.viewer.protocol.packing import InstanceBlock, pack_frame
from pinik.viewer.protocol.recording import Recording
from pinik.viewer.protocol.setup import write_setup
from pinik.viewer.protocol.state import session_state
from pinik.viewer.simulation.session import Session

PATIENCE = 150.0
"""How long a test waits before it gives up [s]; a little less than pytest's own timeout."""

# A well-formed message of every type that a session handles, and the kind of each field.
GOOD = {
    "view": ({"count": 2}, {"count": "index"}),
    "method": ({"instance": 0, "method": "dls"}, {"instance": "index", "method": "name"}),
    "parameter": (
        {"instance": 3, "name": "damping", "value": 0.3},
        {"instance": "index", "name": "name", "value": "value"},
    ),
    "limits": ({"on": False}, {"on": "truth"}),
    "polish": ({"on": True}, {"on": "truth"}),
    "motion": ({"motion": "random"}, {"motion": "name"}),
    "curve": ({"curve": "knot"}, {"curve": "name"}),
    "speed": ({"value": 2.5}, {"value": "number"}),
    "iterations": ({"until_reached": False, "at_most": 3}, {"until_reached": "truth", "at_most": "count"}),
    "tolerance": ({"position": 0.01, "orientation": 0.1}, {"position": "number", "orientation": "number"}),
    "run": ({"on": True}, {"on": "truth"}),
    "look": ({"name": "axes", "on": True}, {"name": "name", "on": "truth"}),
    "step": ({}, {}),
    "step_iteration": ({"instance": 0}, {"instance": "index or null"}),
    "line_up": ({"position": [0.3, 0.1, 0.8]}, {"position": "point"}),
    "reset": ({}, {}),
    "begin_anew": ({}, {}),
    "statistics": ({"cover": "all"}, {"cover": "name"}),
    "ball": ({"index": 0, "position": [0.1, 0.2, 0.3]}, {"index": "index", "position": "point"}),
    "orientation": (
        {"index": 0, "on": True, "rpy": [0.1, 0.2, 0.3]},
        {"index": "index", "on": "truth", "rpy": "angles"},
    ),
    "free": ({"index": 0, "axes": "xy"}, {"index": "index", "axes": "axes"}),
    "ball_tolerance": (
        {"index": 0, "tolerance": [[0.01, 0.01, 0.1], 0.3]},
        {"index": "index", "tolerance": "tolerance"},
    ),
    "collisions": ({"on": True, "avoid": False}, {"on": "truth", "avoid": "truth"}),
    "add_obstacle": (
        {"kind": "box", "size": [0.1, 0.2, 0.3], "position": [0.1, 0.2, 0.3]},
        {"kind": "name", "size": "size", "position": "point"},
    ),
    "obstacle": ({"index": 0, "position": [0.1, 0.2, 0.3]}, {"index": "index", "position": "point"}),
    "obstacle_size": ({"index": 0, "size": [0.1]}, {"index": "index", "size": "size"}),
    "remove_obstacle": ({"index": 0}, {"index": "index"}),
    "effector": ({"index": 0, "mode": "pinned"}, {"index": "index", "mode": "name"}),
    "add_effector": ({"frame": "bone3"}, {"frame": "name"}),
    "pause_on_miss": ({"on": True}, {"on": "truth"}),
    "angles": (
        {"instance": None, "angles": {"bone1_x": 0.2}},
        {"instance": "instance", "angles": "joint values"},
    ),
    "paste": ({"instance": 1, "text": "bone1_x: 0.2"}, {"instance": "instance", "text": "pasted"}),
    "balls_lead": ({}, {}),
    "remove_effector": ({"index": 1}, {"index": "index"}),
}


class Clock:
    """A clock that a test advances; each reading advances it by `each` [s] as well."""

    def __init__(self, each: float = 0.0) -> None:
        self.now = 0.0
        self.each = each

    def __call__(self) -> float:
        self.now += self.each
        return self.now


class Tab:
    """A browser tab that records what it is sent."""

    def __init__(self) -> None:
        self.sent: list[str | bytes] = []

    def send(self, message: str | bytes) -> None:
        self.sent.append(message)

    def withdraw(self, messages: Collection[bytes]) -> None:
        """Whatever is sent here has arrived."""

    @property
    def kinds(self) -> list[str]:
        return [kind(message) for message in self.sent]

    def of(self, wanted: str) -> list[Any]:
        """The messages of one kind; texts are decoded."""
        found = [message for message in self.sent if kind(message) == wanted]
        return [json.loads(m, parse_constant=no_number) if isinstance(m, str) else m for m in found]

    def last(self, wanted: str) -> Any:
        return self.of(wanted)[-1]


def kind(message: str | bytes) -> str:
    """Return "frame", "shape", or the type of a text message."""
    if isinstance(message, bytes):
        return "frame" if message[:4] == b"PNKF" else "shape"
    return json.loads(message)["type"]


def no_number(word: str) -> None:
    raise AssertionError(f"{word} is not JSON")


class Later:
    """Work for other threads, which waits until the test does it."""

    def __init__(self) -> None:
        self.waiting: list[tuple[Callable[[], Any], Callable[[Any], None]]] = []

    def __call__(self, work: Callable[[], Any], then: Callable[[Any], None]) -> None:
        self.waiting.append((work, then))

    def do(self, index: int = 0) -> None:
        work, then = self.waiting.pop(index)
        try:
            result = work()
        except Exception as error:
            result = error
        then(result)

    def do_all(self) -> None:
        while self.waiting:
            self.do()


@dataclass
class Block:
    """One instance's part of a frame."""

    status: int
    position_error: float
    orientation_error: float
    time: float
    iterations: int
    joint_updates: int
    jump: float
    counted: int
    joints: NDArray[np.float32]
    sides: NDArray[np.float32]
    points: NDArray[np.float32]


@dataclass
class Frame:
    generation: int
    step: int
    balls: NDArray[np.float32]
    blocks: list[Block]


def read_frame(message: bytes) -> Frame:
    """A frame as docs/live-protocol.md lays it out."""
    assert message[:4] == b"PNKF"
    numbers = list(struct.unpack(f"<{(len(message) - 4) // 4}f", message[4:]))

    def take(count: int) -> list[float]:
        taken, numbers[:count] = numbers[:count], []
        assert len(taken) == count
        return taken

    generation, _, instances, joints, balls = (int(number) for number in take(5))
    (step,) = struct.unpack_from("<I", message, 8)
    where = np.array(take(7 * balls), dtype=np.float32).reshape(balls, 7)
    blocks = []
    for _ in range(instances):
        status, position, orientation, time, iterations, updates, jump, counted = take(8)
        blocks.append(
            Block(
                int(status),
                position,
                orientation,
                time,
                int(iterations),
                int(updates),
                jump,
                int(counted),
                np.array(take(7 * joints), dtype=np.float32).reshape(joints, 7),
                np.array(take(joints), dtype=np.float32),
                np.array(take(3 * balls), dtype=np.float32).reshape(balls, 3),
            )
        )
    assert numbers == []
    return Frame(generation, step, where, blocks)


def small_frame(
    step: int, generation: int = 1, instances: int = 1, joints: int = 2, balls: int = 1, mark: float = 0.0
) -> bytes:
    """A frame message whose figures are all `mark` and whose placements are all zero."""
    block = InstanceBlock(np.full(8, mark), np.zeros((joints, 7)), np.zeros(joints), np.zeros((balls, 3)))
    return pack_frame(generation, step, np.zeros((balls, 7)), [block] * instances)


def recorded(frames: Iterable[bytes]) -> Recording:
    """A recording of frames without configurations."""
    recording = Recording()
    for frame in frames:
        recording.add(frame, [])
    return recording


def snapshot(session: Session) -> str:
    """Everything that a message can change, as one text."""
    shown = session_state(session)
    return json.dumps(
        [
            shown,
            write_setup(session),
            [instance.q.tolist() for instance in session.instances],
            [(i.solver.name, repr(i.solver)) for i in session.instances],
            session.scores.window,
            session.summaries,
            [ball.home.tolist() for ball in session.balls],
        ]
    )
