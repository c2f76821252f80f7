"""The live view without its sockets: one session, the tabs that watch it, and what each of them is sent."""

from __future__ import annotations

import csv
import io
import json
import time
from collections import deque
from collections.abc import Callable
from typing import Any, Protocol

from ...errors import InputError, PinikError
from ...robot import Robot
from ..protocol.frames import FrameMaker
from ..protocol.messages import apply, checked, parse, text, whole_number
from ..protocol.recording import Recording, animation_page
from ..protocol.robots import RobotMenu
from ..protocol.setup import Setup, apply_setup, read_setup, write_setup
from ..protocol.state import hello_message, session_state
from ..simulation.session import Session
from .scene import Shapes, robot_message
from .shape_cache import shapes_of

__all__ = ["Later", "Show", "Tab"]

_STATES_PER_SECOND = 4
_LONGEST_ERROR = 400  # characters: what a message holds is repeated in its error
_FRAMES_UNDER_WAY = 2  # that a tab has not answered yet; more would only queue up in a slow one

_FIGURES = ("steps", "mean_time_s", "mean_iterations", "mean_joint_updates", "efficiency", "mean_error_m",
            "largest_jump_rad_or_m")  # fmt: skip

Later = Callable[[Callable[[], Any], Callable[[Any], None]], None]
"""later(work, then): do `work` elsewhere, then call `then` with what it returned, or with the exception it raised."""


class Tab(Protocol):
    """One browser tab."""

    def send(self, message: str | bytes) -> None:
        """Give a message on its way, in order."""


class _Seat:
    """What is known of one tab: how many frames it has not answered, and what waits for it to do so."""

    def __init__(self) -> None:
        self.under_way = 0
        self.frame_waits = False
        self.state_waits = False

    @property
    def is_late(self) -> bool:
        """Whether anything more would only queue up."""
        return self.under_way >= _FRAMES_UNDER_WAY


class Show:
    """Steps the session, tells every tab what changed, and does what tabs ask.

    Attributes:
        session: The session that is shown; another one after another robot was chosen.
        recording: The last seconds, as frames.
    """

    def __init__(
        self,
        session: Session,
        later: Later,
        version: str = "",
        clock: Callable[[], float] = time.perf_counter,
    ) -> None:
        self.session = session
        self.recording = Recording()
        self._menu = RobotMenu(session.robot)
        self._later = later
        self._clock = clock
        self._seats: dict[Tab, _Seat] = {}
        self._hello = hello_message(version, session.methods, self._menu.own_names)
        self._generation = 0
        self._loading: str | None = None
        self._request = 0  # the newest that asked for a robot
        self._ticks: deque[float] = deque(maxlen=61)
        self._change_session(session)

    def _change_session(self, session: Session) -> None:
        self.session = session
        self._generation += 1
        generation = self._generation
        self._robot = robot_message(session.robot, generation)
        self._shapes: Shapes | None = None
        self._waits_for_shapes = True
        self._maker = FrameMaker(session.robot, generation)
        self._start_anew()
        self._broadcast(json.dumps(self._robot))
        self._send_state()
        self._later(lambda: shapes_of(session.robot), lambda shapes: self._take_shapes(generation, shapes))

    def _start_anew(self) -> None:
        """The frames so far tell of other instances."""
        self.recording.clear()
        self._recorded_step = -1
        self._frame = self._maker.frame(self.session)
        self._frame_due = self._state_due = True
        self._state_sent = self._clock()

    def _take_shapes(self, generation: int, shapes: Shapes | BaseException) -> None:
        if isinstance(shapes, BaseException):
            shapes = Shapes((), (), (f"the shapes cannot be shown: {shapes}",))
        if generation == self._generation:
            self._shapes = shapes
            self._waits_for_shapes = False
            for message in self._shape_messages():
                self._broadcast(message)

    def _shape_messages(self) -> list[str | bytes]:
        if self._shapes is None:
            return []
        return [*self._shapes.commands, json.dumps(self._shapes.message(self._generation))]

    # Tabs

    def join(self, tab: Tab) -> None:
        """A tab came: tell it everything."""
        for message in (self._hello, self._robot, self.state()):
            tab.send(json.dumps(message))
        for shape in self._shape_messages():
            tab.send(shape)
        seat = self._seats[tab] = _Seat()
        self._offer_frame(tab, seat)

    def leave(self, tab: Tab) -> None:
        """A tab went."""
        self._seats.pop(tab, None)

    def receive(self, tab: Tab, message_text: str) -> None:
        """Do what a tab asks; where that cannot be, tell it why."""
        try:
            message = parse(message_text)
            if message["type"] == "drawn":
                checked("drawn", message, {"step": whole_number})
                self._drawn(tab)
            else:
                self.do(message)
        except PinikError as error:
            tab.send(_notice(str(error)))

    def _drawn(self, tab: Tab) -> None:
        seat = self._seats.get(tab)
        if seat is None or seat.under_way == 0:
            return
        seat.under_way -= 1
        if seat.state_waits:
            self._offer_state(tab, seat, json.dumps(self.state()))
        if seat.frame_waits:
            self._offer_frame(tab, seat)

    def _offer_frame(self, tab: Tab, seat: _Seat) -> None:
        """Send the newest frame, or let it wait until the tab has answered an older one."""
        seat.frame_waits = seat.is_late
        if not seat.is_late:
            seat.under_way += 1
            tab.send(self._frame)

    def _offer_state(self, tab: Tab, seat: _Seat, state: str) -> None:
        seat.state_waits = seat.is_late
        if not seat.is_late:
            tab.send(state)

    def _broadcast(self, message: str | bytes) -> None:
        for tab in self._seats:
            tab.send(message)

    # Time

    def tick(self) -> None:
        """A 60th of a second has passed: step, and send what is due.

        Until a robot that somebody watches has its shapes, or somebody asks for something, it stands still: the
        processors are needed for reading them.
        """
        if not (self._waits_for_shapes and self._seats) and self.session.tick():
            self._ticks.append(self._clock())
            self._frame_due = True
        else:
            self._ticks.clear()
        if self._frame_due:
            self._send_frame()
        often_enough = self._clock() - self._state_sent >= 1.0 / _STATES_PER_SECOND
        if self._state_due or (self.session.running and often_enough):
            self._send_state()

    def _send_frame(self) -> None:
        self._frame_due = False
        self._frame = self._maker.frame(self.session)
        if self.session.steps != self._recorded_step:  # a ball moved between two steps is none of its own
            self._recorded_step = self.session.steps
            self.recording.add(self._frame, self._clock())
        for tab, seat in self._seats.items():
            self._offer_frame(tab, seat)

    def _send_state(self) -> None:
        self._state_due = False
        self._state_sent = self._clock()
        if self._seats:
            state = json.dumps(self.state())
            for tab, seat in self._seats.items():
                self._offer_state(tab, seat, state)

    # What is asked

    def do(self, message: dict[str, Any]) -> None:
        """Do what a message says.

        Raises:
            InputError, UnknownNameError: It cannot be done, and nothing has changed; of a set-up the parts before the
                faulty one are done.
        """
        self._waits_for_shapes = False
        match message["type"]:
            case "robot":
                fields = checked("robot", message, {"name": text, "root": text})
                self._load(fields["name"], fields["root"], {})
            case "setup":
                self._set_up(read_setup(checked("setup", message, {"setup": _long_text})["setup"]))
            case kind:
                motion = self.session.motion.kind
                self._change(lambda session: apply(session, message))
                # A ball that is dragged moves in every frame; the state can wait for its own time.
                waits = kind == "ball" and motion == self.session.motion.kind
                self._state_due = self._state_due or not waits or not self.session.running

    def _change(self, act: Callable[[Session], None]) -> None:
        """Change the session; frames of other instances or other balls are of another recording."""
        before = self._cast()
        try:
            act(self.session)
        finally:
            self._frame_due = True
            if self._cast() != before:
                self._start_anew()

    def _cast(self) -> tuple[int, list[str]]:
        """Who is in a frame."""
        return self.session.view, [ball.frame for ball in self.session.balls]

    def _set_up(self, setup: Setup) -> None:
        robot = self.session.robot
        name = setup.get("robot", robot.name)
        root = setup.get("root", "fixed" if "robot" in setup else robot.root)
        if (name, root) == (robot.name, robot.root):
            self._state_due = True
            self._change(lambda session: apply_setup(session, setup))
        else:
            self._load(name, root, setup)

    def _load(self, name: str, root: str, setup: Setup) -> None:
        self._menu.check(name, root)
        self._loading = name
        self._state_due = True
        self._request += 1
        request = self._request

        def load() -> Robot | None:
            return self._menu.load(name, root) if request == self._request else None

        self._later(load, lambda robot: self._take_robot(request, name, robot, setup))

    def _take_robot(self, request: int, name: str, robot: Robot | BaseException | None, setup: Setup) -> None:
        if request != self._request or robot is None:  # somebody asked for another one meanwhile
            return
        self._loading = None
        self._state_due = True
        try:
            if isinstance(robot, BaseException):
                raise InputError(f"{name} cannot be loaded: {robot}")
            session = self.session.with_robot(robot)
            try:
                if setup:
                    apply_setup(session, setup)
            finally:
                self._change_session(session)
            if "methods" not in setup:
                for note in session.notes:
                    self._broadcast(_notice(note))
        except PinikError as error:
            self._broadcast(_notice(str(error)))

    # What is told

    def state(self) -> dict[str, Any]:
        """The `state` message."""
        return {
            **session_state(self.session),
            "generation": self._generation,
            "steps_per_second": self._pace(),
            "loading": self._loading,
            "setup": write_setup(self.session),
        }

    def _pace(self) -> float | None:
        """Steps in a second, over the last sixty; None while nothing runs."""
        if not self.session.running or len(self._ticks) < 2 or self._ticks[-1] == self._ticks[0]:
            return None
        return (len(self._ticks) - 1) / (self._ticks[-1] - self._ticks[0])

    def statistics_csv(self) -> str:
        """The statistics as a table, a row for each instance seen."""
        table = io.StringIO()
        writer = csv.writer(table)
        for index, instance in enumerate(self.session.seen):
            row = {
                "instance": index,
                "robot": self.session.robot.name,
                "method": instance.solver.name,
                "motion": self.session.motion.kind,
                "limits": "on" if self.session.chase.limits else "off",
                **dict(zip(_FIGURES, instance.statistics.summary(), strict=True)),
            }
            if index == 0:
                writer.writerow(row)
            writer.writerow(row.values())
        return table.getvalue()

    def animation(self) -> str:
        """The last seconds as a page of its own, which plays without a server."""
        shapes = self._shapes or Shapes((), (), ())
        return animation_page(self._hello, self._robot, shapes, self.state(), self.recording)


def _notice(words: str) -> str:
    """A message of the type that pages show to people for a while."""
    return json.dumps(
        {"type": "error", "message": words if len(words) <= _LONGEST_ERROR else f"{words[:_LONGEST_ERROR]} …"}
    )


def _long_text(what: str, value: Any) -> str:
    if not isinstance(value, str):
        raise InputError(f"{what} is a text; got {str(value)[:60]!r}")
    return value
