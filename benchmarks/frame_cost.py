"""What one frame of four robots costs pinik's live view, and Pinocchio's MeshcatVisualizer, without a browser.

Both show the same configurations, those of a running session with damped least squares, in turns:

* pinik: one tick of the live view less the solving (placements, packing, recording, handing to one websocket client,
  four times a second the state), and taking that client's answer. The client is a process of its own.
* MeshcatVisualizer: `display` for each robot; meshcat's server is a process of its own, with no browser.

    python benchmarks/frame_cost.py --frames 300

The live view's bar is a median of 2 ms (with `--check`, missing it is exit status 1).
"""

from __future__ import annotations

import argparse
import asyncio
import contextlib
import json
import os
import platform
import subprocess
import sys
import time
import warnings
from importlib.metadata import version

import numpy as np
import pinocchio
import tornado.httpserver
import tornado.netutil
from pinocchio.visualize import MeshcatVisualizer

import pinik
from pinik.description.shares import example_robot_data
from pinik.viewer.simulation.session import Session
from pinik.viewer.web.guests import Guests
from pinik.viewer.web.heartbeat import Heartbeat
from pinik.viewer.web.scene import Shapes
from pinik.viewer.web.seats import Tab
from pinik.viewer.web.server import make_server
from pinik.viewer.web.show import Show

BAR = 2.0  # [ms]
ROBOTS = 4
WARM_UP = 30  # frames that are not counted

CLIENT = """
import asyncio, json, struct, sys, tornado.websocket

async def main():
    server = await tornado.websocket.websocket_connect(sys.argv[1])
    while (message := await server.read_message()) is not None:
        if isinstance(message, bytes) and message[:4] == b"PNKF":
            (step,) = struct.unpack_from("<8xI", message)
            await server.write_message(json.dumps({"type": "drawn", "step": step}))

asyncio.run(main())
"""


class TimedSession(Session):
    """A session that says how long its last tick took [s]."""

    spent = 0.0

    def tick(self) -> bool:
        began = time.perf_counter()
        stepped = super().tick()
        self.spent = time.perf_counter() - began
        return stepped


class TimedShow(Show):
    """A show that says when a frame was answered."""

    def __init__(self, session: Session) -> None:
        self.answered = asyncio.Event()
        super().__init__(session, later=lambda work, then: then(Shapes((), (), ())))  # shapes are not measured

    def receive(self, tab: Tab, message_text: str) -> None:
        super().receive(tab, message_text)
        self.answered.set()


def visualizers(robot: pinik.Robot) -> list[MeshcatVisualizer]:
    """Four of Pinocchio's, side by side in one viewer of meshcat."""
    model, path = robot.model, robot.description.path
    folders = [str(example_robot_data().parent.parent), str(path.parent)]
    shapes = pinocchio.buildGeomFromUrdf(model, str(path), pinocchio.GeometryType.VISUAL, package_dirs=folders)
    made: list[MeshcatVisualizer] = []
    for k in range(ROBOTS):
        each = MeshcatVisualizer(model, pinocchio.GeometryModel(), shapes)
        each.initViewer(viewer=made[0].viewer if made else None)
        each.loadViewerModel(f"robot{k}")
        made.append(each)
    return made


async def measure(name: str, frames: int) -> dict[str, list[float]]:
    """Seconds of each frame: `solving`, pinik's `frame` and its `answer`, MeshcatVisualizer's `display`."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", pinik.UrdfWarning)
        robot = pinik.load(name)
    session = TimedSession(robot, ["dls"] * ROBOTS, view=ROBOTS)
    session.set_motion("curve")
    session.running = True
    show = TimedShow(session)
    listening = tornado.netutil.bind_sockets(0, "127.0.0.1")
    server = make_server(show, Heartbeat(lambda: None, lambda: True), Guests(), "127.0.0.1", "")
    server.add_sockets(listening)
    address = f"ws://127.0.0.1:{listening[0].getsockname()[1]}/ws"
    with contextlib.redirect_stdout(sys.stderr):
        pinocchios = visualizers(robot)
    client = await asyncio.create_subprocess_exec(sys.executable, "-c", CLIENT, address)
    times: dict[str, list[float]] = {"solving": [], "frame": [], "answer": [], "display": []}
    try:
        await asyncio.wait_for(show.answered.wait(), 30.0)
        for _ in range(WARM_UP + frames):
            show.answered.clear()
            began = time.perf_counter()
            show.tick()
            times["frame"].append(time.perf_counter() - began - session.spent)
            times["solving"].append(session.spent)
            began = time.thread_time()  # the waiting for the client is no work
            await asyncio.wait_for(show.answered.wait(), 30.0)
            times["answer"].append(time.thread_time() - began)
            began = time.perf_counter()
            for visualizer, instance in zip(pinocchios, session.seen, strict=True):
                visualizer.display(instance.q)
            times["display"].append(time.perf_counter() - began)
    finally:
        client.kill()
        await client.wait()
        server.stop()
        await server.close_all_connections()
        meshcat_server = pinocchios[0].viewer.window.server_proc
        meshcat_server.kill()
        meshcat_server.communicate()
    return {what: seconds[WARM_UP:] for what, seconds in times.items()}


def machine() -> str:
    with contextlib.suppress(OSError, subprocess.CalledProcessError):
        found = subprocess.run(
            ["lscpu", "--json"], capture_output=True, text=True, check=True, env={**os.environ, "LC_ALL": "C"}
        )
        for field in json.loads(found.stdout)["lscpu"]:
            if field["field"] == "Model name:":
                return f"{field['data']}, {os.cpu_count()} cores, {platform.platform()}"
    return f"{platform.machine()}, {os.cpu_count()} cores, {platform.platform()}"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", default="panda", help="a name of the catalogue")
    parser.add_argument("--frames", type=int, default=300)
    parser.add_argument("--json", action="store_true")
    parser.add_argument("--check", action="store_true", help=f"fail where pinik's median is above {BAR} ms")
    arguments = parser.parse_args()
    times = asyncio.run(measure(arguments.robot, arguments.frames))
    ms = {what: 1e3 * np.array(seconds) for what, seconds in times.items()}
    ms["pinik"] = ms.pop("frame") + ms.pop("answer")
    packages = {name: version(name) for name in ("pin", "meshcat", "tornado", "numpy")}
    result = {
        "robots": f"{ROBOTS} × {arguments.robot}",
        "frames": arguments.frames,
        "pinik_median_ms": float(np.median(ms["pinik"])),
        "pinik_p95_ms": float(np.percentile(ms["pinik"], 95)),
        "meshcat_visualizer_median_ms": float(np.median(ms["display"])),
        "meshcat_visualizer_p95_ms": float(np.percentile(ms["display"], 95)),
        "ratio": float(np.median(ms["display"]) / np.median(ms["pinik"])),
        "solving_median_ms": float(np.median(ms["solving"])),
        "bar_ms": BAR,
        "machine": machine(),
        "versions": {"pinik": pinik.__version__, "python": platform.python_version(), **packages},
    }
    if arguments.json:
        print(json.dumps(result))
    else:
        for what, value in result.items():
            print(f"{what:30} {value:.3f}" if isinstance(value, float) else f"{what:30} {value}")
    return int(arguments.check and result["pinik_median_ms"] > BAR)


if __name__ == "__main__":
    sys.exit(main())
