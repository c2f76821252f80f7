"""The messages that tell where everything stands, against the documentation and the session."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import pinik
from pinik.description.catalog import catalog
from pinik.motion.curves import CURVES
from pinik.viewer.protocol.messages import RANGES
from pinik.viewer.protocol.state import hello_message, session_state
from pinik.viewer.simulation.session import Session
from pinik.viewer.simulation.standing import STATUSES
from pinik.viewer.web.show import Show
from robots import load_quietly
from stand_ins import Clock, Later

PROTOCOL = (Path(__file__).parents[3] / "docs" / "live-protocol.md").read_text("utf-8")


def documented(kind):
    """The example of a message in docs/live-protocol.md."""
    examples = [json.loads(block) for block in re.findall(r"```json\n(.*?)```", PROTOCOL, re.DOTALL)]
    return next(example for example in examples if example["type"] == kind)


def keys(value):
    """All names in a message; for a list, those in its first element."""
    if isinstance(value, dict):
        return {name: keys(inner) for name, inner in value.items()}
    if isinstance(value, list) and value and isinstance(value[0], dict):
        return [keys(value[0])]
    return None


def strict(message):
    return json.loads(json.dumps(message, allow_nan=False))


def test_hello_is_what_the_documentation_shows():
    hello = strict(hello_message("1.2", dict(pinik.SOLVERS), ["own"], "5f"))
    assert keys(hello) == keys(documented("hello"))
    assert hello["robots"] == ["own", *catalog()]
    assert [m["name"] for m in hello["methods"]] == ["ccd", "jt", "pinv", "dls"]
    assert [m["title"] for m in hello["methods"]] == [cls.title for cls in pinik.SOLVERS.values()]
    assert hello["views"] == [1, 2, 4]
    assert hello["statuses"] == list(STATUSES)
    assert [c["name"] for c in hello["curves"]] == list(CURVES)
    assert hello["motions"] == documented("hello")["motions"]
    assert hello["ranges"] == {**{name: list(ends) for name, ends in RANGES.items()}, "reach": 100.0}
    assert (hello["version"], hello["steps_per_second"]) == ("1.2", 60)


def without_angles(state):
    for one in state["instances"]:
        one["angles"] = {}
    return state


def test_a_state_has_the_fields_of_the_documentation(arm):
    session = Session(arm, clock=Clock())
    session.set_motion("curve")
    session.obstacles.add("box", [0.2, 0.2, 0.2], [0.4, 0.1, 0.3])
    session.step()
    state = strict(Show(session, Later()).state())
    shown, told = keys(without_angles(state)), keys(without_angles(documented("state")))
    shown["instances"][0]["parameters"][0].pop("whole", None)
    told["instances"][0]["parameters"][0].pop("whole", None)
    assert shown == told


def test_a_state_tells_the_session(arm):
    session = Session(arm, [pinik.CCD(relaxation=0.5), "dls"], clock=Clock())
    session.add_ball("bone2")
    session.set_mode(1, "pinned")
    session.balls[1].orient(True, [0.1, 0.2, 0.3])
    session.balls[1].release("xy")
    session.balls[1].tolerate(pinik.Tolerance((0.01, 0.02, 0.03), 0.4))
    session.set_motion("curve")
    session.set_curve("wave")
    session.motion.speed = 1.5
    session.change_settings(tolerance=pinik.Tolerance(0.001, 0.01))
    session.change_settings(limits=False)
    session.running = True
    for _ in range(5):
        session.tick()
    session.scores.cover("last")
    state = strict(session_state(session))
    assert (state["robot"], state["root"], state["view"], state["running"]) == ("arm", "fixed", 2, True)
    assert (state["motion"], state["curve"], state["speed"], state["limits"]) == ("curve", "wave", 1.5, False)
    assert state["tolerance"] == {"position": 0.001, "orientation": 0.01}
    assert state["step"] == 5
    first, second = state["balls"]
    assert (first["frame"], first["mode"], len(first["curve"])) == ("tip", "on", 128)
    assert first["position"] == session.balls[0].position.tolist()
    assert (second["frame"], second["mode"], second["curve"], second["oriented"]) == ("bone2", "pinned", [], True)
    assert second["rpy"] == [0.1, 0.2, 0.3]
    assert (first["free"], first["tolerance"]) == ("", None)
    assert (second["free"], second["tolerance"]) == ("xy", [[0.01, 0.02, 0.03], 0.4])
    assert [one["method"] for one in state["instances"]] == ["ccd", "dls"]
    relaxation = next(p for p in state["instances"][0]["parameters"] if p["name"] == "relaxation")
    assert (relaxation["value"], relaxation["default"]) == (0.5, None)
    for told, one in zip(state["instances"], session.seen, strict=True):
        assert told["angles"] == pytest.approx(arm.angles(one.q))
        assert told["statistics"]["steps"] == 5
        assert told["position_error"] >= 0.0
    assert state["joint_names"] == list(arm.joint_names)


def test_nothing_to_tell_is_null(arm):
    state = strict(session_state(Session(arm, ["jt"], clock=Clock())))
    (one,) = state["instances"]
    assert (one["status"], one["position_error"], one["orientation_error"], one["active_limits"]) == (
        "IDLE",
        None,
        None,
        [],
    )
    assert one["statistics"] == {
        name: 0 if name in ("steps", "busy", "cut_off") else None for name in one["statistics"]
    }


@pytest.mark.parametrize("name", ["hector", "tiago", "lion", "talos"])
def test_every_robots_state_is_strict_json(name):
    session = Session(load_quietly(name, root="free_flyer"), clock=Clock())
    session.set_motion("random")
    session.step()
    strict(session_state(session))
