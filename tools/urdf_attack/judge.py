"""What must be true of each input: an error in words, or a robot that yourdfpy places as pinik does; no more."""

from __future__ import annotations

import os
import re
import resource
import sys
import traceback
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pinocchio

import pinik
from pinik.cli.reports.inspection import inspect
from pinik.description.links import LinkTag
from pinik.description.shares import example_robot_data
from pinik.description.xacro import is_xacro
from pinik.extras import MissingExtraError
from pinik.robot import Robot
from pinik.shapes.meshes import load_shapes
from pinik.shapes.second_opinion import SecondOpinion, ask_yourdfpy

from .mutations import Case
from .outcome import Outcome
from .sandbox import Sandbox

__all__ = ["Judge"]

ROUNDED = 1e-7  # [m and rad]
LONGEST_MESSAGE = 2_000
INSPECTED = 8  # every so many inputs are given to `pinik check` too
EXPANDED = 4  # every so many xacro files are expanded, which takes a process; the others are given as bytes
MEMORY = 2 * 1024**3  # [B] on top of what the libraries need


class Judge:
    """Hands inputs to pinik and judges what it does; lives in a process of its own, whose memory it bounds."""

    def __init__(self, sandbox: Sandbox) -> None:
        self._sandbox = sandbox
        self._opened: list[str] = []
        self._watching = False
        self._count = 0
        self._agreed: set[int] = set()
        self._drawn: set[int] = set()
        self._allowed = self._folders()
        self._plain_robot()
        sys.addaudithook(self._watch)
        used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
        resource.setrlimit(resource.RLIMIT_AS, (used + MEMORY, used + MEMORY))

    def __call__(self, case: Case) -> Outcome:
        """The outcome of one input."""
        sandbox = self._sandbox
        document = sandbox.filled(case.written)
        sandbox.robot.write_bytes(document)
        source: str | bytes = str(sandbox.robot)
        if case.as_text:
            text = document.decode("utf-8", "surrogatepass")
            source = text if text.lstrip("\ufeff \t\r\n").startswith("<") else source
        self._opened.clear()
        self._count += 1
        if self._count % EXPANDED and is_xacro(sandbox.robot, document):
            source = document
        try:
            with self._watched(), warnings.catch_warnings():
                warnings.simplefilter("error")
                warnings.simplefilter("ignore", pinik.UrdfWarning)
                outcome, robot = self._loaded(source, case)
                if robot is not None and case.shapes:
                    self._draw(robot)
                if self._count % INSPECTED == 0:
                    inspect(source if isinstance(source, bytes) else str(sandbox.robot), [])
        except Exception as fault:
            return self._raised(fault)
        if self._opened:
            return Outcome("opened", self._opened[0], f"opened {self._opened[0]}")
        return outcome if robot is None else self._second_opinion(robot, case)

    def _loaded(self, source: str | bytes, case: Case) -> tuple[Outcome, Robot | None]:
        try:
            robot = pinik.load(source)
        except MissingExtraError as error:  # a xacro file, whose reader is an extra
            return Outcome("refused", str(error), "needs an extra"), None
        except pinik.RobotLoadError as error:
            words = str(error)
            if len(words) > LONGEST_MESSAGE or not error.cause.strip():
                return Outcome("wordless", words[:300], f"wordless {_shape(error.cause)}"), None
            if case.harmless:
                return Outcome("stopped", words[:300], f"stopped {_shape(error.cause)}"), None
            return Outcome("refused", words, _shape(error.cause)), None
        return Outcome("agreed"), robot

    def _draw(self, robot: Robot) -> None:
        """Read the shapes of the links whose shapes are none of those that were read before."""
        news = tuple(link for link in robot.description.link_tags if _shapes_of(link) not in self._drawn)
        whole, robot.description = robot.description, replace(robot.description, link_tags=news)
        try:
            load_shapes(robot)
        finally:
            robot.description = whole
        self._drawn.update(map(_shapes_of, news))

    def _second_opinion(self, robot: Robot, case: Case) -> Outcome:
        """Compare the placements, once for all robots with the same links and joints that are meant to be the same."""
        description = robot.description
        key = hash((case.meant, description.root, description.links, description.joints))
        if key in self._agreed:
            return Outcome("agreed")
        outcome = self._compared(robot, case)
        if outcome.kind == "agreed":
            self._agreed.add(key)
        return outcome

    def _compared(self, robot: Robot, case: Case) -> Outcome:
        rng = np.random.default_rng(0)
        for q in (robot.neutral(), robot.random(rng)):
            pinocchio.framesForwardKinematics(robot.model, robot.data, q)
            if not all(np.isfinite(placement.homogeneous).all() for placement in robot.data.oMf):
                return Outcome("infinite", "a placement is not finite", "infinite")
        self._sandbox.plain.write_bytes(self._sandbox.filled(case.meant))
        opinion = ask_yourdfpy(robot, self._sandbox.plain)
        if _agrees(opinion, robot):
            return Outcome("agreed")
        self._sandbox.plain.write_text(_text_of(robot))
        again = ask_yourdfpy(robot, self._sandbox.plain)
        if not _agrees(again, robot):
            return Outcome("disagreed", f"on the text for Pinocchio: {again}", "disagreed on the text for Pinocchio")
        if (name := _renamed(robot, case)) is not None:
            return Outcome("renamed", f"the spoiled bytes name a joint {name!r}", "renamed")
        if opinion.unread is not None:
            return Outcome("unread", opinion.unread, f"unread {_shape(opinion.unread)}")
        assumed = sorted({str(getattr(flaw, "code", flaw))[:40] for flaw in robot.warnings})
        if assumed:
            return Outcome("assumed", f"{opinion}; {robot.warnings[0]}", f"assumed {', '.join(assumed)}")
        return Outcome("disagreed", str(opinion), "disagreed")

    def _raised(self, fault: Exception) -> Outcome:
        kind = "warned" if isinstance(fault, Warning) else "raised"
        frames = [frame for frame in traceback.extract_tb(fault.__traceback__) if "/pinik/" in frame.filename]
        place = f"{'/'.join(Path(frames[-1].filename).parts[-2:])}:{frames[-1].lineno}" if frames else "?"
        words = f"{type(fault).__name__} at {place}: {str(fault)[:300]}"
        return Outcome(kind, words, f"{type(fault).__name__} at {place}")

    def _folders(self) -> tuple[str, ...]:
        examples = example_robot_data()
        homes = [
            self._sandbox.package.parent,
            *map(Path, (sys.prefix, sys.base_prefix)),
            *map(Path, filter(None, sys.path)),
        ]
        return tuple(str(home.resolve()) + os.sep for home in [*homes, *([examples.parent] if examples else [])])

    def _plain_robot(self) -> None:
        """One robot in peace, so that all that pinik imports late is imported before reads are watched."""
        robot = pinik.load("two_link")
        load_shapes(robot)
        inspect("two_link", [])

    @contextmanager
    def _watched(self) -> Iterator[None]:
        self._watching = True
        try:
            yield
        finally:
            self._watching = False

    def _watch(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self._watching:
            return
        if event == "subprocess.Popen" and arguments[0] == sys.executable:
            return  # xacro expands files in a process of its own, whose reads are not watched
        if event in ("socket.connect", "socket.getaddrinfo", "subprocess.Popen", "os.system", "os.exec", "os.fork"):
            self._opened.append(f"{event} {arguments!r}"[:200])
        if event == "open" and isinstance(arguments[0], (str, bytes)):
            path = os.path.abspath(os.fsdecode(arguments[0]))
            # Folders above the robot may be packages, which only their manifest tells.
            if not path.startswith(self._allowed) and os.path.basename(path) != "package.xml" and path != os.devnull:
                self._opened.append(path[:200])


def _shapes_of(link: LinkTag) -> int:
    """A number for the visual shapes of a link, wherever they stand in the file."""
    return hash(tuple(replace(shape, line=0) for shape in link.visuals))


def _renamed(robot: Robot, case: Case) -> str | None:
    """A joint whose name was changed byte by byte: another reader finds it in the file, and not in the plain form."""
    written, meant = _joint_names(case.written), _joint_names(case.meant)
    if len(written) != len(meant):
        return None
    return next((name for name in robot.joint_names if name in written and name not in meant), None)


def _joint_names(document: bytes) -> list[str | None]:
    """The names of a robot's joints by a plain XML parser; none if the document is not well-formed."""
    try:
        return [joint.get("name") for joint in ElementTree.fromstring(document).iterfind("joint")]
    except (ElementTree.ParseError, ValueError):
        return []


def _agrees(opinion: SecondOpinion, robot: Robot) -> bool:
    """Whether all links are where yourdfpy has them, but for changes so small that trimesh does not pass them on."""
    if opinion.unread is not None or opinion.links < len(robot.description.links):
        return False
    apart, turned = opinion.position_difference_m, opinion.rotation_difference_rad
    return opinion.agrees or (apart is not None and turned is not None and max(apart, turned) <= ROUNDED)


def _text_of(robot: Robot) -> str:
    return robot.description.xml


def _shape(words: str) -> str:
    """An error's words without names and numbers."""
    cut = "".join(
        part if place % 2 == 0 else "…" for place, part in enumerate(words[:500].replace('"', "'").split("'"))
    )
    return re.sub(r"\d+", "#", re.sub(r" \(line \d+.*\)$", "", cut))[:80]
