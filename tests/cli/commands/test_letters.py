"""Names in any letters, on the command line and in its answers."""

from __future__ import annotations

import json

import pytest

from by_hand import axis, limit
from urdf_texts import joint, link, robot


@pytest.mark.parametrize(("hinge", "hand"), [("épaule", "été"), ("肩", "手 1"), ("a'b", "e\u0301"), ("😀", "«x»")])
def test_a_name_in_any_letters_is_read_and_written(run, tmp_path, hinge, hand):
    path = tmp_path / f"{hand}.urdf"
    path.write_text(robot(link("base"), link(hand), joint(hinge, "base", hand, axis(0, 0, 1), limit=limit(-2, 2))))
    solved = run("solve", path, "--frame", hand, "--rpy", 0, 0, 0.5, "--start", f"{hinge}=0.2", "--json")
    assert (solved.status, solved.err) == (0, "")
    assert solved.json["targets"][0]["frame"] == hand
    assert solved.json["angles"] == {hinge: pytest.approx(0.5, abs=1e-3)}
    placed = run("fk", path, "--frame", hand, "--set", f"{hinge}=0.25", "--json")
    assert placed.status == 0
    assert hand in placed.out or json.dumps(hand) in placed.out
    assert hand in run("info", path).out
    wrong = run("fk", path, "--frame", f"{hand}x")
    assert wrong.status == 2
    assert hand in wrong.err
