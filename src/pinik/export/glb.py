"""Robots that move as binary glTF 2.0 files (.glb), which browsers, Blender and many viewers play."""

from __future__ import annotations

import os

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..files import write_whole
from ..model.home import robot_size
from ..picture.arguments import as_color
from ..picture.draw import BALL, PINNED
from ..picture.solids import Solid, ball, rod
from .gltf import Document
from .keys import filled_in, places_of, turned_the_short_way
from .live_recording import RecordedBall
from .plate import CORNERS, plate, printed_name
from .scene import ARM, Actor, Scene, Shown, check_suffix, scene_of
from .surfaces import cleaned

__all__ = ["glb_of", "save_glb"]

Array = NDArray[np.float64]

# In URDF x points forward, y to the left and z up; in glTF z points forward, x to the left and y up.
_AS_IN_GLTF = (-0.5, -0.5, -0.5, 0.5)
_AXES = {"x": "#e5484d", "y": "#3d9a50", "z": "#3b7ddd"}  # those of a ball that asks for an orientation
_THIN = 0.13  # how thick they are, of a ball's radius
_HIGH = 0.09  # a plate, of the robot's size
_WIDEST = 0.94  # a plate, of the distance of neighbours


def save_glb(
    shown: Shown, path: str | os.PathLike[str], q: ArrayLike | None = None, *, times: ArrayLike | None = None
) -> None:
    """Write a robot with its visual shapes, at one configuration or moving through several, as a .glb file.

    Its root is a node with the robot's name, which faces the viewer. Below it each link is a node of its own name,
    placed in its parent link [m]. With several configurations they are the keys of one animation that begins at 0 s,
    with others between them where a joint turns farther than 60° or slides farther than about 1 m; between keys,
    joints move evenly.

    The robots of a live view stand side by side, each below a node with the name of its method, which begins all names
    below it ("dls tip"), together with a plate on which the method is written and the balls ("dls ball tip").

    Args:
        shown: A solution, a track, a self-motion or the `recording()` of a live view; or a robot with `q`.
        path: The file; its name ends with ".glb".
        q: A configuration (nq,) or several (n, nq) of a robot; its rest configuration when None.
        times: When it is at each (n,) [s], increasing; those of a track or a recording, or 30 a second, when None.

    Raises:
        InputError: An argument has another kind, shape or range, or the robot has no shapes.
        MissingExtraError: trimesh or Pillow is not installed.
        OSError: The file cannot be written.

    Warns:
        UrdfWarning: Some shapes could not be read.
    """
    file = check_suffix(path, ".glb")
    scene = scene_of(shown, q, times)
    scene.warn()
    write_whole(file, glb_of(scene))


def glb_of(scene: Scene) -> bytes:
    """The content of a .glb file. It may be made in any thread."""
    return _Writer(scene).content()


class _Writer:
    def __init__(self, scene: Scene) -> None:
        self._scene = scene
        self._document = Document(scene.robot.name, _AS_IN_GLTF)
        self._shapes: dict[str, list[tuple[str, int, Array]]] = {}
        for shape in scene.shapes:
            name = shape.name.replace("/", " ")  # three.js leaves strokes out
            solid = cleaned(Solid.of(shape.mesh))
            if len(solid.faces):
                mesh = self._document.mesh(name, [(solid, self._document.paint(shape.color))])
                self._shapes.setdefault(shape.link, []).append((name, mesh, shape.placement))
        self._parents = {joint.child: joint.parent for joint in scene.robot.description.joints}
        self._links = _from_the_root(self._parents, scene.robot.description.links)
        self._balls = [self._ball(one) for one in scene.balls]
        for actor, offset in zip(scene.actors, scene.offsets, strict=True):
            self._add(actor, offset)

    def content(self) -> bytes:
        return self._document.content()

    def _add(self, actor: Actor, offset: Array) -> None:
        """Add a robot, its balls, and its name if it has one."""
        document, scene = self._document, self._scene
        world = document.node(actor.name, document.root, translation=offset.tolist()) if actor.name else document.root
        q, times = filled_in(scene.robot, actor.q, scene.times)
        nodes: dict[str, int] = {}
        for link in self._links:
            parent = self._parents.get(link)
            nodes[link] = document.node(actor.part(link), world if parent is None else nodes[parent])
            document.move(nodes[link], times - times[0], *places_of(scene.robot, link, q, parent))
            for name, mesh, placement in self._shapes.get(link, ()):
                at = {} if np.array_equal(placement, np.eye(4)) else {"matrix": placement.T.ravel().tolist()}
                document.node(actor.part(name), nodes[link], mesh=mesh, **at)
        for one, mesh in zip(scene.balls, self._balls, strict=True):
            node = document.node(actor.part(f"ball {one.frame}"), world, mesh=mesh)
            turns = turned_the_short_way(one.quat_xyzw)
            document.move(node, scene.times - scene.times[0], one.positions, turns)
        if actor.title:
            self._name(actor, world)

    def _name(self, actor: Actor, world: int) -> None:
        picture, shape = printed_name(actor.title, actor.color)
        offsets = self._scene.offsets[:, 1]
        widest = _WIDEST * (offsets[1] - offsets[0]) if len(offsets) > 1 else np.inf
        height = min(_HIGH * robot_size(self._scene.robot), widest / shape)
        material = self._document.printed(actor.title, picture)
        mesh = self._document.mesh(actor.title, [(plate(shape * height, height), material)], CORNERS)
        self._document.node(actor.part("name"), world, mesh=mesh, translation=self._scene.plate.tolist())

    def _ball(self, one: RecordedBall) -> int:
        """The mesh of a ball, with three arms if it asks for an orientation."""
        radius = self._scene.ball_radius
        skin = self._document.paint((*as_color(PINNED if one.pinned else BALL, "color"), 1.0), 0.3, 0.0)
        surfaces = [(ball(np.zeros(3), radius), skin)]
        if one.oriented:
            for along, color in zip(np.eye(3), _AXES.values(), strict=True):
                arm = rod(np.zeros(3), ARM * radius * along, _THIN * radius, _THIN * radius)
                surfaces.append((arm, self._document.paint((*as_color(color, "color"), 1.0))))
        return self._document.mesh("ball", surfaces)


def _from_the_root(parents: dict[str, str], links: tuple[str, ...]) -> list[str]:
    """All links, each after its parent."""
    children: dict[str, list[str]] = {}
    for link in links:
        if link in parents:
            children.setdefault(parents[link], []).append(link)
    found = [link for link in links if link not in parents]
    for link in found:  # which grows meanwhile
        found += children.get(link, ())
    return found
