"""A session's set-up as text for the address bar, so that a link restores it."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any
from urllib.parse import parse_qsl, quote, urlencode

from ...echoes import QUOTED, shortened
from ...errors import InputError, UnknownNameError
from ...problem.tolerance import Tolerance
from ..simulation.ball import Ball
from ..simulation.instance import StepSettings
from ..simulation.session import Session
from .messages import apply, read_json
from .parameters import changed_parameters, describe_parameters, tolerance_of

__all__ = ["Setup", "apply_setup", "read_setup", "write_setup"]

Setup = dict[str, str]
_LONGEST = 20_000
_JSON_NAMES = {list: "array", dict: "object"}
_KEYS = ("robot", "root", "view", "methods", "parameters", "motion", "curve", "speed", "limits", "polish", "iterations",
         "tolerance", "balls", "looks", "run")  # fmt: skip


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
    setup["balls"] = _compact([_ball(session, index) for index in range(len(session.balls))])
    if looks := ",".join(session.looks):
        setup["looks"] = looks
    setup["run"] = "on" if session.running else "off"
    return urlencode(setup, quote_via=quote, safe=",:[]{}")


def _ball(session: Session, index: int) -> list[Any]:
    """Return [frame, mode, position, rpy, extra].

    The position is null if the motion decides it, and rpy is null if it is not asked for. `extra` is an object with the
    free axes and the ball's own tolerance, if there are any. What is null or empty at the end is left out.
    """
    ball = session.balls[index]
    moved = ball.mode == "off" or (session.motion.kind != "hand" and ball.mode == "on")
    position = None if moved else [round(float(x), 4) for x in ball.position]
    rpy = [round(float(x), 4) for x in ball.rpy] if ball.oriented else None
    extra: dict[str, Any] = {"free": ball.free} if ball.free else {}
    if ball.tolerance is not None:
        extra["tolerance"] = tolerance_of(ball)
    parts = [ball.frame, ball.mode, position, rpy, extra or None]
    while parts[-1] is None:
        parts.pop()
    return parts


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


def _messages(session: Session, setup: Setup) -> Iterator[dict[str, Any]]:
    if "view" in setup:
        yield {"type": "view", "count": _whole("view", setup["view"])}
    if "balls" in setup:  # before the methods, because the methods on offer depend on the balls
        yield from _ball_messages(session, _parsed("balls", setup["balls"], list))
    if "parameters" in setup and "methods" not in setup:
        raise InputError("set-up: parameters need the methods that they belong to")
    if "methods" in setup:
        changed = _parsed("parameters", setup.get("parameters", "{}"), dict)
        methods = setup["methods"].split(",")
        if len(methods) > len(session.instances):
            raise InputError(f"set-up: methods must be at most {len(session.instances)}; got {len(methods)}")
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
    yield {"type": "limits", "on": _on("limits", setup.get("limits", "on"))}
    yield {"type": "polish", "on": _on("polish", setup.get("polish", "off"))}
    yield {
        "type": "iterations",
        "until_reached": "iterations" not in setup,
        "at_most": _whole("iterations", setup["iterations"]) if "iterations" in setup else settings.at_most,
    }
    tolerance = _numbers("tolerance", setup["tolerance"], 2) if "tolerance" in setup else Tolerance()
    yield {"type": "tolerance", "position": tolerance[0], "orientation": tolerance[1]}
    if "curve" in setup:
        yield {"type": "curve", "curve": setup["curve"]}
    yield {"type": "speed", "value": _numbers("speed", setup["speed"], 1)[0] if "speed" in setup else 1.0}
    if "motion" in setup:
        yield {"type": "motion", "motion": setup["motion"]}
    wanted = setup.get("looks", "").split(",") if setup.get("looks") else []
    for name in {*session.looks} - {*wanted}:
        yield {"type": "look", "name": name, "on": False}
    for name in wanted:
        yield {"type": "look", "name": name, "on": True}
    if "run" in setup:
        yield {"type": "run", "on": _on("run", setup["run"])}


def _ball_messages(session: Session, balls: list[Any]) -> Iterator[dict[str, Any]]:
    """Yield the balls' frames first, so that every ball has its number, then what each ball asks for."""
    for ball in balls:
        if not (isinstance(ball, list) and 2 <= len(ball) <= 5 and _is_extra(ball[4:])):
            raise InputError(f"set-up: a ball must be [frame, mode, position, rpy, {{free, tolerance}}]; got {ball!r}")
    wanted = [ball[0] for ball in balls]
    if not wanted:
        raise InputError("set-up: balls must contain at least one ball")
    yield from _removals(session, wanted)
    for frame in wanted:
        if frame not in session.balls.frames:
            yield {"type": "add_effector", "frame": frame}
        yield from _removals(session, wanted)  # a ball that had to stay as the last one can go now
    session.balls.arrange(wanted)
    for frame, mode, position, rpy, extra in ([*ball, None, None, None][:5] for ball in balls):
        index = session.balls.frames.index(frame)
        here = session.balls[index]
        if here.mode != mode:
            yield {"type": "effector", "index": index, "mode": mode}
        if position is not None and position != [round(float(x), 4) for x in here.position]:
            yield {"type": "ball", "index": index, "position": position}
        yield from _asked(index, here, rpy, **(extra or {}))


def _is_extra(parts: list[Any]) -> bool:
    return all(isinstance(extra, dict) and set(extra) <= {"free", "tolerance"} for extra in parts)


def _asked(index: int, here: Ball, rpy: Any, free: Any = "", tolerance: Any = None) -> Iterator[dict[str, Any]]:
    """Yield the changes to what a ball asks for. The order keeps it asking for something at every moment."""
    release = {"type": "free", "index": index, "axes": free}
    turns = (rpy is not None) != here.oriented or rpy not in (None, [round(float(x), 4) for x in here.rpy])
    if free != here.free and rpy is None:
        yield release
    if turns:
        angles = here.rpy.tolist() if rpy is None else rpy
        yield {"type": "orientation", "index": index, "on": rpy is not None, "rpy": angles}
    if free != here.free:
        yield release
    if tolerance != tolerance_of(here):
        yield {"type": "ball_tolerance", "index": index, "tolerance": tolerance}


def _removals(session: Session, wanted: list[Any]) -> Iterator[dict[str, Any]]:
    """Yield the removal of every ball whose frame is not wanted; one ball always stays."""
    for index in reversed(range(len(session.balls))):
        if session.balls[index].frame not in wanted and len(session.balls) > 1:
            yield {"type": "remove_effector", "index": index}


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
