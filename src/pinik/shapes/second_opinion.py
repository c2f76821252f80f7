"""A second opinion on a robot: yourdfpy reads the same file, and the placements of all links are compared.

yourdfpy shares no code with Pinocchio or with pinik's reader. Importing this module imports yourdfpy and trimesh,
which takes over a second; import it only where the comparison is needed.
"""

from __future__ import annotations

import io
import logging
from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
import yourdfpy
from numpy.typing import NDArray

from ..echoes import shortened
from ..model.robot_model import RobotModel
from .quiet import quiet

__all__ = ["SecondOpinion", "ask_yourdfpy"]

Array = NDArray[np.float64]

TOLERANCE = 1e-9  # [m and rad]; relative for links that are more than 1 m from the root link
RANDOM_CONFIGURATIONS = 2
NO_AXIS = ("floating", "planar")


@dataclass(frozen=True)
class SecondOpinion:
    """How yourdfpy's reading of a robot compares with pinik's.

    Attributes:
        unread: The reason why yourdfpy could not read the file, in which case all else is empty; None if it could.
        links: The number of links compared.
        configurations: The number of configurations compared; the first is the neutral one.
        position_difference_m: The largest distance between the two placements of a link [m].
        rotation_difference_rad: The largest angle between them [rad].
        disagreeing: Links whose placements differ by more than 1e-9, and links that only one reader found.
        unmatched: Those of them that only one reader found, so that there is nothing to compare.
        unmoved: Floating and planar joints, which yourdfpy cannot move; they stay neutral.
    """

    unread: str | None = None
    links: int = 0
    configurations: int = 0
    position_difference_m: float | None = None
    rotation_difference_rad: float | None = None
    disagreeing: tuple[str, ...] = ()
    unmatched: tuple[str, ...] = ()
    unmoved: tuple[str, ...] = ()

    @property
    def agrees(self) -> bool:
        """Whether yourdfpy could read the file and agrees on the placement of every link."""
        return self.unread is None and not self.disagreeing

    def to_dict(self) -> dict[str, Any]:
        """The fields as JSON; docs/json.md describes them."""
        return {"agrees": self.agrees, **asdict(self)}

    def __str__(self) -> str:
        if self.unread is not None:
            return f"yourdfpy gives no second opinion: {self.unread}"
        verdict = f"disagrees about {_listed(self.disagreeing)}" if self.disagreeing else "agrees"
        links = f"{self.links} link{'' if self.links == 1 else 's'}"
        compared = f"{links} at {self.configurations} configurations"
        if self.unmatched:
            compared = f"only one reader found {_listed(self.unmatched)}; the other {compared}"
        apart = f"at most {_apart(self.position_difference_m)} m and {_apart(self.rotation_difference_rad)} rad apart"
        unmoved = f"; it cannot move {_listed(self.unmoved)}, which stayed neutral" if self.unmoved else ""
        return f"yourdfpy {verdict}: {compared}, {apart}{unmoved}"


def ask_yourdfpy(robot: RobotModel, file: str | Path | bytes) -> SecondOpinion:
    """Compare a robot with yourdfpy's reading of its file.

    Placements are compared in the root link, at the neutral configuration and at two random ones, which are always the
    same. Every joint whose mimic tag names a joint with one axis follows it here as yourdfpy reads the tag, also where
    pinik leaves it free, which then is a disagreement. Known deviations of yourdfpy are excluded: it multiplies the
    travel of a prismatic joint by the length of its axis, and does not move floating joints, planar joints or mimics of
    mimics.

    Args:
        robot: The robot, with any root joint.
        file: The file that the robot was loaded from, or its contents.
    """
    rng = np.random.default_rng(0)
    configurations = [
        robot.configuration(),
        *(_with_neutral_placements(robot, robot.random(rng)) for _ in range(RANDOM_CONFIGURATIONS)),
    ]
    try:
        with quiet(logging.getLogger("yourdfpy.urdf")):
            reader, mimics = _read(file if isinstance(file, bytes) else Path(file).read_bytes())
            theirs = [_their_links(reader, mimics, robot, q) for q in configurations]
    except Exception as fault:  # yourdfpy raises KeyError, TypeError, AttributeError, …
        cause = shortened(" ".join(str(fault).split()), 200)
        return SecondOpinion(unread=f"it could not read the file ({type(fault).__name__}: {cause})")
    return _compared(robot, [_our_links(robot, q) for q in configurations], theirs)


def _apart(difference: float | None) -> str:
    """A difference as text; rounding errors are shown as 1e-12."""
    return "nan" if difference is None else f"{max(difference, 1e-12):.2g}"


def _listed(names: Sequence[str]) -> str:
    shown = ", ".join(repr(name) for name in names[:6])
    return shown if len(names) <= 6 else f"{shown} and {len(names) - 6} more"


def _with_neutral_placements(robot: RobotModel, q: Array) -> Array:
    """The configuration with the angles of `q`, and with neutral floating and planar joints."""
    angles = robot.angles(q)
    return robot.configuration({name: angles[name] for name in robot.joint_names})


def _read(document: bytes) -> tuple[yourdfpy.URDF, dict[str, Any]]:
    """yourdfpy's reading of a URDF, without shapes and mimic tags and with unit axes; and the mimic tags.

    yourdfpy itself would place followers wrongly where they follow a follower, or a leader that comes after a floating
    or planar joint. Tags that name no joint with one axis are left out, as yourdfpy has nothing to follow there either.
    """
    read = yourdfpy.URDF.load(io.BytesIO(document), load_meshes=False, build_scene_graph=False).robot
    for link in read.links:
        link.visuals.clear()  # else it builds meshes for boxes and cylinders
    mimics = {}
    for joint in read.joints:
        if joint.mimic is not None:
            mimics[joint.name], joint.mimic = joint.mimic, None
        if joint.type in NO_AXIS:
            joint.type = "fixed"
        elif joint.type != "fixed":
            axis = joint.axis / np.abs(joint.axis).max()  # first, so that squares neither overflow nor underflow
            joint.axis = axis / np.linalg.norm(axis)
    leaders = {joint.name for joint in read.joints if joint.type != "fixed"}
    followed = {name: mimic for name, mimic in mimics.items() if mimic.joint in leaders}
    return yourdfpy.URDF(robot=read, load_meshes=False, build_scene_graph=True), followed


def _their_links(reader: yourdfpy.URDF, mimics: Mapping[str, Any], robot: RobotModel, q: Array) -> dict[str, Array]:
    """Link → its placement (4, 4) in the root link, by yourdfpy.

    The placements of single joints are multiplied here: for a whole chain yourdfpy searches the path each time, which
    takes minutes for a thousand links.
    """
    angles = robot.angles(q)

    def angle(joint: str) -> float:
        if joint not in mimics:
            return angles.get(joint, 0.0)
        mimic = mimics[joint]
        return float(mimic.multiplier * angle(mimic.joint) + mimic.offset)

    reader.update_cfg({joint.name: angle(joint.name) for joint in reader.robot.joints if joint.type != "fixed"})
    children = defaultdict(list)
    for joint in reader.robot.joints:
        children[joint.parent].append(joint.child)
    placed = {robot.description.root: np.eye(4)}
    pending = [robot.description.root]
    while pending:
        parent = pending.pop()
        for child in children[parent]:
            if child not in placed:
                placed[child] = placed[parent] @ reader.get_transform(child, parent)
                pending.append(child)
    return placed


def _our_links(robot: RobotModel, q: Array) -> dict[str, Array]:
    """Link → its placement (4, 4) in the root link, by Pinocchio."""
    data = robot.data
    pinocchio.framesForwardKinematics(robot.model, data, q)
    root = data.oMf[robot.frame_id(robot.description.root)]
    return {name: root.actInv(data.oMf[robot.frame_id(name)]).homogeneous for name in robot.description.links}


def _compared(
    robot: RobotModel, ours: Sequence[Mapping[str, Array]], theirs: Sequence[Mapping[str, Array]]
) -> SecondOpinion:
    names = [name for name in robot.description.links if name in theirs[0]]
    a, b = (np.array([[links[name] for name in names] for links in side]) for side in (ours, theirs))  # (k, n, 4, 4)
    apart = np.linalg.norm(a[..., :3, 3] - b[..., :3, 3], axis=-1)  # (k, n)
    # For rotations an angle θ apart ‖A − B‖ = 2√2 sin(θ/2); near 0 this is exact, unlike the arc cosine of a trace.
    chord = np.linalg.norm(a[..., :3, :3] - b[..., :3, :3], axis=(-2, -1)) / np.sqrt(8.0)
    turned = 2.0 * np.arcsin(np.minimum(chord, 1.0))
    far = np.maximum(np.linalg.norm(a[..., :3, 3], axis=-1), 1.0)
    same = ((apart <= TOLERANCE * far) & (turned <= TOLERANCE)).all(axis=0)  # False where yourdfpy returns NaN
    unmatched = tuple(sorted(ours[0].keys() ^ theirs[0].keys()))
    wrong = [name for name, agreed in zip(names, same, strict=True) if not agreed]
    return SecondOpinion(
        links=len(names),
        configurations=len(ours),
        position_difference_m=float(apart.max()),
        rotation_difference_rad=float(turned.max()),
        disagreeing=(*wrong, *unmatched),
        unmatched=unmatched,
        unmoved=tuple(joint.name for joint in robot.description.joints if joint.kind in NO_AXIS),
    )
