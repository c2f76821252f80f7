"""The lint: each mistake is named with line, loss and mend, and good robots have none."""

from __future__ import annotations

from collections import Counter

import pytest

import pinik
from pinik.description import reader
from pinik.description.catalog import catalog, find
from pinik.description.flaw import Flaw
from pinik.description.lint.front import lint
from pinik.description.unknown import unknown_in_joints
from pinik.description.xml import parse
from urdf_texts import joint, link, pair, robot

LIMIT = '<limit lower="{}" upper="{}" effort="1" velocity="1"/>'


def flaws(text: str) -> tuple[Flaw, ...]:
    try:
        description = reader.read(text)
    except reader.RobotLoadError:
        description = None
    return lint(text.encode(), description)


def only(text: str) -> Flaw:
    (flaw,) = flaws(text)
    return flaw


# Part of a joint as it should be → as it is misspelt → what is lost.
SLIPS = [
    ('<origin xyz="0 0 1"/>', '<origin xzy="0 0 1"/>', "xyz is taken as 0 0 0"),
    ('<origin xyz="0 0 1"/>', '<Origin xyz="0 0 1"/>', "xyz is taken as 0 0 0 and rpy as 0 0 0"),
    ('<origin xyz="0 0 1"/>', '<orgin xyz="0 0 1"/>', "xyz is taken as 0 0 0 and rpy as 0 0 0"),
    ('<origin rpy="0 0 1"/>', '<origin RPY="0 0 1"/>', "rpy is taken as 0 0 0"),
    ('<origin rpy="0 0 1"/>', '<origin ryp="0 0 1"/>', "rpy is taken as 0 0 0"),
    ('<axis xyz="0 0 1"/>', '<axes xyz="0 0 1"/>', "the axis is taken as 1 0 0"),
    ('<axis xyz="0 0 1"/>', '<AXIS xyz="0 0 1"/>', "the axis is taken as 1 0 0"),
    ('<mimic joint="k" multiplier="2"/>', '<mimic joint="k" multiplyer="2"/>', "the multiplier is taken as 1"),
    ('<mimic joint="k" offset="2"/>', '<mimic joint="k" ofset="2"/>', "the offset is taken as 0"),
    ('<dynamics damping="2"/>', '<dynamics dampping="2"/>', "the damping is unknown"),
]


@pytest.mark.parametrize(("right", "wrong", "loss"), SLIPS)
def test_a_slip_says_what_is_lost_and_its_edit_is_the_right_text(right, wrong, loss):
    links = [link("a"), link("b"), link("c")]
    text = robot(*links, joint("k", "a", "c"), joint("j", "a", "b", wrong))
    flaw = next(flaw for flaw in flaws(text) if flaw.code.startswith("unknown"))
    assert flaw.element == "joint 'j'"
    assert loss in flaw.cause
    content = text
    for edit in sorted(flaw.edits, key=lambda edit: -edit.start):
        content = content[: edit.start] + edit.text + content[edit.end :]
    assert content == text.replace(wrong, right)
    assert not [flaw for flaw in flaws(content) if "unknown" in flaw.code]


def test_what_is_lost_of_joints_is_known_to_the_reader_too():
    for _, wrong, loss in SLIPS:
        (flaw,) = unknown_in_joints(parse(pair(wrong).encode()))
        assert loss in flaw
        assert str(flaw) in map(str, reader.read(pair(wrong)).warnings)
    assert unknown_in_joints(parse(pair('<axis xyz="0 0 1"/>').encode())) == []


XYZ, RPY = "xyz is taken as 0 0 0", "rpy is taken as 0 0 0"
BOTH = f"{XYZ} and {RPY}"
# Part of a joint that holds a place or a factor where URDF does not look → what is assumed.
LOST = {
    '<origin position="0.2 0 0.1"/>': BOTH,
    '<origin x="0.2" y="0" z="0.1"/>': BOTH,
    '<origin xyz="0.2 0 0.1" rotation="0 0 1"/>': RPY,
    '<origin rpy="0 0 1" quat="0 0 0 1"/>': XYZ,
    '<origin xyz="0 0 1" rpy="0 0 1" frame="tool"/>': "<origin frame=…> is unknown to URDF and ignored",
    "<origin><xyz>0.2 0 0.1</xyz></origin>": BOTH,
    "<origin>0.2 0 0.1</origin>": f"the text '0.2 0 0.1' in <origin> is ignored; {BOTH}",
    '<mimic joint="k" ratio="2"/>': "the multiplier is taken as 1 and the offset is taken as 0",
    '<mimic joint="k" multiplier="2">0.5</mimic>': "the text '0.5' in <mimic> is ignored; the offset is taken as 0",
    '<axis xyz="0 0 1" expressed_in="base"/>': "<axis expressed_in=…> is unknown to URDF and ignored",
    '<axis xyz="0 0 1">1 0 0</axis>': "the text '1 0 0' in <axis> is ignored",
    "<pose>0.2 0 0.1 0 0 0</pose>": "<pose> is unknown to URDF and ignored with all that it holds; URDF has <origin "
    "xyz=… rpy=…>; the joint stands at the origin of its parent link",
    '<Transform xyz="0.2 0 0.1"/>': "the joint stands at the origin of its parent link",
    "0.2 0 0.1": "the text '0.2 0 0.1' in <joint> is ignored",
}


@pytest.mark.parametrize(("part", "loss"), LOST.items())
def test_a_place_or_factor_where_urdf_does_not_look_is_a_warning_of_load_and_of_check(part, loss):
    text = robot(*map(link, "abc"), joint("k", "a", "c"), joint("j", "a", "b", part))
    lost = [flaw for flaw in reader.read(text).warnings if flaw.startswith("joint 'j': ") and loss in flaw]
    assert lost
    assert set(map(str, lost)) <= set(map(str, flaws(text)))
    assert "not where the file seems to say" in lost[0].why
    with pytest.raises(pinik.RobotLoadError, match="joint 'j'"):
        pinik.load(text, strict=True)


@pytest.mark.parametrize(
    ("limit", "codes"),
    [
        ('<limit min="-1" max="1"/>', ["absent-limit"]),
        ("<limit><lower>-1</lower></limit>", ["absent-limit", "unknown-name"]),
    ],
)
def test_a_limit_under_an_unknown_name_is_a_warning_of_load_if_the_limit_is_missing(limit, codes):
    assert [flaw.code for flaw in reader.read(pair(limit=limit)).warnings] == codes
    assert reader.read(pair(limit=limit, kind="continuous")).warnings == ()
    assert reader.read(pair(limit=LIMIT.format(-1, 1).replace("/>", ' current="3"/>'))).warnings == ()


def test_the_one_warning_about_min_and_max_names_them_and_nothing_says_it_again():
    text = pair(limit='<limit min="-1" max="1"/>')
    (flaw,) = reader.read(text).warnings
    assert flaw.cause.endswith("its range is 0..0; URDF does not know its min= and max=")
    assert [one.code for one in flaws(text)] == ["unknown-name", "unknown-name"]  # with the attributes that it knows


@pytest.mark.parametrize("inner", ["{}", "<visual>{}<geometry><box size='1 1 1'/></geometry></visual>"])
@pytest.mark.parametrize(("tag", "part"), [("joint", joint("j", "a", "b")), ("link", link("c"))])
def test_a_joint_or_link_inside_a_link_is_a_warning_of_load(tag, part, inner):
    (flaw,) = reader.read(robot(link("a", inner.format(part)))).warnings
    assert flaw.code == "misplaced-element"
    assert f"<{tag}> '{'j' if tag == 'joint' else 'c'}' has no place in <" in flaw
    assert reader.read(robot(link("a", f"<sensor>{part}</sensor>"))).warnings == ()


@pytest.mark.parametrize(
    ("wrong", "right"),
    [
        ('<joint name="j" type="fixed" axis="0 0 1">', '<joint name="j" type="fixed"><axis xyz="0 0 1"/>'),
        ("<joint name='j' type='fixed' axis='0 \"'>", "<joint name='j' type='fixed'><axis xyz=\"0 &quot;\"/>"),
    ],
)
def test_an_attribute_that_should_be_an_element_becomes_one(wrong, right):
    text = robot(link("a"), link("b"), f'{wrong}<parent link="a"/><child link="b"/></joint>')
    flaw = only(text)
    assert flaw.code == "misplaced-attribute"
    assert "axis is taken as 1 0 0" in flaw.cause
    content = text
    for edit in sorted(flaw.edits, key=lambda edit: -edit.start):
        content = content[: edit.start] + edit.text + content[edit.end :]
    assert content == text.replace(wrong, right)


def test_two_answers_are_no_edit():
    """The right name is there too, or the attribute belongs to an element that is there."""
    assert only(pair('<origin xyz="0 0 1" xzy="0 0 2"/>')).edits == ()
    assert only(pair('<axis xyz="0 0 1"/>').replace('type="revolute"', 'type="revolute" axis="0 1 0"')).edits == ()
    assert only(pair().replace('type="revolute"', 'type="revolute" lower="0"')).code == "misplaced-attribute"


@pytest.mark.parametrize(
    "extension",
    [
        '<gazebo reference="a"><origin xzy="0"/></gazebo>',
        "<transmission><Joint/></transmission>",
        '<drake:joint xmlns:drake="d" axis="1"/>',
        '<Link xmlns="http://elsewhere.org"/>',
        "<mujoco><compiler/></mujoco>",
        "<ros2_control><joint><limit lowr='1'/></joint></ros2_control>",
        "<sensor><origin xzy='1'/></sensor>",
    ],
)
def test_extensions_are_let_alone(extension):
    assert flaws(robot(link("a"), extension)) == ()
    if not extension.startswith("<Link"):
        assert flaws(robot(link("a", extension))) == () or "transmission" in extension


def test_an_element_at_the_wrong_place_is_named_with_its_places():
    flaw = only(robot(link("a", '<origin xyz="0 0 1"/>')))
    assert (flaw.code, flaw.element) == ("misplaced-element", "link 'a'")
    assert "<joint>" in flaw.mend
    assert "<visual>" in flaw.mend


def test_flaws_carry_their_lines():
    text = '<robot name="r">\n<link name="a"/>\n<link name="b"/>\n<joint name="j" type="fixed">\n<parent link="a"/>'
    text += '<child link="b"/>\n\n<origin xzy="1 2 3"/></joint></robot>'
    assert only(text).line == 7


@pytest.mark.parametrize(
    "slip", ['<origin xyz="0 0 1" xzyz="0 0 2"/>', '<origin xyz="0 0 1"/><orgin xyz="0 0 2"/>'], ids=["name", "tag"]
)
def test_nothing_is_assumed_in_place_of_a_slip_that_stands_beside_the_right_word(slip):
    assert only(pair(slip)).cause.endswith("), and it is given too")


def test_a_long_tag_is_quoted_by_its_beginning_and_its_end():
    """In 60 characters, of which 15 are its end."""
    tag = "t" * 100 + "e" * 100
    assert f"<{44 * 't'}…{15 * 'e'}> in <origin> is unknown" in only(pair(f"<origin><{tag}/></origin>")).cause


class TestUnits:
    @pytest.mark.parametrize("bounds", [(-90, 90), (0, 180), (-170, 170), (-360, 360), (-22.5, 45)])
    def test_limits_beyond_turns_in_whole_degrees_are_doubted(self, bounds):
        flaw = only(pair(limit=LIMIT.format(*bounds)))
        assert flaw.code == "limit-in-degrees"
        assert not flaw.edits

    @pytest.mark.parametrize(("others", "words"), [(1, "another joint stays"), (2, "2 other joints stay")])
    def test_limits_in_degrees_are_compared_with_those_of_the_other_joints(self, others, words):
        bounds = [(-90, 90), (-1.5, 1.2), (-0.3, 0.4)][: others + 1]
        joints = [joint(f"j{i}", "a", f"l{i}", limit=LIMIT.format(*ends)) for i, ends in enumerate(bounds)]
        flaw = only(robot(link("a"), *(link(f"l{i}") for i in range(len(bounds))), *joints))
        assert flaw.code == "limit-in-degrees"
        assert flaw.cause.endswith(f"look like degrees, while {words} within 1.5 rad")

    @pytest.mark.parametrize("bounds", [(-3.14, 3.14), (-6.2832, 6.2832), (-12.5, 12.5), (-1e9, 1e9), (-62.83, 62.83)])
    def test_radians_and_joints_without_an_end_are_not(self, bounds):
        assert flaws(pair(limit=LIMIT.format(*bounds))) == ()

    def test_slides_may_be_long_in_numbers(self):
        assert flaws(pair(limit=LIMIT.format(-90, 90), kind="prismatic")) == ()

    @pytest.mark.parametrize("place", ["joint", "visual", "collision", "inertial"])
    def test_rpy_in_degrees_is_doubted_everywhere(self, place):
        origin = '<origin rpy="90 0 -45"/>'
        shape = f'<{place}>{origin}<geometry><sphere radius="1"/></geometry></{place}>'
        mass = '<mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
        inside = f"<inertial>{origin}{mass}</inertial>" if place == "inertial" else shape
        flaw = only(pair(origin) if place == "joint" else robot(link("a", inside)))
        assert flaw.code == "rpy-in-degrees"
        assert "1.5708 0 -0.785398" in flaw.mend

    def test_rpy_within_a_turn_is_not(self):
        assert flaws(pair('<origin rpy="3.14159 -6.28 1.5"/>')) == ()

    @pytest.mark.parametrize("place", ["joint", "visual", "inertial"])
    def test_an_origin_of_hundreds_among_metres_is_doubted(self, place):
        far = '<origin xyz="0 0 300"/>'
        mass = '<mass value="1"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>'
        shape = f'<visual>{far}<geometry><sphere radius="1"/></geometry></visual>'
        inside = {"joint": "", "visual": shape, "inertial": f"<inertial>{far}{mass}</inertial>"}[place]
        joints = [joint(f"j{i}", f"l{i}", f"l{i + 1}", '<origin xyz="0.3 0 0"/>') for i in range(3)]
        last = joint("last", "l3", "end", far if place == "joint" else "")
        text = robot(*(link(f"l{i}") for i in range(4)), link("end", inside), *joints, last)
        found = [flaw for flaw in flaws(text) if flaw.code == "origin-in-millimetres"]
        assert len(found) == 1
        assert "0 0 0.3" in found[0].mend

    def test_a_robot_that_is_large_altogether_is_not(self):
        joints = [joint(f"j{i}", f"l{i}", f"l{i + 1}", '<origin xyz="300 0 0"/>') for i in range(3)]
        assert flaws(robot(*(link(f"l{i}") for i in range(4)), *joints)) == ()

    def test_the_travel_of_a_slide_in_millimetres_is_doubted(self):
        text = pair('<origin xyz="0 0 0.1"/>', kind="prismatic", limit=LIMIT.format(0, 85))
        assert only(text).code == "limit-in-millimetres"


def inertial(mass: float, ixx: float, iyy: float, izz: float, ixy: float = 0.0) -> str:
    inertia = f'<inertia ixx="{ixx}" ixy="{ixy}" ixz="0" iyy="{iyy}" iyz="0" izz="{izz}"/>'
    return robot(link("a", f'<inertial><mass value="{mass}"/>{inertia}</inertial>'))


@pytest.mark.parametrize(
    ("numbers", "code"),
    [
        ((1, 0.1, 0.1, 0.3), "inertia-triangle"),
        ((1, 0.1, 0.1, 0.1, 0.2), "inertia-not-positive"),
        ((1, -0.1, 0.1, 0.1), "inertia-not-positive"),
        ((1, 0, 0, 0), "inertia-singular"),
        ((1, 0, 0, 1e-6), "inertia-singular"),
        ((1, -5e-20, -5e-20, 0), "inertia-singular"),
        ((1, -3.5e-8, 3.5e-8, 9e-8), "inertia-not-positive"),
        ((1, 0, 0.1, 0.2), "inertia-triangle"),
        ((0, 0.1, 0.1, 0.1), "massless-inertia"),
        ((1, 1e-9, 1e-9, 1e-9), "density"),
    ],
)
def test_inertias_that_no_body_has(numbers, code):
    assert only(inertial(*numbers)).code == code


@pytest.mark.parametrize("numbers", [(1, 0.1, 0.1, 0.3), (1, -0.1, 0.1, 0.1), (1, 1e-9, 1e-9, 1e-9)])
def test_inertias_of_one_sort_are_reported_together_whatever_their_numbers(numbers):
    one, two = only(inertial(*numbers)), only(inertial(numbers[0], *(1.1 * moment for moment in numbers[1:])))
    assert one.cause != two.cause
    assert one.common == two.common


@pytest.mark.parametrize("numbers", [(1e-300, 1e300, 1e300, 1e300), (1e300, 1e-300, 1e-300, 1e-300), (5e-324, 1, 1, 1)])
def test_masses_and_inertias_may_be_as_large_or_small_as_numbers_can_be(numbers):
    flaws(inertial(*numbers))


def test_inertias_of_bodies_are_not_doubted():
    """A steel ball, a thin rod, a plate with rounded numbers, a massless link, and a turned box, by their formulas."""
    ball = 0.4 * 0.51 * 0.025**2
    for numbers in [
        (0.51, ball, ball, ball),
        (1.0, 1 / 12, 1 / 12, 1e-6),
        (1.0, 1 / 12, 1 / 12, 0.0),
        (1.0, 1 / 12, 1 / 12, -1e-19),
        (1.0, 0.0833, 0.0833, 0.1667),
        (0, 0, 0, 0),
        (1.0, 0.05, 0.05, 0.06, 0.03),
    ]:
        assert flaws(inertial(*numbers)) == ()


def test_inertia_in_kg_mm_on_a_robot_of_metres():
    body = '<inertial><mass value="1"/><inertia ixx="1e4" ixy="0" ixz="0" iyy="1e4" iyz="0" izz="1e4"/></inertial>'
    text = robot(link("a"), link("b", body), joint("j", "a", "b", '<origin xyz="0 0 0.3"/>'))
    assert only(text).code == "density"


class TestLimits:
    def test_zero_outside_and_no_travel(self):
        assert only(pair(limit=LIMIT.format(0.5, 1))).code == "zero-outside-limits"
        assert only(pair(limit=LIMIT.format(0, 0))).code == "no-travel"
        assert only(pair(limit='<limit effort="1" velocity="1"/>')).code == "no-travel"
        assert flaws(pair(limit=LIMIT.format(0, 1))) == ()

    @pytest.mark.parametrize(
        "text",
        [
            pair(limit='<limit lowr="-1" uper="1"/>'),
            pair(limit="<limit/>").replace('type="revolute"', 'type="revolute" lower="-1" upper="1"'),
        ],
    )
    def test_a_slip_in_the_limits_is_said_once_and_not_taken_for_limits_of_zero(self, text):
        assert {flaw.code for flaw in flaws(text)} <= {"unknown-attribute", "misplaced-attribute"}
        assert {flaw.code for flaw in reader.read(text).warnings} <= {"unknown-attribute", "misplaced-attribute"}
        half = text.replace('uper="1"', "").replace('upper="1"', "")
        assert ["has no upper" in flaw for flaw in reader.read(half).warnings if flaw.code == "absent-limit"] == [True]

    def test_a_follower_that_holds_its_leader_up_is_named_with_what_is_left(self):
        lead = joint("lead", "a", "b", limit=LIMIT.format(0, 1))
        text = robot(link("a"), link("b"), link("c"), lead, joint("f", "a", "c", "{}", limit=LIMIT.format(0, 0.5)))
        flaw = only(text.replace("{}", '<mimic joint="lead"/>'))
        assert (flaw.code, flaw.element) == ("follower-narrows", "joint 'f'")
        assert "only 0…0.5" in flaw.cause
        assert flaws(text.replace("{}", '<mimic joint="lead" multiplier="0.5"/>')) == ()
        assert flaws(text.replace("{}", '<mimic joint="lead" multiplier="-0.5" offset="0.5"/>')) == ()


def test_names_that_differ_only_in_case():
    text = robot(link("Arm"), link("arm"), joint("J", "Arm", "arm"))
    flaw = only(text)
    assert (flaw.code, flaw.element) == ("similar-names", "link 'arm'")


def test_a_long_name_is_quoted_by_its_beginning_and_its_end():
    name = "a" * 100 + "b" * 100
    flaw = only(robot(link(name), link(name.upper()), joint("j", name, name.upper())))
    assert flaw.element.startswith("link 'AAAA")
    assert flaw.element.endswith("BBBB'")
    assert len(flaw.element) <= len("link ''") + 60
    assert f"link {name!r}" not in flaw.cause


def colored(name: str, rgba: str = "") -> str:
    return f'<material name="{name}"><color rgba="{rgba}"/></material>' if rgba else f'<material name="{name}"/>'


def visual(*parts: str) -> str:
    return f'<visual><geometry><sphere radius="1"/></geometry>{"".join(parts)}</visual>'


def test_materials_that_are_nowhere_or_twice():
    red = colored("red", "1 0 0 1")
    assert flaws(robot(red, link("a", visual(colored("red"))))) == ()
    assert flaws(robot(link("b", visual(red)), link("a", visual(colored("red"))))) == ()
    assert only(robot(link("a", visual(colored("red"))))).code == "undefined-material"
    near = only(robot(red, link("a", visual(colored("Red")))))
    assert (near.code, [edit.text for edit in near.edits]) == ("undefined-material", ["red"])
    assert only(robot(red, link("a", visual(colored("red", "1 0 0.5 1"))))).code == "material-twice"
    assert flaws(robot(red, link("a", visual(colored("red", "1  0 0 1"))))) == ()


def test_a_second_shape_is_said_to_be_dropped():
    text = robot(link("a", '<visual><geometry><box size="1 1 1"/><sphere radius="1"/></geometry></visual>'))
    flaw = only(text)
    assert flaw.code == "second-shape"
    assert "<box>, is taken, and <sphere> dropped" in flaw.cause


def test_a_document_that_is_no_urdf_has_no_flaws():
    for text in ("", "nonsense", "<sdf/>", "<robot", '<?xml version="1.0" encoding="x"?><robot/>'):
        assert lint(text.encode()) == ()


def test_a_root_in_capital_letters_has_an_edit():
    (flaw,) = lint(b'<Robot name="r"><link name="a"/></Robot>')
    assert [(edit.start, edit.text) for edit in flaw.edits] == [(1, "robot"), (34, "robot")]
    assert flaw.mend == "Write <robot>."


# What is doubted in the robots of the catalogue, all of it rightly: each sort was looked at, robot by robot.
IN_GOOD_ROBOTS = {
    "density", "inertia-not-positive", "inertia-singular",
    "inertia-triangle", "massless-inertia", "material-twice", "misplaced-element",
    "no-travel", "undefined-material", "unknown-name", "zero-outside-limits",
}  # fmt: skip


def test_the_catalogue_raises_no_false_alarm_about_names_and_units():
    counts: Counter[str] = Counter()
    for name in catalog():
        counts.update(flaw.code for flaw in lint(find(name).urdf.read_bytes()))
    assert set(counts) <= IN_GOOD_ROBOTS
    assert counts["unknown-name"] <= 76  # <limit current=…> and the like in the three ANYmal-B files and Centauro
    assert counts["misplaced-element"] <= 1  # an <origin> in a <link> of so101


# What is wrong in a joint → what is to be done about it, word for word.
MENDS = {
    "<origin>0 0 1</origin>": "Write it as <origin xyz=…>, or take it out.",
    "<axis>0 0 1</axis>": "Write it as <axis xyz=…>, or take it out.",
    "<axis><foo/></axis>": "Take it out; <axis> holds no elements.",
}


@pytest.mark.parametrize("part", MENDS)
def test_the_mend_of_what_is_ignored_in_a_joint_says_what_to_write(part):
    assert only(pair(part)).mend == MENDS[part]


def test_the_mend_of_an_attribute_that_should_be_an_element_is_that_element():
    text = pair().replace('type="revolute"', 'type="revolute" axis="0 0 1"')
    assert only(text).mend == 'Write <axis xyz="0 0 1"/> inside <joint>.'


# The joint's kind, its limits and axis → the mend of the reader's warning, word for word.
MENDS_OF_THE_READER = [
    ("revolute", LIMIT.format(-1, "inf"), "Write the limits that the joint has."),
    ("revolute", LIMIT.format("-inf", "inf"), 'Write type="continuous" if the joint turns without an end.'),
    ("prismatic", LIMIT.format("-inf", "inf"), "Write the limits that the joint has."),
    ("planar", "", 'Write <axis xyz="0 0 1"/> if it moves in the xy-plane.'),
]


@pytest.mark.parametrize(("kind", "limit", "mend"), MENDS_OF_THE_READER)
def test_the_mend_of_a_readers_warning_says_what_to_write(kind, limit, mend):
    (flaw,) = reader.read(pair(kind=kind, limit=limit)).warnings
    assert flaw.mend == mend


@pytest.mark.parametrize("second", ['<origin xyz="0 0 1"/>', '<origin xyz="0 0 2"/>'])
def test_second_elements_are_reported_together_whatever_joint_has_them(second):
    (flaw,) = reader.read(pair('<origin xyz="0 0 1"/>', second)).warnings
    assert flaw.common == "has several <origin> elements; the first is taken"


def test_a_place_as_attribute_and_a_misspelt_joint_have_their_code_and_their_owner():
    place = only(pair().replace('<joint name="j"', '<joint name="j" position="0 0 1"'))
    assert (place.code, place.element) == ("unknown-attribute", "joint 'j'")
    lost = only(robot(link("a"), '<jiont name="k"/>'))
    assert (lost.code, lost.element) == ("unknown-element", "<jiont> 'k'")


def test_a_planar_joint_without_an_axis_has_its_code():
    description = reader.read(robot(link("a"), link("b"), joint("j", "a", "b", kind="planar", limit="")))
    assert [flaw.code for flaw in description.warnings] == ["planar-axis"]
