"""Copied text is run: the Python and the command give the answer that the session's own question has."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
from pathlib import Path
from xml.sax.saxutils import escape

import numpy as np
import pinocchio
import pytest

import pinik
from pinik.viewer.protocol.copying import texts_to_copy
from pinik.viewer.protocol.pasting import paste_angles, read_angles
from pinik.viewer.simulation.by_hand import set_angles
from pinik.viewer.simulation.session import Session
from robots import load_quietly
from stand_ins import Clock
from urdf_texts import joint, link, robot

PINIK = str(Path(sys.executable).with_name("pinik"))


def texts(session, instance=0):
    return {each["name"]: each["text"] for each in texts_to_copy(session, instance)}


def run_python(text):
    names: dict[str, object] = {}
    exec(compile(text, "copied", "exec"), names)
    return names


def run_command(text):
    command = text.replace("pinik solve", f"{PINIK} solve --json", 1).replace("pinik fk", f"{PINIK} fk --json", 1)
    done = subprocess.run([shutil.which("sh"), "-c", command], capture_output=True, text=True, check=False)
    assert done.returncode in (0, 1), done.stderr
    return json.loads(done.stdout)


@pytest.mark.parametrize("goal", [[0.4, 0.2, 0.8], [3.0, 0.0, 0.5]], ids=["reached", "missed"])
def test_the_question_gives_the_same_answer_in_python_and_on_the_command_line(goal, capsys):
    panda = load_quietly("panda")
    shown = Session(panda, [pinik.DampedLeastSquares(damping=0.2, max_step=0.3), "ccd"], clock=Clock())
    shown.change_settings(tolerance=pinik.Tolerance(0.002, 0.02))
    shown.balls[0].orient(True, [3.0, 0.1, 0.2])
    shown.balls[0].tolerate(pinik.Tolerance((0.01, 0.01, 0.001), 0.3))
    shown.add_ball("panda_link5")
    shown.balls[1].release("xy")
    set_angles(shown, None, {"panda_joint1": 0.3, "panda_joint2": -0.4})
    shown.move_ball(0, goal)
    method = pinik.DampedLeastSquares(damping=0.2, max_step=0.3)
    own = panda.solve(
        shown.balls.targets, method=method, q0=shown.instances[0].q, restarts=0,
        tolerance=(0.002, 0.02), polish=False,
    )  # fmt: skip
    copied = texts(shown)
    solution = run_python(copied["question.py"])["solution"]
    assert own.message in capsys.readouterr().out
    np.testing.assert_allclose(solution.q, own.q, atol=1e-12)
    answer = run_command(copied["question.sh"])
    np.testing.assert_allclose(answer["q"], own.q, atol=1e-9)
    assert answer["status"] == own.status.name
    assert json.loads(copied["question.json"])["targets"] == [target.to_dict() for target in shown.balls.targets]


def test_limits_own_files_and_free_roots_are_in_the_text(tmp_path):
    here = tmp_path / "it's a robot.urdf"
    plain = ET.parse(load_quietly("two_link").description.path)
    for tag in plain.getroot().findall("link"):
        for shape in [*tag.findall("visual"), *tag.findall("collision")]:
            tag.remove(shape)
    plain.write(here)
    shown = Session(pinik.load(here), ["pinv"], clock=Clock())
    shown.change_settings(limits=False)
    copied = texts(shown)
    solution = run_python(copied["question.py"])["solution"]
    assert solution.robot.description.path == here
    assert "limits=False" in copied["question.py"]
    np.testing.assert_allclose(run_command(copied["question.sh"])["q"], solution.q, atol=1e-9)
    lion = load_quietly("lion", root="free_flyer")
    walking = Session(lion, ["dls"], clock=Clock())
    walking.move_ball(0, walking.balls[0].position + np.array([0.1, 0.0, 0.1]))
    walking.step()
    copied = texts(walking)
    np.testing.assert_allclose(run_python(copied["pose.py"])["q"], walking.instances[0].q, atol=1e-9)
    for form in ("question.sh", "pose.sh", "pose.yaml"):
        assert copied[form].startswith('# left out here: the placement of "root_joint", which the Python has\n')
    assert run_command(copied["pose.sh"])["joint_placements"]["root_joint"] == np.eye(4).tolist()
    assert "#" not in "".join(copied[form] for form in ("pose.py", "pose.json", "question.py"))


@pytest.mark.parametrize("root", ["free_flyer", "planar"])
def test_a_free_root_comes_back_with_the_json_and_stays_where_it_is_with_the_yaml(root):
    arm = load_quietly("arm", root=root)
    shown = Session(arm, ["dls"], clock=Clock())
    moved = arm.random(np.random.default_rng(3))
    shown.instances[0].put(moved)
    copied = texts(shown)
    for form, pose in (("pose.json", moved), ("pose.yaml", arm.configuration(arm.angles(moved)))):
        other = Session(arm, ["dls", "ccd"], clock=Clock())
        other.instances[0].put(arm.neutral())
        paste_angles(other, None, copied[form])
        for one in other.seen:
            distance = pinocchio.distance(arm.model, one.q, pose)
            np.testing.assert_allclose(distance, 0.0, atol=1e-7)


def test_the_pose_comes_back_from_each_of_its_forms():
    tiago = load_quietly("tiago")  # continuous joints
    shown = Session(tiago, ["dls"], clock=Clock())
    set_angles(shown, None, {name: 0.1 + 0.01 * k for k, name in enumerate(tiago.joint_names[:4])})
    q, copied = shown.instances[0].q, texts(shown)
    np.testing.assert_allclose(run_python(copied["pose.py"])["q"], q, atol=1e-12)
    for form in ("pose.json", "pose.yaml"):
        np.testing.assert_allclose(tiago.configuration(read_angles(tiago, copied[form])), q, atol=1e-12)
    np.testing.assert_allclose(run_command(copied["pose.sh"])["q"], q, atol=1e-12)


NAMES = ["no", "on", "joint é 1", "joint #2", 'say "hi": 3', "back\\slash", "1e3", "~", "\u2028 line"]


def test_yaml_comes_back_whatever_the_joints_are_called():
    chain = [link(f"link{k}") for k in range(len(NAMES) + 1)]
    hinges = [joint(escape(name, {'"': "&quot;"}), f"link{k}", f"link{k + 1}") for k, name in enumerate(NAMES)]
    odd = pinik.load(robot(*chain, *hinges))
    assert list(odd.joint_names) == NAMES
    shown = Session(odd, ["dls"], clock=Clock())
    angles = {name: 0.01 * k for k, name in enumerate(NAMES)}
    set_angles(shown, None, angles)
    assert read_angles(odd, texts(shown)["pose.yaml"]) == pytest.approx(angles)


def test_without_balls_there_is_no_question_and_only_visible_instances_have_text(arm):
    shown = Session(arm, ["dls"], clock=Clock())
    shown.set_mode(0, "off")
    assert set(texts(shown)) == {"pose.py", "pose.sh", "pose.json", "pose.yaml"}
    with pytest.raises(pinik.InputError, match="from 0 to 0; got 1"):
        texts_to_copy(shown, 1)
