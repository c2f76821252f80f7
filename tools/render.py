"""Render robots to a PNG: `python tools/render.py ROBOT [--pose NAME | --angles JSON] [--out FILE.png]`.

pinik.shapes.meshes provides the shapes, Pinocchio the placements, and meshcat's three.js in Debian's chromium the
picture. The script needs the dev extra, which `make lint` installs, and `apt install chromium`. tools/hero.py uses it
to render docs/images/robots.png.
"""

from __future__ import annotations

import argparse
import base64
import json
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

import meshcat
import numpy as np
import trimesh
from numpy.typing import NDArray
from playwright.sync_api import sync_playwright

import pinik
from pinik.shapes.meshes import Color, load_shapes

HERE = Path(__file__).parent
CHROMIUM = "/usr/bin/chromium"
FLAGS = [
    "--no-sandbox",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
]
BALL_COLOR: Color = (0.90, 0.16, 0.14, 1.0)

Matrix = NDArray[np.float64]
Point = Sequence[float]


@dataclass
class Scene:
    """Coloured meshes in the world, z up."""

    parts: list[tuple[trimesh.Trimesh, Matrix, Color, float]] = field(default_factory=list)

    def add_robot(self, robot: pinik.Robot, q: Matrix, at: Matrix | None = None) -> None:
        """Add a robot at the configuration `q`, with its world placed at `at`."""
        shapes, warnings = load_shapes(robot)
        for warning in warnings:
            print(warning, file=sys.stderr)
        world = np.eye(4) if at is None else at
        for shape in shapes:
            placement = world @ robot.placement(shape.link, q).homogeneous @ shape.placement
            self.parts.append((shape.mesh, placement, shape.color, 0.55))

    def add_ball(self, position: Point, radius: float = 0.035, color: Color = BALL_COLOR) -> None:
        self.parts.append((trimesh.creation.icosphere(4, radius), translation(position), color, 0.35))

    def bounds(self) -> Matrix:
        """The opposite corners (2, 3) of the box around everything."""
        corners = [trimesh.transform_points(mesh.bounding_box.vertices, at) for mesh, at, _, _ in self.parts]
        points = np.vstack(corners)
        return np.stack([points.min(axis=0), points.max(axis=0)])


def translation(position: Point) -> Matrix:
    matrix = np.eye(4)
    matrix[:3, 3] = position
    return matrix


def turned(position: Point, yaw: float) -> Matrix:
    """A placement on the ground, facing `yaw` [deg]."""
    return translation(position) @ trimesh.transformations.rotation_matrix(np.deg2rad(yaw), (0, 0, 1))


def render(
    scene: Scene,
    out: Path,
    *,
    camera: Point | None = None,
    look_at: Point | None = None,
    size: tuple[int, int] = (900, 700),
    fov: float = 26.0,
    frames: int = 48,
    scale: float = 1.0,
    light: Point = (0.5, -0.7, 1.2),
    background: Sequence[float] = (0.93, 0.935, 0.94),
    ground: float | None = None,
) -> None:
    """Render the scene to a PNG of `size` pixels; the default camera looks at it diagonally from the front."""
    low, high = scene.bounds()
    middle, radius = (low + high) / 2, float(np.linalg.norm(high - low)) / 2
    target = middle if look_at is None else np.asarray(look_at, dtype=float)
    if camera is None:
        camera = target + np.array([0.75, -1.0, 0.35]) / 1.3 * radius / np.sin(np.deg2rad(fov) / 2) * 0.86
    described = {
        "background": list(background), "ground": float(low[2]) if ground is None else ground, "fov": fov,
        "camera": list(map(float, camera)), "look_at": list(map(float, target)), "radius": 1.6 * radius,
        "light": list(light), "softness": 0.25, "key": 0.72, "sky": 0.42, "fill": 0.16, "frames": frames,
        **_meshes(scene),
    }  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "scene.js").write_text(f"const scene = {json.dumps(described)};")
        meshcat_js = Path(meshcat.__file__).parent / "viewer" / "dist" / "main.min.js"
        page_text = (HERE / "render_page.html").read_text()
        page_text = page_text.replace("MESHCAT_JS", meshcat_js.as_uri()).replace("SCENE_JS", "scene.js")
        html = Path(folder) / "page.html"
        html.write_text(page_text)
        with sync_playwright() as playwright:
            browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
            width, height = size
            page = browser.new_page(viewport={"width": width, "height": height}, device_scale_factor=scale)
            print(f"rendering {out}, {frames} frames …", file=sys.stderr, flush=True)
            page.goto(html.as_uri(), timeout=600_000)
            page.wait_for_function("document.title != ''", timeout=600_000)
            if page.title() != "drawn":
                raise RuntimeError(page.title())
            page.screenshot(path=str(out), scale="device", timeout=600_000)
            browser.close()


def _meshes(scene: Scene) -> dict[str, object]:
    numbers: dict[int, int] = {}
    meshes, parts = [], []
    for mesh, placement, color, roughness in scene.parts:
        if id(mesh) not in numbers:
            numbers[id(mesh)] = len(meshes)
            arrays = {"vertices": mesh.vertices.astype("<f4"), "normals": mesh.vertex_normals.astype("<f4"),
                      "faces": mesh.faces.astype("<u4")}  # fmt: skip
            meshes.append({name: base64.b64encode(a.tobytes()).decode() for name, a in arrays.items()})
        parts.append(
            {"mesh": numbers[id(mesh)], "placement": placement.ravel().tolist(), "color": color,
             "roughness": roughness}
        )  # fmt: skip
    return {"meshes": meshes, "parts": parts}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("robot", help="a name from the catalogue, or a path")
    parser.add_argument("--pose", default="", help="a named pose of the SRDF")
    parser.add_argument("--angles", type=json.loads, help='JSON, such as {"elbow": 30}')
    parser.add_argument("--deg", action="store_true", help="the angles are in degrees")
    parser.add_argument("--out", type=Path, default=Path("robot.png"))
    parser.add_argument("--size", type=int, nargs=2, default=(900, 700), metavar=("W", "H"))
    parser.add_argument("--camera", type=float, nargs=3)
    parser.add_argument("--look-at", type=float, nargs=3)
    parser.add_argument("--ball", type=float, nargs=3, action="append", default=[], metavar=("X", "Y", "Z"))
    parser.add_argument("--frames", type=int, default=48, help="how many are averaged; more are smoother and slower")
    parser.add_argument("--scale", type=float, default=1.0, help="device pixels per pixel")
    arguments = parser.parse_args()
    robot = pinik.load(arguments.robot)
    if arguments.angles:
        unit = np.pi / 180 if arguments.deg else 1.0
        q = robot.configuration({name: unit * angle for name, angle in arguments.angles.items()})
    else:
        q = robot.poses[arguments.pose] if arguments.pose else robot.neutral()
    scene = Scene()
    scene.add_robot(robot, q)
    for position in arguments.ball:
        scene.add_ball(position)
    render(
        scene, arguments.out, camera=arguments.camera, look_at=arguments.look_at, size=tuple(arguments.size),
        frames=arguments.frames, scale=arguments.scale,
    )  # fmt: skip


if __name__ == "__main__":
    main()
