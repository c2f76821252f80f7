"""The live view without its sockets: one session, and what each tab is sent."""

from __future__ import annotations

import json
import secrets
import time
from collections.abc import Callable
from typing import Any

from ...echoes import shortened
from ...errors import PinikError
from ...export.live_recording import LiveRecording, RecordedBall
from ...robot import Robot
from ..protocol.messages import any_text, apply, checked, parse, text, whole_number
from ..protocol.recording import Recording
from ..protocol.setup import Setup, apply_setup, read_setup, write_setup
from ..protocol.state import hello_message, session_state
from ..simulation.session import Session
from .animation import animation_page
from .answers import Answers
from .broadcast import Broadcast
from .exhibit import Exhibit
from .later import Later
from .lectern import Lectern, scene_of
from .pace import Pace
from .readers import Readers
from .robots_on_show import RobotsOnShow
from .scene import Shapes
from .seats import Seats, Tab

__all__ = ["Show"]

_LONGEST_ERROR = 400  # characters; an error may quote a whole message


class Show:
    """Steps the session, tells every tab what changed, and does what tabs ask.

    Attributes:
        session: The session on show; choosing another robot replaces it.
    """

    def __init__(
        self,
        session: Session,
        later: Later,
        version: str = "",
        clock: Callable[[], float] = time.perf_counter,
        reload: Callable[[], Robot] | None = None,
    ) -> None:
        self.session = session
        self._robots = RobotsOnShow(lambda: self.session, later, reload)
        self._later, self._clock, self._seats = later, clock, Seats()
        self._broadcast = Broadcast(self._seats, clock)
        self._readers = Readers(self._seats.is_late)
        self._lectern = Lectern(self._readers, later, _notice)
        server = secrets.token_hex(8)
        self._hello = hello_message(version, session.methods, self._robots.own_names, server)
        self._pace = Pace(clock)
        self._answers = Answers(later, self._seats.send)
        self._exhibit = Exhibit(session, 1, False, self._seats, later)
        self._show(session)

    def _change_session(self, session: Session, keeps_view: bool = False) -> None:
        self.session = session
        self._answers.forget()
        self._exhibit.end()
        self._exhibit = Exhibit(session, self._exhibit.generation + 1, keeps_view, self._seats, self._later)
        self._show(session)

    def _show(self, session: Session) -> None:
        self._waits_for_shapes = True
        self._start_anew()
        self._send_state()
        self._exhibit.begin(session)
        self._supply()

    def _start_anew(self) -> None:
        """Discard the recording, whose frames show other instances or balls, and begin one with where they are."""
        self._broadcast.start_anew(self._exhibit.maker.frame(self.session), self.session)

    @property
    def recording(self) -> Recording:
        """The frames of the last seconds."""
        return self._broadcast.recording

    @property
    def _awaits_shapes(self) -> bool:
        """Whether the robot's shapes are still being read, and nobody has asked for anything meanwhile."""
        return self._waits_for_shapes and self.reads_shapes

    # Tabs

    def is_watched(self) -> bool:
        """Return whether there is any tab."""
        return len(self._seats) > 0

    def is_lively(self) -> bool:
        """Return whether there is a tab, and anything to tell it without being asked."""
        waits = self._awaits_shapes or self._robots.loads or self.session.contacts.waits
        return self.is_watched() and (waits or self._broadcast.is_due or not self.session.sleeps)

    def join(self, tab: Tab) -> None:
        """Add a tab and send it everything."""
        for message in (self._hello, self._exhibit.robot, self.state()):
            tab.send(json.dumps(message))
        for part in self._exhibit.messages():
            tab.send(part)
        self._seats.add(tab, self._broadcast.frame)

    def leave(self, tab: Tab) -> None:
        """Remove a tab."""
        self._seats.remove(tab)
        self._lectern.leave(tab)

    def receive(self, tab: Tab, message_text: str) -> None:
        """Do what a tab asks, or send it the reason why that is impossible."""
        try:
            message = parse(message_text)
            if message["type"] == "drawn":
                checked("drawn", message, {"step": whole_number})
                self._seats.drawn(tab, self._broadcast.frame, self._broadcast.state)
                self._readers.catch_up(tab, self.session, self._exhibit.generation)
            elif self._lectern.receive(tab, message, self.session):
                self._broadcast.state_due = True
            else:
                self.do(message)
        except PinikError as error:
            tab.send(_notice(str(error)))

    # Time

    def tick(self) -> None:
        """Step the session by a 60th of a second, and send what is due.

        The session waits while a robot that somebody watches has no shapes yet, so that reading them has the
        processors to itself; any request ends that wait.
        """
        if not (self._awaits_shapes and self._seats) and self.session.tick():
            self._pace.note_step()
            self._broadcast.frame_due |= not self.session.rests
            self._broadcast.state_due |= not self.session.running  # it has paused
        else:
            self._pace.forget()
        if self._broadcast.frame_due:
            self._broadcast.send_frame(self._exhibit.maker.frame(self.session), self.session)
        if self._broadcast.wants_state(self.session):
            self._send_state()

    def _send_state(self) -> None:
        self._broadcast.send_state(self.state)
        self._readers.send(self.session, self._exhibit.generation)

    def look_at_files(self) -> bool:
        """Look at the watched files while somebody watches; return whether there is anything new to send."""
        if self.is_watched():
            self._robots.look_at_files(self._take_reloaded, self._take_fault)
        return self._broadcast.is_due

    def _take_fault(self) -> None:
        self._broadcast.state_due = True

    def _take_reloaded(self, session: Session | None, words: list[str]) -> None:
        self._hello["robots"] = self._robots.names
        self._seats.send(json.dumps(self._hello))
        self._take_session(session, words, keeps_view=True)

    def _take_session(self, session: Session | None, words: list[str], keeps_view: bool = False) -> None:
        """Go on with another session if there is one, and tell everybody these words."""
        self._broadcast.state_due = True
        if session is not None:
            self._change_session(session, keeps_view)
        for notice in words:
            self._seats.send(_notice(notice))

    # Requests

    def do(self, message: dict[str, Any]) -> None:
        """Do what a message asks.

        Raises:
            InputError, UnknownNameError: It is impossible. Nothing has changed, except that a set-up's parts before
                the faulty one have been applied.
        """
        self._waits_for_shapes = False
        match message["type"]:
            case "robot":
                fields = checked("robot", message, {"name": text, "root": text})
                self._load(fields["name"], fields["root"], {})
            case "setup":
                self._set_up(read_setup(checked("setup", message, {"setup": any_text})["setup"]))
            case "lesson" | "comparison":
                self._set_up(*scene_of(message, self.session))
            case kind if kind in self._answers.KINDS:
                self._broadcast.state_due = True
                self._change(lambda session: self._answers.receive(message, session, self._exhibit.generation))
            case kind:
                before = self._leads()
                self._change(lambda session: apply(session, message))
                # Every frame shows a ball or a joint that is dragged, so the state can wait until it is due anyway.
                waits = kind in ("ball", "angles") and before == self._leads()
                self._broadcast.state_due |= not waits or not self.session.running

    def _change(self, act: Callable[[Session], None]) -> None:
        """Change the session, and start a new recording if its instances, their methods or balls are others now."""
        before = self._cast()
        try:
            act(self.session)
        finally:
            self._broadcast.frame_due = True
            self._supply()
            if self._cast() != before:
                self._start_anew()
            elif self._broadcast.lacks(self.session):  # several steps may be asked for between two ticks
                self._broadcast.record(self._exhibit.maker.frame(self.session), self.session)

    def _supply(self) -> None:
        """Load what the session needs now."""
        self._exhibit.supply(self.session, self._take_contacts)

    def _take_contacts(self, why_not: str) -> None:
        self._broadcast.state_due = self._broadcast.frame_due = True
        if why_not:
            self._seats.send(_notice(why_not))

    def _cast(self) -> tuple[list[str], list[str]]:
        """Return what a recording has one of: the method of each visible instance, and the frame of each ball."""
        return [instance.solver.name for instance in self.session.seen], [ball.frame for ball in self.session.balls]

    def _leads(self) -> tuple[str, frozenset[int]]:
        """Return what moves the balls."""
        return self.session.motion.kind, self.session.leading.among(self.session.balls.targets)

    def _set_up(self, setup: Setup, phase: float | None = None) -> None:
        """Apply a set-up. A scene, which has a phase of its curve's lap, begins anew there."""
        robot = self.session.robot
        name = setup.get("robot", robot.name)
        root = setup.get("root", "fixed" if "robot" in setup else robot.root)
        if (name, root) == (robot.name, robot.root):
            self._broadcast.state_due = True
            if "robot" in setup:  # a part of a set-up asks for no robot
                self._robots.stay()
            self._change(lambda session: _apply(session, setup, phase))
        else:
            self._load(name, root, setup)  # its session begins anew as it is, and at the beginning of a lap

    def _load(self, name: str, root: str, setup: Setup) -> None:
        self._robots.load(name, root, setup, self._take_session)
        self._broadcast.state_due = True

    # Answers

    def state(self) -> dict[str, Any]:
        """Return the `state` message."""
        return {
            **session_state(self.session),
            "generation": self._exhibit.generation,
            "steps_per_second": self._pace.value if self.session.running else None,
            **self._robots.state(),
            "setup": write_setup(self.session),
        }

    @property
    def reads_shapes(self) -> bool:
        """Whether the robot's shapes are still being read."""
        return self._exhibit.shapes is None

    def animation(self) -> bytes:
        """Return the last seconds as one HTML file (UTF-8) that plays without a server."""
        shapes = self._exhibit.shapes or Shapes((), (), ())
        state = self.state() | {"command": None}  # it holds a path of this machine, and the page may be sent around
        return animation_page(self._hello, self._exhibit.robot, shapes, state, self.recording)

    def recorded(self) -> LiveRecording:
        """Return the last seconds, with the methods and the balls as they are now."""
        balls = [
            RecordedBall(ball.frame, places[:, :3], places[:, 3:], ball.mode == "pinned", ball.oriented)
            for ball, places in zip(self.session.balls, self.recording.balls, strict=True)
            if ball.mode != "off"
        ]
        solvers = tuple(instance.solver for instance in self.session.seen)
        return LiveRecording(self.session.robot, solvers, self.recording.times, self.recording.q, tuple(balls))


def _apply(session: Session, setup: Setup, phase: float | None) -> None:
    if phase is not None:
        session.reset()
    apply_setup(session, setup)
    if phase is not None:
        session.motion.start_at(phase)


def _notice(words: str) -> str:
    """Return an `error` message, which pages show for a while."""
    return json.dumps({"type": "error", "message": shortened(words, _LONGEST_ERROR)})
