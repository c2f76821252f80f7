"""The page's requests: every field is checked before anything changes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ...checks import as_finite_number, as_vector
from ...echoes import QUOTED, shortened
from ...errors import InputError, UnknownNameError
from ...problem.tolerance import Tolerance
from ..simulation.by_hand import set_angles
from ..simulation.by_iteration import line_up, step_iteration
from ..simulation.obstacles import Obstacles
from ..simulation.session import Session
from .pasting import angles_by_joint, paste_angles
from .reading import read_json

__all__ = [
    "FARTHEST",
    "RANGES",
    "any_text",
    "apply",
    "checked",
    "number_or_none",
    "parse",
    "text",
    "whole_number",
]

RANGES: dict[str, tuple[float, float]] = {
    "speed": (0.1, 100.0),
    "iterations": (1, 1000),
    "position_tolerance": (1e-6, 1.0),
    "orientation_tolerance": (1e-6, 3.2),
}
"""Name → lowest and highest value; the page's sliders have these ends."""
FARTHEST = 100.0
"""How far from the world's origin a ball may be along each axis [m]."""
_LONGEST_NAME = 200
_LARGEST_ANGLE = 100.0  # [rad]

Check = Callable[[str, Any], Any]


def parse(written: str) -> dict[str, Any]:
    """Read a message: a JSON object with a `type`.

    Raises:
        InputError: The text is something else.
    """
    try:
        message = read_json(written)
    except ValueError as error:
        raise InputError(f"a message must be a JSON object: {error}") from None
    if not isinstance(message, dict) or not isinstance(message.get("type"), str):
        raise InputError('a message must be a JSON object with a "type"')
    text("the type of a message", message["type"])
    return message


def apply(session: Session, message: Mapping[str, Any]) -> None:
    """Do what a message asks, or nothing if it is malformed.

    Raises:
        InputError, UnknownNameError: The message is unknown, or a field is missing, unexpected or out of range.
    """
    kind = message["type"]
    if kind not in _MESSAGES:
        raise UnknownNameError("message", kind, _MESSAGES)
    fields, act = _MESSAGES[kind]
    act(session, **checked(kind, message, fields))


def checked(kind: str, message: Mapping[str, Any], fields: Mapping[str, Check]) -> dict[str, Any]:
    """Check that a message has exactly these fields, and return their checked values.

    Raises:
        InputError: A field is missing, unexpected or out of range.
    """
    given = {name: value for name, value in message.items() if name != "type"}
    if set(given) != set(fields):
        wanted = ", ".join(fields) or "no fields"
        raise InputError(f"message {kind!r} takes {wanted}; got {', '.join(given) or 'none'}")
    return {name: check(f"{kind}: {name}", given[name]) for name, check in fields.items()}


def any_text(what: str, value: Any) -> str:
    """Check that a value is a text."""
    if not isinstance(value, str):
        raise InputError(f"{what} must be a text; got {shortened(str(value), QUOTED)!r}")
    return value


def text(what: str, value: Any) -> str:
    """Check that a value is a text of at most 200 characters."""
    if not isinstance(value, str) or len(value) > _LONGEST_NAME:
        raise InputError(
            f"{what} must be a text of at most {_LONGEST_NAME} characters; got {shortened(str(value), QUOTED)!r}"
        )
    return value


def _sizes(what: str, value: Any) -> list[float]:
    """Check that a value is a list of one to three numbers."""
    if not isinstance(value, list) or not 1 <= len(value) <= 3:
        raise InputError(f"{what} must be a list of one to three numbers; got {shortened(str(value), QUOTED)!r}")
    return [as_finite_number(number, what) for number in value]


def _truth(what: str, value: Any) -> bool:
    if not isinstance(value, bool):
        raise InputError(f"{what} must be true or false; got {value!r}")
    return value


def whole_number(what: str, value: Any) -> int:
    """Check that a value is a whole number."""
    if isinstance(value, bool) or not isinstance(value, int):
        raise InputError(f"{what} must be a whole number; got {value!r}")
    return value


def number_or_none(what: str, value: Any) -> int | None:
    """Check that a value is a whole number that is not negative, or null."""
    number = None if value is None else whole_number(what, value)
    if number is not None and number < 0:
        raise InputError(f"{what} must not be negative; got {number}")
    return number


def _in_range(name: str) -> Check:
    def check(what: str, value: Any) -> float:
        low, high = RANGES[name]
        number = as_finite_number(value, what)
        if not low <= number <= high:
            raise InputError(f"{what} must be a number from {low:g} to {high:g}; got {value!r}")
        return number

    return check


def _iterations(_: str, value: Any) -> int:
    low, high = RANGES["iterations"]
    what = "max. iterations"  # as the page calls them
    number = whole_number(what, value)
    if not low <= number <= high:
        raise InputError(f"{what} must be a whole number from {low:g} to {high:g}; got {value!r}")
    return number


def _point(what: str, value: Any) -> Any:
    point = as_vector(value, 3, what)
    if abs(point).max() > FARTHEST:
        got = ", ".join(f"{number:.4g}" for number in point)
        raise InputError(f"{what} must be from {-FARTHEST:g} to {FARTHEST:g} m along each axis; got {got}")
    return point


def _angles(what: str, value: Any) -> Any:
    angles = as_vector(value, 3, what, "roll, pitch, yaw in radians")
    if abs(angles).max() > _LARGEST_ANGLE:
        raise InputError(f"{what} must be three angles of at most {_LARGEST_ANGLE:g} rad; got {angles.tolist()}")
    return angles


_position_tolerance, _orientation_tolerance = _in_range("position_tolerance"), _in_range("orientation_tolerance")


def _tolerance_or_none(what: str, value: Any) -> Tolerance | None:
    """Check [metres, radians]; the metres may be a list of three, for a box."""
    if value is None:
        return None
    if not isinstance(value, list) or len(value) != 2:
        raise InputError(f"{what} must be null or [metres, radians]; got {shortened(str(value), QUOTED)!r}")
    lengths = value[0] if isinstance(value[0], list) else [value[0]]
    if len(lengths) not in (1, 3):
        raise InputError(f"{what} must have one length, or three for a box; got {shortened(str(value), QUOTED)!r}")
    position = [_position_tolerance(what, length) for length in lengths]
    return Tolerance.of((position[0] if len(position) == 1 else position, _orientation_tolerance(what, value[1])))


def _parameter_value(what: str, value: Any) -> Any:
    """Limit the size of the value; the solver itself checks its kind and range."""
    if isinstance(value, Mapping) and len(value) > 1000:
        raise InputError(f"{what} must name at most 1000 joints; got {len(value)}")
    return value


def _set_speed(session: Session, value: float) -> None:
    session.motion.speed = value


def _set_tolerance(session: Session, position: float, orientation: float) -> None:
    session.change_settings(tolerance=Tolerance(position, orientation))


def _single_step(session: Session) -> None:
    session.running, session.misses.last = False, None
    session.step()


def _run(session: Session, on: bool) -> None:
    session.running, session.misses.last = on, None


def _pause_on_miss(session: Session, on: bool) -> None:
    session.misses.pause, session.misses.last = on, None


def _on_obstacles(act: Callable[..., None]) -> Callable[..., None]:
    """A change of the obstacles, of which the session is told."""

    def change(session: Session, **fields: Any) -> None:
        act(session.obstacles, **fields)
        session.set_obstacles(session.obstacles)

    return change


_INSTANCE: dict[str, Check] = {"instance": whole_number}
_BALL: dict[str, Check] = {"index": whole_number}

_MESSAGES: dict[str, tuple[dict[str, Check], Callable[..., None]]] = {
    "view": ({"count": whole_number}, lambda s, count: s.set_view(count)),
    "method": ({**_INSTANCE, "method": text}, lambda s, instance, method: s.set_method(instance, method)),
    "parameter": (
        {**_INSTANCE, "name": text, "value": _parameter_value},
        lambda s, instance, name, value: s.set_parameter(instance, name, value),
    ),
    "limits": ({"on": _truth}, lambda s, on: s.change_settings(limits=on)),
    "polish": ({"on": _truth}, lambda s, on: s.change_settings(polish=on)),
    "motion": ({"motion": text}, lambda s, motion: s.set_motion(motion)),
    "curve": ({"curve": text}, lambda s, curve: s.set_curve(curve)),
    "speed": ({"value": _in_range("speed")}, _set_speed),
    "iterations": (
        {"until_reached": _truth, "at_most": _iterations},
        lambda s, until_reached, at_most: s.change_settings(until_reached=until_reached, at_most=at_most),
    ),
    "tolerance": (
        {"position": _position_tolerance, "orientation": _orientation_tolerance},
        _set_tolerance,
    ),
    "run": ({"on": _truth}, _run),
    "pause_on_miss": ({"on": _truth}, _pause_on_miss),
    "look": ({"name": text, "on": _truth}, lambda s, name, on: s.looks.switch(name, on)),
    "step": ({}, _single_step),
    "line_up": ({"position": _point}, line_up),
    "step_iteration": ({"instance": number_or_none}, step_iteration),
    "reset": ({}, Session.reset),
    "begin_anew": ({}, lambda s: s.scores.begin_anew(s.view)),
    "statistics": ({"cover": text}, lambda s, cover: s.scores.cover(cover)),
    "ball": ({**_BALL, "position": _point}, Session.move_ball),
    "free": ({**_BALL, "axes": text}, lambda s, index, axes: s.balls.number(index).release(axes)),
    "orientation": (
        {**_BALL, "on": _truth, "rpy": _angles},
        lambda s, index, on, rpy: s.balls.number(index).orient(on, rpy),
    ),
    "ball_tolerance": (
        {**_BALL, "tolerance": _tolerance_or_none},
        lambda s, index, tolerance: s.balls.number(index).tolerate(tolerance),
    ),
    "collisions": ({"on": _truth, "avoid": _truth}, lambda s, on, avoid: s.set_contacts(on, avoid)),
    "add_obstacle": ({"kind": text, "size": _sizes, "position": _point}, _on_obstacles(Obstacles.add)),
    "obstacle": ({**_BALL, "position": _point}, _on_obstacles(Obstacles.put)),
    "obstacle_size": ({**_BALL, "size": _sizes}, _on_obstacles(Obstacles.resize)),
    "remove_obstacle": (_BALL, _on_obstacles(Obstacles.remove)),
    "effector": ({**_BALL, "mode": text}, Session.set_mode),
    "add_effector": ({"frame": text}, Session.add_ball),
    "angles": ({"instance": number_or_none, "angles": angles_by_joint}, set_angles),
    "balls_lead": ({}, lambda s: s.leading.hold((), ())),
    "paste": ({"instance": number_or_none, "text": any_text}, paste_angles),
    "remove_effector": (_BALL, lambda s, index: s.balls.remove(index)),
}
