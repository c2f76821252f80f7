from __future__ import annotations

import numpy as np
import pinocchio
import pytest

from pinik.description.catalog import find


@pytest.mark.parametrize("axes", ["local_world_aligned", "local", "world"])
def test_the_matrix_is_pinocchios(run, axes):
    answer = run("jacobian", "arm", "--frame", "tip", "--set", "bone1_x=0.3", "--axes", axes, "--json").json
    model = pinocchio.buildModelFromUrdf(str(find("arm").urdf))
    frame = model.getFrameId("tip", pinocchio.BODY)
    axes_of = pinocchio.ReferenceFrame.names[axes.upper()]
    expected = pinocchio.computeFrameJacobian(model, model.createData(), np.array(answer["q"]), frame, axes_of)
    assert np.allclose(answer["jacobian"], expected, atol=1e-12)
    assert answer["columns"] == [name for name in model.names if name != "universe"]


def test_joints_with_several_motions_have_a_column_each(run):
    answer = run("jacobian", "panda", "--frame", "panda_hand", "--root", "free_flyer", "--json").json
    assert answer["columns"][:6] == [f"root_joint.{row}" for row in answer["rows"]]
    assert np.shape(answer["jacobian"]) == (6, len(answer["columns"]))
    assert "panda_finger_joint2" not in answer["columns"]
    planar = run("jacobian", "panda", "--frame", "panda_hand", "--root", "planar", "--json").json
    assert planar["columns"][:4] == ["root_joint.vx", "root_joint.vy", "root_joint.wz", "panda_joint1"]


def test_the_table_has_a_line_for_each_column(run):
    answer = run("jacobian", "arm", "--frame", "tip", "--json").json
    lines = run("jacobian", "arm", "--frame", "tip").out.splitlines()
    assert lines[0].split() == ["joint", *answer["rows"]]
    for line, name, column in zip(lines[1:], answer["columns"], np.transpose(answer["jacobian"]), strict=True):
        assert line.split()[0] == name
        assert [float(word) for word in line.split()[1:]] == pytest.approx(column, abs=1e-5)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "--frame"),
        (("--frame", "tipp"), "did you mean 'tip'"),
        (("--frame", "tip", "--axes", "global"), "local_world_aligned"),
    ],
)
def test_wrong_input_is_status_2(run, arguments, words):
    result = run("jacobian", "arm", *arguments)
    assert (result.status, result.out) == (2, "")
    assert words in result.err
