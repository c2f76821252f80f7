"""What the live view promises in seconds and megabytes, measured in a real browser.

    python benchmarks/live_view.py start      from `pinik live` to a drawn robot: Panda first and second time, arm; and
                                              `import pinocchio` in a process of its own, for scale
    python benchmarks/live_view.py steps      solver time a step of four arms with four methods along a curve
    python benchmarks/live_view.py rest       processor time of a server where nothing moves, and that nobody looks at
    python benchmarks/live_view.py drag       from pointer event to the ball's new place at the server, and back
    python benchmarks/live_view.py endure     60 s of four lions with all effectors: memory, queues, pace

It needs the dev extras and Debian's chromium. Timings differ from machine to machine; compare within one run. Processes
that are timed may keep the bytecode of modules, as that of an installed package is kept.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import queue
import statistics
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page, sync_playwright

import pinik
from pinik.viewer.simulation.session import Session

CHROMIUM = "/usr/bin/chromium"
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
         "--disable-background-networking", "--enable-precise-memory-info"]  # fmt: skip
VIEWPORT = {"width": 1280, "height": 720}


@contextmanager
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        yield chromium
        chromium.close()


@contextmanager
def live(*arguments: str, **environment: str) -> Iterator[tuple[subprocess.Popen[str], str]]:
    """`pinik live` in a process of its own, and the address that it prints."""
    command = [sys.executable, "-m", "pinik", "live", *arguments, "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                          env=with_bytecode(**environment)) as process:  # fmt: skip
        try:
            yield process, process.stdout.readline().strip()
        finally:
            process.terminate()


def with_bytecode(**environment: str) -> dict[str, str]:
    """The environment of this process, with some variables, in which Python keeps bytecode."""
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    return {**kept, **environment}


def seconds_to_import(module: str) -> float:
    """How long a Python of its own takes to begin, to import a module and to end."""
    began = time.perf_counter()
    subprocess.run([sys.executable, "-c", f"import {module}"], check=True, env=with_bytecode())
    return time.perf_counter() - began


def processor_seconds(pid: int) -> float:
    """The processor time that a process has used, from /proc."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def state_of(url: str) -> dict[str, Any]:
    with urllib.request.urlopen(f"{url}api/state") as answer:
        return json.load(answer)


def resident_megabytes(pid: int) -> float:
    """The process's resident size, from /proc."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def drawn_after(page: Page, robot: str, cache: str, began: float) -> float:
    """Seconds from `began` until the page, in a browser that is open already, has drawn the robot's own shapes."""
    with live(robot, PINIK_CACHE_DIR=cache) as (_, url):
        page.goto(url)
        page.wait_for_function("() => window.pinik?.drawn === 'shapes'", timeout=60_000)
        return time.perf_counter() - began


def measure_start(rounds: int) -> dict[str, float]:
    """Medians over `rounds`, each with an empty cache first."""
    figures: dict[str, list[float]] = {}
    with browser() as chromium:
        for _ in range(rounds):
            for module in ("pinocchio", "pinik"):
                figures.setdefault(f"import {module}", []).append(seconds_to_import(module))
            with tempfile.TemporaryDirectory() as cache:
                for name, robot in (("panda, first", "panda"), ("panda, then", "panda"), ("arm, first", "arm"),
                                    ("arm, then", "arm")):  # fmt: skip
                    page = chromium.new_page(viewport=VIEWPORT, bypass_csp=True)
                    figures.setdefault(name, []).append(drawn_after(page, robot, cache, time.perf_counter()))
                    page.close()
    return {f"{name} [s]": statistics.median(values) for name, values in figures.items()}


def measure_steps(steps: int) -> dict[str, float]:
    """Median solver time a step [µs] of four arms along a curve, by method, without a page."""
    session = Session(pinik.load("arm"))
    session.set_motion("curve")
    times: dict[str, list[float]] = {}
    for _ in range(steps):
        session.step()
        for one in session.seen:
            times.setdefault(one.solver.name, []).append(one.last.time)
    return {f"{name}, solver time a step [µs]": 1e6 * statistics.median(spent) for name, spent in times.items()}


def measure_rest(seconds: float) -> dict[str, float]:
    """The share of one core that a server takes [%] while nothing moves before a tab, and without one."""
    figures = {}
    with live("arm") as (process, url), browser() as chromium:
        page = chromium.new_page(viewport=VIEWPORT, bypass_csp=True)
        page.goto(url)
        page.wait_for_function("() => window.pinik?.ready", timeout=60_000)
        page.get_by_test_id("motion").select_option("hand")
        for name in ("a tab, nothing moves", "no tab"):
            time.sleep(15.0)  # until the session rests, or the server has noticed that nobody is there
            used, began = processor_seconds(process.pid), time.perf_counter()
            time.sleep(seconds)
            share = (processor_seconds(process.pid) - used) / (time.perf_counter() - began)
            figures[f"{name} [% of a core]"] = 100 * share
            if not page.is_closed():
                page.get_by_test_id("motion").select_option("curve")
                page.close()
    return figures


def measure_drag(moves: int) -> dict[str, float]:
    """Milliseconds from a pointer event in the page to the server's having put the ball where it pointed."""
    arrivals: queue.SimpleQueue[float] = queue.SimpleQueue()
    with pinik.live("arm", port=0, motion="hand") as view, browser() as chromium:
        show = view._show
        do = show.do

        def noted(message: dict[str, Any]) -> None:
            do(message)
            if message["type"] == "ball":
                arrivals.put(1e3 * time.time())

        show.do = noted
        page = chromium.new_page(viewport=VIEWPORT, bypass_csp=True)
        page.goto(view.url)
        page.wait_for_function("() => window.pinik?.ready && window.pinik.still", timeout=60_000)
        page.evaluate(
            "addEventListener('pointerrawupdate', e => window.lastMove = performance.timeOrigin + e.timeStamp, true)"
        )
        at = page.evaluate("window.pinik.targetOnScreen(0)")
        page.mouse.move(at["x"], at["y"])
        page.mouse.down()
        delays = []
        for k in range(moves):
            page.mouse.move(at["x"] + 3 * (k % 20) + 3, at["y"] - 2 * (k % 13) - 2)
            arrived = arrivals.get(timeout=10.0)
            delays.append(arrived - page.evaluate("window.lastMove"))
        page.mouse.up()
    return {"pointer event to server, median [ms]": statistics.median(delays),
            "pointer event to server, 90 % [ms]": statistics.quantiles(delays, n=10)[-1]}  # fmt: skip


def measure_endurance(seconds: float) -> dict[str, float]:
    """Four lions, six balls each on a curve: what grows."""
    with live("lion", "--root", "free_flyer") as (process, url), browser() as chromium:
        page = chromium.new_page(viewport=VIEWPORT, bypass_csp=True)
        page.goto(url)
        page.wait_for_function("() => window.pinik?.ready", timeout=60_000)
        for index in range(6):
            page.get_by_test_id(f"ball-mode-{index}").select_option("on")
        time.sleep(10.0)  # until the recording's ring is half full and the page's caches are warm
        sizes, heaps, steps, began = [], [], state_of(url)["step"], time.perf_counter()
        while time.perf_counter() - began < seconds:
            sizes.append(resident_megabytes(process.pid))
            heaps.append(page.evaluate("performance.memory.usedJSHeapSize") / 1e6)
            time.sleep(1.0)
        pace = (state_of(url)["step"] - steps) / (time.perf_counter() - began)
        late = page.evaluate("window.pinik.state.step") - state_of(url)["step"]
    third = len(sizes) // 3
    return {
        "server, first third [MB]": statistics.mean(sizes[:third]),
        "server, last third [MB]": statistics.mean(sizes[-third:]),
        "page's heap, first third [MB]": statistics.mean(heaps[:third]),
        "page's heap, last third [MB]": statistics.mean(heaps[-third:]),
        "steps a second": pace,
        "steps that the page's state lags": -late,
    }


def main() -> None:
    """Measure what was asked for and print it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("start", "steps", "rest", "drag", "endure"))
    parser.add_argument("--rounds", type=int, default=3, help="of start")
    parser.add_argument("--moves", type=int, default=100, help="of drag")
    parser.add_argument("--seconds", type=float, default=60.0, help="of steps (60 a second), rest and endure")
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    figures = {
        "start": lambda: measure_start(arguments.rounds),
        "steps": lambda: measure_steps(round(60 * arguments.seconds)),
        "rest": lambda: measure_rest(arguments.seconds),
        "drag": lambda: measure_drag(arguments.moves),
        "endure": lambda: measure_endurance(arguments.seconds),
    }[arguments.what]()
    about = (
        f"pinik {pinik.__version__}, Python {platform.python_version()}, {platform.machine()}, {os.cpu_count()} cores"
    )
    if arguments.json:
        print(json.dumps({"schema": 1, "about": about, "figures": figures}))
        return
    print(f"# {about}, chromium with software rendering")
    for name, value in figures.items():
        print(f"{name:42} {value:10.2f}")


if __name__ == "__main__":
    main()
