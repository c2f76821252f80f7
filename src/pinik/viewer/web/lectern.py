"""What a single tab asks for when somebody teaches with it: explanations, races, and the thesis's comparisons."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from typing import Any

from ...errors import InputError, PinikError, UnknownNameError
from ..protocol.lessons import LESSONS
from ..protocol.messages import checked, number_or_none, text, whole_number
from ..protocol.race import race_message
from ..protocol.setup import Setup, read_setup
from ..protocol.thesis_walk import walk_to
from ..simulation.race import MOST_PLACES, Race, enter, run_race
from ..simulation.session import Session
from .later import Later
from .readers import Readers
from .seats import Tab

__all__ = ["Lectern", "scene_of"]

_LARGEST_SEED = 2**31


class Lectern:
    """Answers single tabs. Races run in another thread, one at a time."""

    def __init__(self, readers: Readers, later: Later, notice: Callable[[str], str]) -> None:
        self._readers, self._later, self._notice = readers, later, notice
        self._races = False
        self._present: set[Tab] = set()

    def leave(self, tab: Tab) -> None:
        """Forget a tab."""
        self._readers.open(tab, None)
        self._present.discard(tab)

    def receive(self, tab: Tab, message: Mapping[str, Any], session: Session) -> bool:
        """Do what a tab asks, and return whether it was one of these requests.

        Raises:
            InputError, UnknownNameError: A field is wrong, or a race is already being run.
        """
        match message["type"]:
            case "explain":
                index = checked("explain", message, {"instance": number_or_none})["instance"]
                if index is not None:
                    session.instances.visible(index)
                self._readers.open(tab, index)
            case "race":
                fields = checked("race", message, {"places": _places, "seed": _seed})
                self._race(tab, session, fields["places"], fields["seed"])
            case "bones":
                fields = checked("bones", message, {"number": text, "preset": text})
                walk = walk_to(session, **fields)
                tab.send(json.dumps({"type": "bones", **fields, "joints_per_bone": walk.joints_per_bone}))
            case _:
                return False
        return True

    def _race(self, tab: Tab, session: Session, places: int, seed: int) -> None:
        if self._races:
            raise InputError("a race is already being run; wait for its result")
        solvers = [instance.solver for instance in session.seen]
        entry = enter(session.robot, solvers, session.settings, session.home, session.balls, places, seed)
        self._races = True
        self._present.add(tab)
        self._later(lambda: run_race(entry), lambda race: self._finish(tab, race, seed))

    def _finish(self, tab: Tab, race: Race | BaseException, seed: int) -> None:
        self._races = False
        if tab not in self._present:
            return
        if isinstance(race, PinikError):
            tab.send(self._notice(str(race)))
        elif isinstance(race, BaseException):  # a custom solver may raise any exception
            tab.send(self._notice(f"the race ended early: {type(race).__name__}: {race}"))
        else:
            tab.send(json.dumps(race_message(race, seed)))


def scene_of(message: Mapping[str, Any], session: Session) -> tuple[Setup, float]:
    """The scene of a lesson or a comparison: its set-up, and the part of a curve's lap at which it begins.

    Raises:
        InputError, UnknownNameError: A field is wrong.
    """
    if message["type"] == "lesson":
        name = checked("lesson", message, {"name": text})["name"]
        if name not in LESSONS:
            raise UnknownNameError("lesson", name, LESSONS)
        return read_setup(LESSONS[name].setup), 0.0
    fields = checked("comparison", message, {"number": text, "preset": text})
    walk = walk_to(session, **fields)
    return walk.setup, walk.phase


def _places(what: str, value: Any) -> int:
    number = whole_number(what, value)
    if not 0 <= number <= MOST_PLACES:
        raise InputError(f"{what} must be a whole number from 0 to {MOST_PLACES}; got {value!r}")
    return number


def _seed(what: str, value: Any) -> int:
    number = whole_number(what, value)
    if not 0 <= number < _LARGEST_SEED:
        raise InputError(f"{what} must be a whole number from 0 to {_LARGEST_SEED - 1}; got {value!r}")
    return number
