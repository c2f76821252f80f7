"""Mutated robots: a tree is changed element by element, then its text byte by byte.

Every choice comes from a `random.Random`, so that a seed, hypothesis or a coverage-guided fuzzer can make it.
"""

from __future__ import annotations

import io
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from random import Random
from xml.etree import ElementTree

from .document import Node
from .encodings import ENCODERS
from .values import ADDRESSES, NUMBERS, is_numeric, near_name, same_number

__all__ = ["Case", "mutated"]

TAGS = (
    *("link", "joint", "visual", "collision", "inertial", "origin", "axis", "limit", "mimic", "dynamics", "parent"),
    *("child", "geometry", "mesh", "box", "sphere", "cylinder", "capsule", "material", "color", "texture", "mass"),
    *("inertia", "safety_controller", "calibration", "transmission", "gazebo", "robot", "xacro:if", "xi:include", "a"),
)
ATTRIBUTES = (
    *("name", "type", "xyz", "rpy", "link", "joint", "lower", "upper", "effort", "velocity", "multiplier", "offset"),
    *("filename", "scale", "rgba", "value", "size", "radius", "length", "quat_xyzw", "xmlns", "version", "damping"),
)
JOINT_TYPES = (
    "revolute",
    "continuous",
    "prismatic",
    "fixed",
    "floating",
    "planar",
    "spherical",
    "Revolute",
    " fixed",
    "",
)
MOST_ELEMENTS = 20_000
LONGEST_REPEATED = 3_000  # characters of what may come 300 times
LONGEST_HARMLESS = 15_000_000  # characters
DEEPEST = 50


@dataclass(frozen=True)
class Case:
    """An input of the attack.

    Attributes:
        written: The file.
        meant: The same robot in a form that every reader understands, without shapes.
        harmless: Whether it says as plainly as before where the links are, so that the robot must load.
        shapes: Whether parts of that kind were changed, so that its shapes are read too.
        as_text: Whether it is handed over as text rather than as a file.
    """

    written: bytes
    meant: bytes
    harmless: bool
    shapes: bool
    as_text: bool = False


def mutated(random: Random, robots: Sequence[Node]) -> Case:
    """One of the robots with one to four mutations."""
    robot = random.choice(robots).copy()
    unchanged = robot.render(plainly=True)
    shapes = False
    for _ in range(random.choice((1, 1, 1, 2, 2, 3, 4))):
        if random.randrange(4) == 0:
            inside = _reworded(random, robot)
        else:
            places = list(robot.walk())
            if not 0 < len(places) <= MOST_ELEMENTS:
                break
            parent, element, inside = random.choice(places)
            random.choice(OPERATIONS)(random, robot, parent, element)
        shapes |= inside
    text, plainly = robot.render(), robot.render(plainly=True)
    foreign = any(sign in text for sign in ("${", "$(", "xacro:", "xi:", "xmlns"))
    harmless = plainly == unchanged and not foreign and _is_plain_xml(text)
    meant = plainly.encode("utf-8", "surrogatepass")
    if random.randrange(8) == 0:
        return Case(random.choice(ENCODERS)(random, text), meant, harmless=False, shapes=shapes)
    document = text.encode("utf-8", "surrogatepass")
    return Case(document, meant, harmless, shapes, as_text=random.randrange(4) == 0)


def _is_plain_xml(text: str) -> bool:
    """Whether this is well-formed XML of a size and depth that a robot has."""
    if len(text) > LONGEST_HARMLESS:
        return False
    depth = 0
    try:
        for event, _ in ElementTree.iterparse(io.BytesIO(text.encode()), events=("start", "end")):
            depth += 1 if event == "start" else -1
            if depth > DEEPEST:
                return False
    except (ElementTree.ParseError, UnicodeError):
        return False
    return True


def _reworded(random: Random, robot: Node) -> bool:
    """Write some numbers in another notation; say whether one of them belongs to a shape."""
    places = [
        (element, name, inside)
        for _, element, inside in robot.walk()
        for name, value in element.written.items()
        if name != "name" and is_numeric(value)
    ]
    shapes = False
    for _ in range(random.randrange(1, 4) if places else 0):
        element, name, inside = random.choice(places)
        if name in element.meant:
            continue
        element.meant[name] = element.written[name]
        element.written[name] = same_number(random, element.written[name])
        shapes |= inside
    return shapes


def _drop(random: Random, robot: Node, parent: Node, element: Node) -> None:
    _remove(parent, element)


def _dissolve(random: Random, robot: Node, parent: Node, element: Node) -> None:
    place = _index(parent, element)
    parent.children[place : place + 1] = element.children


def _duplicate(random: Random, robot: Node, parent: Node, element: Node) -> None:
    twin = element.copy()
    if random.randrange(2) and twin.written:
        name = random.choice(list(twin.written))
        twin.write(name, _other_value(random, robot, name, twin.written[name]))
    parent.children.insert(random.randrange(len(parent.children) + 1), twin)


def _repeat(random: Random, robot: Node, parent: Node, element: Node) -> None:
    short = len(element.render()) <= LONGEST_REPEATED
    parent.children.extend([element] * random.choice((2, 10, 300 if short else 10)))


def _move(random: Random, robot: Node, parent: Node, element: Node) -> None:
    _remove(parent, element)
    inside = {id(element), *(id(below) for _, below, _ in element.walk())}
    homes = [robot, *(home for _, home, _ in robot.walk() if id(home) not in inside)]
    home = random.choice(homes)
    home.children.insert(random.randrange(len(home.children) + 1), element)


def _swap(random: Random, robot: Node, parent: Node, element: Node) -> None:
    alike = [other for _, other, _ in robot.walk() if other.tag == element.tag and other is not element]
    if alike:
        other = random.choice(alike)
        element.written, other.written = other.written, element.written
        element.meant, other.meant = other.meant, element.meant


def _shuffle(random: Random, robot: Node, parent: Node, element: Node) -> None:
    random.shuffle(parent.children)


def _rename(random: Random, robot: Node, parent: Node, element: Node) -> None:
    element.tag = random.choice((near_name(random, element.tag), random.choice(TAGS)))
    if not element.tag.strip().replace(":", "").isidentifier():
        element.tag = "x"


def _wrap(random: Random, robot: Node, parent: Node, element: Node) -> None:
    parent.children[_index(parent, element)] = Node(random.choice(TAGS), {}, children=[element])


def _deepen(random: Random, robot: Node, parent: Node, element: Node) -> None:
    home = element
    for _ in range(random.choice((5, 90, 99, 120))):
        home.children.insert(0, Node(random.choice(TAGS[:6]), {}))
        home = home.children[0]


def _stranger(random: Random, robot: Node, parent: Node, element: Node) -> None:
    attributes = {random.choice(ATTRIBUTES): random.choice(NUMBERS + ADDRESSES) for _ in range(random.randrange(3))}
    element.children.insert(random.randrange(len(element.children) + 1), Node(random.choice(TAGS), attributes))


def _text(random: Random, robot: Node, parent: Node, element: Node) -> None:
    texts = (
        "0 0 1",
        "<!-- -- >",
        "<!-- a -->",
        "<![CDATA[<link/>]]>",
        "&#0;",
        "&#x1F916;",
        "&e;",
        "&amp;",
        "\0",
        "]]>",
    )
    element.text = random.choice((*texts, "<?xml version='1.0'?>", "<?php x?>", "x" * 70_000, "<a", "</a>", "\ud800"))


def _attribute(random: Random, robot: Node, parent: Node, element: Node) -> None:
    if not element.written or random.randrange(8) == 0:
        element.write(random.choice(ATTRIBUTES), random.choice(NUMBERS + ADDRESSES))
        return
    name = random.choice(list(element.written))
    value = element.written[name]
    match random.randrange(10):
        case 0:
            del element.written[name]
            element.meant.pop(name, None)
        case 1:
            del element.written[name]
            element.meant.pop(name, None)
            near = near_name(random, name)
            element.write(near if near.isidentifier() else "x", value)
        case _:
            element.write(name, _other_value(random, robot, name, value))


def _other_value(random: Random, robot: Node, name: str, value: str) -> str:
    if name == "filename":
        return random.choice(ADDRESSES)
    if name == "type":
        return random.choice(JOINT_TYPES)
    if is_numeric(value):
        words = value.split()
        match random.randrange(6):
            case 0:
                return " ".join(words[: random.randrange(len(words))])
            case 1:
                return " ".join([*words, *random.choices((*words, "0", "1"), k=random.choice((1, 1, 2, 1000)))])
            case 2:
                return repr(float(words[0]) * random.choice((-1.0, 1e3, 57.29577951308232, 1e-3, 1e9, 1e-9, 1e100)))
        words[random.randrange(len(words))] = random.choice(NUMBERS)
        return " ".join(words)
    if random.randrange(2):
        return near_name(random, value)
    others = [
        other for _, one, _ in robot.walk() for key, other in one.written.items() if key in ("name", "link", "joint")
    ]
    return random.choice(others or [""])


def _index(parent: Node, element: Node) -> int:
    return next(place for place, child in enumerate(parent.children) if child is element)


def _remove(parent: Node, element: Node) -> None:
    del parent.children[_index(parent, element)]


Operation = Callable[[Random, Node, Node, Node], None]
# Attributes are where readers differ most, so half of all mutations are there.
OPERATIONS: tuple[Operation, ...] = (
    *(_drop, _dissolve, _duplicate, _duplicate, _repeat, _move, _swap, _shuffle, _rename, _wrap, _deepen, _stranger),
    *(_text, *[_attribute] * 13),
)
