"""A session's set-up as text for the address bar, so that a link restores it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode

from ...echoes import QUOTED, shortened
from ...errors import InputError, PinikError, UnknownNameError
from ...problem.tolerance import Tolerance
from ..simulation.session import Session
from ..simulation.step_settings import StepSettings
from .led import angle_messages, led_angles
from .messages import apply
from .parameters import changed_parameters, describe_parameters
from .reading import read_json
from .setup_balls import ball_messages, balls_text
from .surroundings import collisions_messages, obstacle_messages, written_collisions, written_obstacles

__all__ = ["Setup", "apply_setup", "apply_what_fits", "read_setup", "write_setup"]

Setup = dict[str, str]
_LONGEST = 65_000  # characters; an undo names every joint of four robots, and a message may have 65,536 bytes
_JSON_NAMES = {list: "array", dict: "object"}
_KEYS = ("robot", "root", "view", "methods", "parameters", "motion", "curve", "speed", "limits", "polish", "iterations",
         "tolerance", "statistics", "balls", "angles", "lead", "pause", "collisions", "obstacles", "looks",
         "run")  # fmt: skip


def write_setup(session: Session) -> str:
    """Return the set-up as "name=value&…", mostly without settings that have their default value."""
    settings, motion, default = session.settings, session.motion, StepSettings()
    setup = {
        "robot": session.robot.name,
        "root": session.robot.root,
        "view": str(session.view),
        "methods": ",".join(instance.solver.name for instance in session.seen),
    }
    changed = {str(i): p for i, instance in enumerate(session.seen) if (p := changed_parameters(instance.solver))}
    if changed:
        setup["parameters"] = _compact(changed)
    setup["motion"] = motion.kind
    if motion.kind == "curve":
        setup["curve"] = motion.curve
    if motion.speed != 1.0:
        setup["speed"] = _short(motion.speed)
    if settings.limits != default.limits:
        setup["limits"] = "off"
    if settings.polish != default.polish:
        setup["polish"] = "on"
    if not settings.until_reached:
        setup["iterations"] = str(settings.at_most)
    if settings.tolerance != default.tolerance:
        setup["tolerance"] = ",".join(map(_short, (settings.tolerance.farthest, settings.tolerance.orientation)))
    if session.scores.window != "last":
        setup["statistics"] = session.scores.window
    setup["balls"] = balls_text(session)
    if angles := led_angles(session):
        setup["angles"] = _compact(angles)
    if session.misses.pause:
        setup["pause"] = "on"
    if session.contacts.on:
        setup["collisions"] = written_collisions(session)
    if session.obstacles:
        setup["obstacles"] = _compact(written_obstacles(session))
    if looks := ",".join(session.looks):
        setup["looks"] = looks
    setup["run"] = "on" if session.running else "off"
    return urlencode(setup, quote_via=quote, safe=",:[]{}")


def _short(number: float) -> str:
    """Return the shortest text that reads back as exactly this number."""
    return repr(float(number)).removesuffix(".0")


def _compact(value: Any) -> str:
    return json.dumps(value, separators=(",", ":"))


def read_setup(text: str) -> Setup:
    """Split a set-up into its parts, by name.

    Raises:
        InputError: It is too long or contains a part twice.
        UnknownNameError: It contains an unknown part.
    """
    if len(text) > _LONGEST:
        raise InputError(f"a set-up must have at most {_LONGEST} characters; got {len(text)}")
    setup: Setup = {}
    for name, value in parse_qsl(text.lstrip("#"), keep_blank_values=True):
        if name not in _KEYS:
            raise UnknownNameError("part of a set-up", name, _KEYS)
        if name in setup:
            raise InputError(f"the set-up contains {name!r} twice")
        setup[name] = value
    return setup


def apply_setup(session: Session, setup: Setup) -> None:
    """Change a session to match a set-up, all but its robot. Whatever matches already keeps its statistics.

    Raises:
        InputError, UnknownNameError: A part is wrong; the parts before it have been applied.
    """
    for message in _messages(session, setup):
        apply(session, message)


def apply_what_fits(session: Session, setup: Setup) -> list[str]:
    """Like `apply_setup`, but leave out what does not suit the robot; return the reasons.

    Balls of frames that the robot does not have are left out, too.
    """
    notes: list[str] = []
    if "balls" in setup:
        balls = _parsed("balls", setup["balls"], list)
        kept = [ball for ball in balls if ball[0] in session.robot.frame_names]
        notes += [f"the ball of {ball[0]!r} is gone, as this frame is" for ball in balls if ball not in kept]
        setup = {**setup, "balls": _compact(kept)}
        if not kept:
            del setup["balls"]
    for message in _messages(session, setup):
        try:
            apply(session, message)
        except PinikError as error:
            notes.append(str(error))
    return notes


def _messages(session: Session, setup: Setup) -> Iterator[dict[str, Any]]:
    if "view" in setup:
        yield {"type": "view", "count": _whole("view", setup["view"])}
    yield from collisions_messages(session, setup.get("collisions", "off"))
    yield from obstacle_messages(session, _parsed("obstacles", setup.get("obstacles", "[]"), list))
    yield {"type": "limits", "on": _on("limits", setup.get("limits", "on"))}
    angles, starts = _parsed("angles", setup.get("angles", "{}"), dict), _lead(setup) == "balls"
    if starts:  # the robots begin in this pose, and the balls are elsewhere
        yield from angle_messages(session, angles)
        yield {"type": "balls_lead"}
    if "balls" in setup:  # before the methods, because the methods on offer depend on the balls
        yield from ball_messages(session, _parsed("balls", setup["balls"], list))
    if "parameters" in setup and "methods" not in setup:
        raise InputError("set-up: parameters need the methods that they belong to")
    if "methods" in setup:
        changed = _parsed("parameters", setup.get("parameters", "{}"), dict)
        methods = setup["methods"].split(",")
        if len(methods) > len(session.instances):
            raise InputError(f"set-up: methods must be at most {len(session.instances)}; got {len(methods)}")
        if strange := changed.keys() - set(map(str, range(len(methods)))):
            raise InputError(
                f"set-up: parameters must belong to one of the methods 0 to {len(methods) - 1}; "
                f"got {shortened(min(strange), QUOTED)!r}"
            )
        for index, method in enumerate(methods):
            if session.instances[index].solver.name != method:
                yield {"type": "method", "instance": index, "method": method}
            wanted = changed.get(str(index), {})
            if not isinstance(wanted, dict):
                raise InputError(f"set-up: the parameters of instance {index} must be an object; got {wanted!r}")
            described = describe_parameters(session.instances[index].solver)
            defaults = {p["name"]: p["default"] for p in described if p["value"] != p["default"]}
            for name, value in (defaults | wanted).items():
                yield {"type": "parameter", "instance": index, "name": name, "value": value}
    settings = session.settings
    yield {"type": "polish", "on": _on("polish", setup.get("polish", "off"))}
    yield {
        "type": "iterations",
        "until_reached": "iterations" not in setup,
        "at_most": _whole("iterations", setup["iterations"]) if "iterations" in setup else settings.at_most,
    }
    tolerance = _numbers("tolerance", setup["tolerance"], 2) if "tolerance" in setup else Tolerance()
    yield {"type": "tolerance", "position": tolerance[0], "orientation": tolerance[1]}
    yield {"type": "statistics", "cover": setup.get("statistics", "last")}
    if "curve" in setup:
        yield {"type": "curve", "curve": setup["curve"]}
    yield {"type": "speed", "value": _numbers("speed", setup["speed"], 1)[0] if "speed" in setup else 1.0}
    if "motion" in setup:
        yield {"type": "motion", "motion": setup["motion"]}
    if not starts:
        yield from angle_messages(session, angles)
    yield {"type": "pause_on_miss", "on": _on("pause", setup.get("pause", "off"))}
    wanted = setup.get("looks", "").split(",") if setup.get("looks") else []
    for name in {*session.looks} - {*wanted}:
        yield {"type": "look", "name": name, "on": False}
    for name in wanted:
        yield {"type": "look", "name": name, "on": True}
    if "run" in setup:
        yield {"type": "run", "on": _on("run", setup["run"])}


def _lead(setup: Setup) -> str:
    """What leads: the joints whose angles are given, or the balls."""
    lead = setup.get("lead", "joints" if "angles" in setup else "balls")
    if lead not in ("joints", "balls"):
        raise InputError(f"set-up: lead must be joints or balls; got {shortened(lead, QUOTED)!r}")
    return lead


def _on(name: str, text: str) -> bool:
    if text not in ("on", "off"):
        raise InputError(f"set-up: {name} must be on or off; got {shortened(text, QUOTED)!r}")
    return text == "on"


def _parsed(name: str, text: str, kind: type[list[Any]] | type[dict[str, Any]]) -> Any:
    try:
        value = read_json(text)
    except ValueError:
        value = None
    if not isinstance(value, kind):
        raise InputError(f"set-up: {name} must be a JSON {_JSON_NAMES[kind]}; got {shortened(text, QUOTED)!r}")
    return value


def _whole(name: str, text: str) -> int:
    if not text.isdecimal() or len(text) > 9:
        raise InputError(f"set-up: {name} must be a whole number; got {shortened(text, QUOTED)!r}")
    return int(text)


def _numbers(name: str, text: str, count: int) -> list[float]:
    try:
        numbers = [float(part) for part in text.split(",")]
    except ValueError:
        numbers = []
    if len(numbers) != count:
        raise InputError(
            f"set-up: {name} must be {count} number{'s' if count > 1 else ''}; got {shortened(text, QUOTED)!r}"
        )
    return numbers
