from __future__ import annotations

import io
import itertools
import threading
import warnings
from collections.abc import Mapping

import numpy as np
import pinocchio
import pytest
from numpy.typing import NDArray

from pinik.description import reader as urdf
from pinik.description.catalog import catalog, find
from pinik.description.reader import MAX_LINKS
from pinik.errors import InputError, RobotLoadError
from pinik.model import build as model_module
from pinik.model.build import MAX_DEGREES_OF_FREEDOM, build_model
from urdf_texts import LIMIT, chain, joint, link, pair, robot

ONE_AXIS = ("revolute", "continuous", "prismatic")
TILTED = '<origin xyz="0.1 -0.2 0.3" rpy="0.4 0.5 -0.6"/><axis xyz="0.48 -0.6 0.64"/>'


def oracle(text: str | bytes, angles: Mapping[str, float], links: tuple[str, ...], root: str) -> NDArray[np.float64]:
    """yourdfpy's placements of the links at the leaders' angles (len(links), 4, 4)."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import yourdfpy

        document = text.encode() if isinstance(text, str) else text
        reader = yourdfpy.URDF.load(io.BytesIO(document), load_meshes=False, build_scene_graph=True)
    reader.update_cfg({name: angles[name] for name in reader.actuated_joint_names})
    return np.array([reader.get_transform(name, root) for name in links])


def placements(model: pinocchio.Model, angles: Mapping[str, float], links: tuple[str, ...]) -> NDArray[np.float64]:
    """Pinocchio's placements of the links (len(links), 4, 4); `angles` may name more joints than are free."""
    q = pinocchio.neutral(model)
    for name, shape in zip(model.names, model.joints, strict=True):
        if name in angles and shape.nq == 2:
            q[shape.idx_q : shape.idx_q + 2] = np.cos(angles[name]), np.sin(angles[name])
        elif name in angles and shape.nq == 1:
            q[shape.idx_q] = angles[name]
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, q)
    return np.array([data.oMf[model.getFrameId(name, pinocchio.BODY)].homogeneous for name in links])


def mimic_pair(leader: str, follower: str, *, branch: bool, multiplier: float = -0.7) -> str:
    """A leader 'a' and its follower 'b', beyond it or beside it."""
    mimic = f'<mimic joint="a" multiplier="{multiplier}" offset="0.3"/>'
    limits = {kind: "" if kind == "continuous" else LIMIT for kind in ONE_AXIS}
    return robot(
        *map(link, ("base", "one", "two")),
        joint("a", "base", "one", TILTED, kind=leader, limit=limits[leader]),
        joint("b", "base" if branch else "one", "two", TILTED, mimic, kind=follower, limit=limits[follower]),
    )


@pytest.mark.parametrize("branch", [False, True], ids=["beyond its leader", "beside its leader"])
@pytest.mark.parametrize("multiplier", [-0.7, 0.0, 2.0])
@pytest.mark.parametrize(("leader", "follower"), list(itertools.product(ONE_AXIS, ONE_AXIS)))
def test_a_mimic_joint_follows_as_yourdfpy_says(leader: str, follower: str, multiplier: float, branch: bool) -> None:
    text = mimic_pair(leader, follower, branch=branch, multiplier=multiplier)
    model, left_free = build_model(urdf.read(text))
    assert left_free == ()
    assert model.nv == 1
    links = ("base", "one", "two")
    for angle in np.linspace(-3.1, 3.1, 9):
        expected = oracle(text, {"a": angle}, links, "base")
        np.testing.assert_allclose(placements(model, {"a": angle}, links), expected, atol=1e-12)


def test_a_follower_comes_after_its_leader_whatever_their_names() -> None:
    text = robot(
        *map(link, ("base", "one", "two", "three")),
        joint("early", "base", "one", '<mimic joint="leader"/>'),
        joint("leader", "base", "two"),
        joint("zlate", "base", "three", '<mimic joint="leader"/>'),
    )
    model, words = build_model(urdf.read(text))
    assert words == ()
    assert list(model.names) == ["universe", "leader", "early", "zlate"]
    assert [shape.nq for shape in model.joints][1:] == [1, 0, 0]


def test_the_order_of_joints_in_the_file_does_not_matter() -> None:
    text = robot(
        *map(link, ("base", "one", "two")),
        joint("b", "one", "two", '<mimic joint="a"/>'),
        joint("a", "base", "one"),
    )
    model, left_free = build_model(urdf.read(text))
    assert (model.nv, left_free) == (1, ())


@pytest.mark.parametrize("root", ["fixed", "free_flyer", "planar"])
def test_a_mimic_of_a_mimic_follows_the_ultimate_leader(root: str) -> None:
    links = ("base", "one", "two", "three")
    text = robot(
        *map(link, links),
        joint("a", "base", "one", TILTED),
        joint("b", "one", "two", TILTED, '<mimic joint="a" multiplier="-2" offset="0.1"/>', kind="prismatic"),
        joint("c", "two", "three", TILTED, '<mimic joint="b" multiplier="0.5" offset="0.2"/>'),
    )
    free = robot(
        *map(link, links),
        joint("a", "base", "one", TILTED),
        joint("b", "one", "two", TILTED, kind="prismatic"),
        joint("c", "two", "three", TILTED),
    )
    model, left_free = build_model(urdf.read(text), root=root)
    assert left_free == ()
    assert model.nv == {"fixed": 1, "free_flyer": 7, "planar": 4}[root]
    for a in (-0.9, 0.0, 1.1):
        b = -2 * a + 0.1
        expected = oracle(free, {"a": a, "b": b, "c": 0.5 * b + 0.2}, links, "base")
        np.testing.assert_allclose(placements(model, {"a": a}, links), expected, atol=1e-12)


def test_a_slider_moves_by_metres_however_long_its_axis_is_written() -> None:
    """yourdfpy scales the travel by the axis's length here, so the expected placement is written out."""
    model, _ = build_model(urdf.read(pair('<axis xyz="0 0 5"/>', kind="prismatic")))
    np.testing.assert_allclose(placements(model, {"j": 0.7}, ("b",))[0][:3, 3], [0, 0, 0.7], atol=1e-15)


@pytest.mark.parametrize("name", ["panda", "baxter", "pr2", "tiago_pro", "romeo", "talos_full", "talos_full_box"])
def test_the_mimic_joints_of_real_robots_follow_as_yourdfpy_says(name: str) -> None:
    entry = find(name)
    description = urdf.read(entry.urdf)
    model, words = build_model(description)
    assert not any("follows" in warning or "left free" in warning for warning in words)
    assert all(model.joints[model.getJointId(tag.name)].nq == 0 for tag in description.joints if tag.mimic)
    rng = np.random.default_rng(7)
    leaders = [tag.name for tag in description.joints if tag.kind in ONE_AXIS and tag.mimic is None]
    angles = dict(zip(leaders, rng.uniform(-3, 3, len(leaders)), strict=True))
    expected = oracle(entry.urdf.read_bytes(), angles, description.links, description.root)
    np.testing.assert_allclose(placements(model, angles, description.links), expected, atol=1e-9)


def test_without_mimic_every_joint_is_free_and_nothing_is_said() -> None:
    model, left_free = build_model(urdf.read(find("romeo").urdf), mimic=False)
    assert left_free == ()
    assert all(shape.nq > 0 for shape in list(model.joints)[1:])


@pytest.mark.parametrize("name", sorted(set(catalog()) - {"ur3_empty"}))
def test_the_rewritten_text_gives_pinocchio_s_own_model_of_the_file(name: str) -> None:
    """Without its shapes and with its numbers written anew, the file means the same."""
    path = find(name).urdf
    model, _ = build_model(urdf.read(path), mimic=False)
    expected = pinocchio.buildModelFromUrdf(str(path))
    assert list(model.names) == list(expected.names)
    assert [(frame.name, frame.type, frame.parentJoint, frame.parentFrame) for frame in model.frames] == [
        (frame.name, frame.type, frame.parentJoint, frame.parentFrame) for frame in expected.frames
    ]
    for ours, theirs in zip(model.frames, expected.frames, strict=True):
        assert ours.placement.isApprox(theirs.placement, 1e-12)
    for ours, theirs in zip(model.inertias, expected.inertias, strict=True):
        assert ours.isApprox(theirs, 1e-12)
    for limit in (
        "lowerPositionLimit",
        "upperPositionLimit",
        "upperEffortLimit",
        "upperVelocityLimit",
        "damping",
    ):
        np.testing.assert_array_equal(getattr(model, limit), getattr(expected, limit))
    q = pinocchio.randomConfiguration(model, np.full(model.nq, -1.0), np.full(model.nq, 1.0))
    data, expected_data = model.createData(), expected.createData()
    pinocchio.framesForwardKinematics(model, data, q)
    pinocchio.framesForwardKinematics(expected, expected_data, q)
    for ours, theirs in zip(data.oMf, expected_data.oMf, strict=True):
        np.testing.assert_allclose(ours.homogeneous, theirs.homogeneous, atol=1e-12)


@pytest.mark.parametrize(
    ("root", "names", "nq"),
    [
        ("fixed", ["universe", "j"], 1),
        ("free_flyer", ["universe", "root_joint", "j"], 8),
        ("planar", ["universe", "root_joint", "j"], 5),
    ],
)
def test_the_root_hangs_in_the_world_as_asked(root: str, names: list[str], nq: int) -> None:
    model, _ = build_model(urdf.read(pair()), root=root)
    assert (list(model.names), model.nq) == (names, nq)


def test_an_unknown_root_is_refused_with_the_right_ones() -> None:
    with pytest.raises(InputError, match="root must be one of 'fixed', 'free_flyer', 'planar'; got 'floating'"):
        build_model(urdf.read(pair()), root="floating")


@pytest.mark.parametrize(
    ("name", "root"), [("universe", "fixed"), ("universe", "planar"), ("root_joint", "free_flyer")]
)
def test_a_joint_with_the_name_of_one_of_pinocchio_s_is_refused(name: str, root: str) -> None:
    description = urdf.read(pair().replace('"j"', f'"{name}"'))
    with pytest.raises(RobotLoadError, match="rename the joint") as caught:
        build_model(description, root=root)
    assert caught.value.element == f"joint {name!r}"


@pytest.mark.parametrize("name", ["universe", "root_joint"])
def test_a_link_with_the_name_of_one_of_pinocchio_s_joints_keeps_its_placement(name: str) -> None:
    text = pair(TILTED).replace('"b"', f'"{name}"')
    for root in ("fixed", "free_flyer"):
        model, _ = build_model(urdf.read(text), root=root)
        expected = oracle(text, {"j": 0.7}, (name,), "a")
        np.testing.assert_allclose(placements(model, {"j": 0.7}, (name,)), expected, atol=1e-12)


def test_a_fixed_joint_may_be_called_root_joint_where_pinocchio_s_is_not() -> None:
    description = urdf.read(pair(kind="fixed").replace('"j"', '"root_joint"'))
    assert build_model(description)[0].nframes == 4
    assert build_model(description, root="free_flyer")[0].nframes == 5


def test_a_chain_of_thousands_of_fixed_links_loads_where_the_stack_is_small() -> None:
    description = urdf.read(chain(MAX_LINKS - 1, "fixed"))
    frames: list[int] = []
    usual = threading.stack_size(256 * 1024)
    try:
        thread = threading.Thread(target=lambda: frames.append(build_model(description)[0].nframes))
        thread.start()
    finally:
        threading.stack_size(usual)
    thread.join()
    assert frames == [2 * MAX_LINKS]
    assert threading.stack_size() == usual


def test_a_chain_longer_than_that_is_refused_before_any_link_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    for work in ("check_unique", "read_link", "read_joint", "written"):
        monkeypatch.setattr(urdf, work, lambda *_: pytest.fail("it is too large for this work"))
    with pytest.raises(RobotLoadError, match=r"it has 10,001 links; at most 10,000 can be loaded"):
        urdf.read(chain(MAX_LINKS, "fixed"))


def test_more_joints_than_links_can_have_are_refused_as_early() -> None:
    joints = (joint(f"j{i}", "a", "b") for i in range(MAX_LINKS + 1))
    with pytest.raises(RobotLoadError, match=r"it has 10,001 joints; at most 10,000 can be loaded"):
        urdf.read(robot(link("a"), link("b"), *joints))


def test_a_chain_of_as_many_joints_as_memory_holds_loads() -> None:
    model, _ = build_model(urdf.read(chain(MAX_DEGREES_OF_FREEDOM, "revolute")))
    assert model.nv == MAX_DEGREES_OF_FREEDOM


@pytest.mark.parametrize(
    ("count", "kind", "root", "freedoms"),
    [
        (3000, "revolute", "fixed", "3,000"),
        (251, "continuous", "fixed", "251"),
        (245, "prismatic", "free_flyer", "251"),
        (42, "floating", "fixed", "252"),
    ],
)
def test_a_robot_with_more_joints_than_memory_holds_is_refused_in_words(
    count: int, kind: str, root: str, freedoms: str
) -> None:
    description = urdf.read(chain(count, kind))
    with pytest.raises(RobotLoadError, match=f"{freedoms} degrees of freedom; at most 250 can be loaded"):
        build_model(description, root=root)


def test_whatever_else_pinocchio_raises_is_a_load_error_with_its_cause(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refuse(*_: object) -> None:
        raise ValueError("Some components\nof something are wrong")

    monkeypatch.setattr(model_module.pinocchio, "buildModelFromXML", refuse)
    for text in (pair(), chain(200, "fixed")):
        with pytest.raises(RobotLoadError, match="Pinocchio refuses it: Some components of something are wrong"):
            build_model(urdf.read(text))
