"""The documentation as a site: it builds strictly, fetches nothing from elsewhere, can be searched, and is whole."""

from __future__ import annotations

import html
import http.server
import json
import os
import re
import subprocess
import sys
import threading
from collections.abc import Iterator
from functools import partial
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import quote

import nbformat
import numpy as np
import pinocchio
import pytest
import write_reference
from pages.api_names import faults_of_public_names
from pages.formulas import with_formulas
from pages.live_pictures import PLAYED, filmed
from pymdownx.slugs import slugify

import pinik
from desk import CHROMIUM, Faults, need_browser
from page_fixtures import FLAGS
from pinik.description.advice import ADVICE
from pinik.description.lint.front import lint

ROOT = Path(__file__).parents[1]
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


@pytest.fixture(scope="module")
def site(tmp_path_factory) -> Path:
    """The site, built as `make docs` builds it."""
    folder = tmp_path_factory.mktemp("site")
    built = subprocess.run(
        [sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", str(folder)],
        cwd=ROOT,
        env=os.environ | {"NO_MKDOCS_2_WARNING": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    assert built.returncode == 0, built.stderr
    assert "WARNING" not in built.stderr
    return folder


class Fetched(HTMLParser):
    """The addresses that a browser fetches to show a page, and not those that a reader may follow."""

    def __init__(self) -> None:
        super().__init__()
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        if tag != "a" and (tag != "link" or given.get("rel") not in ("canonical", "next", "prev")):
            self.addresses += [given[name] for name in ("src", "href", "data", "poster") if given.get(name)]


@pytest.mark.timeout(300)
def test_no_page_fetches_anything_from_elsewhere_and_all_of_it_is_there(site):
    pages = sorted(site.rglob("*.html"))
    assert len(pages) > 45
    for page in pages:
        reader = Fetched()
        reader.feed(page.read_text("utf-8"))
        assert reader.addresses
        for address in reader.addresses:
            if address.startswith("data:") or page.name == "404.html":
                continue
            assert not re.match(r"\w+:|//", address), f"{page.name} fetches {address}"
            assert (page.parent / address.partition("#")[0].partition("?")[0]).exists(), f"{page.name}: {address}"


def test_no_style_fetches_a_font_from_elsewhere(site):
    for style in site.rglob("*.css"):
        assert not re.search(r"url\(\s*['\"]?(?:https?:)?//", style.read_text("utf-8")), style.name


@pytest.mark.parametrize(
    ("words", "page"),
    [
        ("did you mean", "errors.html"),
        ("elbow up", "howto/answers.html"),
        ("quat_wxyz", "conventions.html"),
        ("choose_weights", "api/solve.html"),
        ("--write-srdf", "command-line.html"),
        ("meshes are not found", "howto/robots.html"),
        ("a million targets", "howto/motion.html"),
        ("where can my robot reach", "howto/robots.html"),
        ("blender", "howto/programs.html"),
        ("batch.run", "api/files.html"),
    ],
)
def test_the_search_index_leads_to_the_page(site, words, page):
    entries = json.loads((site / "search" / "search_index.json").read_text("utf-8"))["docs"]
    texts = {entry["location"]: f"{entry['title']} {entry['text']}".lower() for entry in entries}
    assert page in {location.partition("#")[0] for location, text in texts.items() if words in text}


def test_answers_to_questions_come_first_in_searches(site):
    entries = json.loads((site / "search" / "search_index.json").read_text("utf-8"))["docs"]
    boosts = {entry["location"]: entry.get("boost", 1) for entry in entries}
    assert boosts["howto/answers.html#hold-the-elbow-up"] == 2
    assert boosts["two_bone.html"] == 1


def test_every_public_name_has_its_place_in_the_api(site):
    api = " ".join(path.read_text("utf-8") for path in (site / "api").glob("*.html"))
    for name in pinik.__all__:
        assert re.search(rf'id="pinik\.{name}"', api), name


def test_a_public_name_that_is_missing_or_undocumented_is_a_fault(tmp_path):
    package = tmp_path / "src" / "pinik"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text(
        '"""A package."""\n__all__ = ["Good", "Bare", "absent"]\n\n'
        'class Good:\n    """Documented."""\n\n    def said(self):\n        """Too."""\n\n    def bare(self): ...\n\n'
        'class Bare:\n    def said(self):\n        """Documented."""\n\n'
        'def absent(x):\n    """Is on no page.\n\n    Args:\n        y: No such parameter.\n    """\n'
    )
    (tmp_path / "docs" / "api").mkdir(parents=True)
    (tmp_path / "docs" / "api" / "all.md").write_text("::: pinik.Good\n\n::: pinik.Bare\n\n::: pinik.other\n")
    assert set(faults_of_public_names(tmp_path)) == {
        "Good.bare has no docstring",
        "Bare has no docstring",
        "absent is on 0 pages of docs/api",
        "absent documents a parameter y that it does not have",
        "docs/api shows other, which is not public",
    }


def test_classes_that_calls_return_and_names_in_pages_are_shown_or_a_fault(tmp_path):
    package = tmp_path / "src" / "pinik"
    package.mkdir(parents=True)
    (package / "__init__.py").write_text(
        '"""A package."""\nfrom .inside import Base, Found, Given, Part, find\n__all__ = ["find"]\n'
    )
    (package / "inside.py").write_text(
        '"""A module."""\n\nclass Base:\n    """A base."""\n\n    def of(self) -> Base:\n        """It."""\n\n'
        'class Given:\n    """A class."""\n\nclass Part:\n    """A class."""\n\n'
        'class Found(Base):\n    """A class.\n\n    Attributes:\n        kept: For pinik itself: a part.\n    """\n\n'
        "    part: list[Part]\n    kept: Given\n\n"
        '    def inner(self) -> Given:\n        """For pinik itself: it."""\n\n'
        'def find(what: str) -> Found:\n    """Find it."""\n\ndef save(what: Found) -> None:\n    """Save it."""\n'
    )
    api = tmp_path / "docs" / "api"
    api.mkdir(parents=True)
    (api / "all.md").write_text("::: pinik.find\n\n::: pinik.inside.gone\n")
    (tmp_path / "docs" / "page.md").write_text(
        "```python\nimport pinik\nfrom pinik.inside import save\n\n"
        "save(pinik.find('x').part, pinik.inside.other.more)\n```\n"
    )
    assert set(faults_of_public_names(tmp_path)) == {
        "inside.gone is shown or public, and there is no such name",
        "find has the type Found, which no page of docs/api shows",
        "page.md uses inside.save, which no page of docs/api shows",
        "page.md uses inside.other.more, which no page of docs/api shows",
    }
    (api / "more.md").write_text("::: pinik.inside.Found\n\n::: pinik.inside.save\n")
    (api / "all.md").write_text("::: pinik.find\n")
    (tmp_path / "docs" / "page.md").unlink()
    assert set(faults_of_public_names(tmp_path)) == {
        "inside.Found.part has the type Part, which no page of docs/api shows"
    }


def test_the_api_shows_what_is_for_users_with_inherited_attributes_and_parameters(site):
    def plain(page):
        return html.unescape(re.sub(r"<[^>]+>", "", (site / "api" / page).read_text("utf-8")))

    robot, solve, methods = plain("robot.html"), plain("solve.html"), plain("methods.html")
    for own in ("joint_names", "frame_names", "mimics", "velocity_limits"):
        assert re.search(rf"^\s*{own}\s*–", robot, re.MULTILINE), own
    assert 'id="pinik.Robot.placement"' in (site / "api" / "robot.html").read_text("utf-8")
    for page in (site / "api").glob("*.html"):
        if page.name != "index.html":
            assert "For pinik itself" not in page.read_text("utf-8")
    for inner in ("Robot.local", "Robot.surroundings", "Prepared.recall", "Prepared.searcher", "Target.shape"):
        named = getattr(getattr(pinik, inner.split(".")[0]), inner.split(".")[1])
        assert (named.__doc__ or named.func.__doc__).startswith("For pinik itself: ")
    assert "pinik.Prepared.recall" not in solve
    assert re.search(r"damping: float = 0\.7071,", methods)
    assert re.search(r"chunk: int = 8192,", plain("files.html"))
    assert re.search(r"how much steps are damped.*\(λ\): 1e-09 to 100", methods)


def test_every_notebook_is_a_page_with_its_pictures_and_can_be_downloaded(site):
    for path in NOTEBOOKS:
        page = (site / "notebooks" / f"{path.stem}.html").read_text("utf-8")
        cells = nbformat.read(path, as_version=4).cells
        shown = sum("image/png" in output.get("data", {}) for cell in cells for output in cell.get("outputs", ()))
        assert len(re.findall(rf'<img[^>]+src="{path.stem}-\d+\.png"', page)) == shown > 0
        assert 'alt=""' not in page
        before, _, after = page.partition(f'<a href="{path.name}" download>')
        assert (before.count("<h1"), "<pre" in before, "<pre" in after) == (1, False, True)
        assert (site / "notebooks" / path.name).read_bytes() == path.read_bytes()


def test_at_least_forty_questions_are_answered_and_the_index_has_them_all():
    howto = ROOT / "docs" / "howto"
    index = (howto / "index.md").read_text("utf-8")
    linked = set(re.findall(r"\]\((\w+\.md#[\w-]+)\)", index))
    asked = {
        f"{page.name}#{slugify(case='lower')(heading, '-')}"
        for page in howto.glob("*.md")
        if page.name not in ("index.md", "coming-from.md")
        for heading in re.findall(r"^## (.+)$", page.read_text("utf-8"), re.MULTILINE)
    }
    assert linked == asked
    assert len(asked) >= 40
    assert "(coming-from.md)" in index


def test_a_page_is_called_in_the_navigation_what_its_heading_says():
    named = re.findall(r"^ +- ([^:\n]+): (\S+\.md)$", (ROOT / "mkdocs.yml").read_text("utf-8"), re.MULTILINE)
    titles = {path: title for title, path in named if title != "Home"}
    assert len(titles) > 10
    for path, title in titles.items():
        assert (ROOT / "docs" / path).read_text("utf-8").startswith(f"# {title}"), path


@pytest.mark.parametrize(("page", "picture"), [("architecture", "images/rooms.svg"), ("live", "images/live.png")])
def test_a_picture_with_small_letters_leads_to_itself(site, page, picture):
    text = (site / f"{page}.html").read_text("utf-8")
    assert re.search(rf'<a href="{picture}"><img [^>]*src="{picture}"', text)


def test_no_markdown_is_left_in_a_page(site):
    """Lists and formulas that GitHub reads and Python-Markdown does not would show their signs."""
    for page in site.rglob("*.html"):
        if page.parent.name == "live":  # an animation, which is no Markdown
            continue
        text = re.sub(r"<(pre|code|script|math)\b.*?</\1>", "", page.read_text("utf-8"), flags=re.DOTALL)
        found = re.search(r"\$|^\s*\* |\*\*|\|---|```", re.sub(r"<[^>]+>", "", text), re.MULTILINE)
        assert found is None, f"{page.name}: {text[found.start() - 60 : found.end() + 60]}"


def test_formulas_are_mathml_and_no_latex_is_left(site):
    for page in [site / "methods.html", *(site / "notebooks").glob("0*.html")]:
        text = page.read_text("utf-8")
        assert "arithmatex" not in text
        assert "\\(" not in re.sub(r"<(pre|code|script)\b.*?</\1>", "", text, flags=re.DOTALL), page
        assert not re.search(
            r"\\(?:frac|lambda|Delta|top)\b", re.sub(r"<pre>.*?</pre>|<code>.*?</code>", "", text, flags=re.DOTALL)
        ), page
    assert "<math" in (site / "methods.html").read_text("utf-8")
    assert with_formulas('<span class="arithmatex">\\(a &lt; b\\)</span>').count("<mi>") == 2


@pytest.mark.parametrize("name", write_reference.PAGES)
def test_a_page_made_from_the_code_is_todays(name):
    committed = (write_reference.DOCS / name).read_text("utf-8")
    assert committed == write_reference.PAGES[name](), "python tools/write_reference.py writes it anew"


def test_the_page_of_errors_has_every_class_status_and_code():
    page = (ROOT / "docs" / "errors.md").read_text("utf-8")
    headings = set(re.findall(r"^## (\w+)$", page, re.MULTILINE))
    errors, classes = {pinik.PinikError}, [pinik.PinikError]
    while classes:
        subclasses = [one for one in classes.pop().__subclasses__() if one.__module__.startswith("pinik.")]
        errors.update(subclasses)
        classes += subclasses
    source = "\n".join(path.read_text("utf-8") for path in (ROOT / "src" / "pinik").rglob("*.py"))
    warned = set(re.findall(r"warnings\.warn\((?:[^()]|\([^()]*\))*?, (\w+Warning)", source))
    assert {error.__name__ for error in errors} | warned | {"InputWarning", "UrdfWarning"} <= headings
    for code in ADVICE:
        assert f"| `{code}` |" in page
    for status in [*pinik.Status, *pinik.TrackerStatus]:
        assert f"| `{status.name}` | {status} |" in page


def test_the_page_of_errors_has_the_messages_that_a_user_meets():
    page = (ROOT / "docs" / "errors.md").read_text("utf-8")
    with pytest.raises(pinik.InputError) as wrong:
        pinik.load("arm").solve("tip", position=[1, 2])
    with pytest.raises(pinik.UnknownNameError):
        pinik.load("arm").solve("tpi", position=[1, 2, 3])
    with pytest.warns(pinik.InputWarning) as rounded:
        pinik.Target("tip", rotation=np.eye(3) + 1e-4)
    with pytest.warns(pinik.InputWarning) as in_degrees:
        pinik.Target("tip", rpy=[180, 0, 90])
    with pytest.raises(pinik.RobotLoadError) as twice:
        pinik.load('<robot name="r"><link name="base"/><link name="base"/></robot>')
    with pytest.raises(pinik.RobotLoadError) as other_file:
        pinik.load('<robot name="r"><group_state name="home" group="arm"/></robot>')
    met = [wrong.value, rounded[0].message, in_degrees[0].message]
    met += [fault.value.cause.partition(" (line ")[0] for fault in (twice, other_file)]
    lines = re.findall(r"^    \* `` (.*) ``$", page, re.MULTILINE)
    assert [str(words) for words in met if not any(matches(line, str(words)) for line in lines)] == []
    assert "no frame '…'; did you mean '…'?" in page
    assert "`no frame '…'; available:" in page


def test_the_page_of_commands_shows_choices_as_they_are_typed_and_links_to_pages(site):
    page = (site / "command-line.html").read_text("utf-8")
    assert "<code>fixed|free_flyer|planar</code>" in html.unescape(page)
    assert "\\|" not in html.unescape(page)
    assert "docs/" not in re.sub(r"<[^>]+>", "", page)
    for other in ("json", "scale", "tracks", "solve_all"):
        assert re.search(rf'<(td|p)>[^<]*<a href="{other}\.html">', page), other


def robot_of(joint: str, link: str = "") -> str:
    return f'<robot name="r"><link name="a">{link}</link><link name="b"/>{joint}</robot>'


def joint_of(kind: str, inside: str = "") -> str:
    return f'<joint name="j" type="{kind}"><parent link="a"/><child link="b"/>{inside}</joint>'


LIMIT = '<limit lower="{}" upper="{}" effort="1" velocity="1"/>'
BOX = '<visual><geometry><box size="{}"/></geometry></visual>'

FAULTY_ROBOTS = {
    "type": robot_of(joint_of("prismatc")),
    "limits": robot_of(joint_of("revolute", LIMIT.format(1, -1))),
    "no limit": robot_of(joint_of("revolute")),
    "axis": robot_of(joint_of("continuous", '<axis xyz="0 0 0"/>')),
    "number": robot_of(joint_of("fixed", '<origin xyz="0 0"/>')),
    "large number": robot_of(joint_of("fixed", '<origin xyz="0 0 1e300"/>')),
    "no attribute": robot_of(joint_of("fixed").replace('link="b"', "", 1)),
    "no child": robot_of(joint_of("fixed").replace('<child link="b"/>', "")),
    "xacro": '<robot name="r" xmlns:xacro="x"><xacro:box/></robot>',
    "SDF": "<sdf/>",
    "no such file": "no/such/robot.urdf",
}

FLAWED_ROBOTS = {
    "mesh": robot_of(
        joint_of("fixed"), BOX.format("1 1 1").replace('<box size="1 1 1"/>', '<mesh filename="package://none/a.stl"/>')
    ),
    "shape": robot_of(joint_of("fixed"), "<visual><geometry/></visual>"),
    "size": robot_of(joint_of("fixed"), BOX.format("1 -1 1")),
    "loose number": robot_of(joint_of("fixed", '<origin xyz="0,0,1"/>')),
    "unknown": robot_of(joint_of("fixed", '<origin xyz="0 0 1" colour="2"/>')),
    "second": robot_of(joint_of("fixed", '<origin xyz="0 0 1"/><origin xyz="0 0 1"/>')),
    "mimic": robot_of(joint_of("continuous", '<mimic joint="none"/>')),
    "comment": robot_of(joint_of("fixed") + "<!-- a -- b -->"),
    "endless": robot_of(joint_of("revolute", LIMIT.format("-inf", "inf"))),
    "mass": robot_of(joint_of("fixed"), '<inertial><mass value="1"/></inertial>'),
}


def said_in(section: str) -> list[str]:
    """The messages in one section of the page of errors."""
    page = (ROOT / "docs" / "errors.md").read_text("utf-8")
    return re.findall(r"^    \* `` (.*) ``$", page.split(f"\n## {section}\n")[1].split("\n## ")[0], re.MULTILINE)


@pytest.mark.parametrize("robot", FAULTY_ROBOTS.values(), ids=FAULTY_ROBOTS)
def test_the_page_of_errors_says_why_a_robot_cannot_be_loaded(robot):
    with pytest.raises(pinik.RobotLoadError) as fault:
        pinik.load(robot)
    cause = re.sub(r" \((?:line|URDF text) .*", "", fault.value.cause)
    assert any(matches(line, cause) for line in said_in("RobotLoadError")), cause


@pytest.mark.parametrize("robot", FLAWED_ROBOTS.values(), ids=FLAWED_ROBOTS)
def test_the_page_of_errors_has_the_warnings_of_robots(robot):
    with pytest.warns(pinik.UrdfWarning):
        warnings = pinik.load(robot).warnings
    for flaw in warnings:
        assert any(matches(line, flaw.cause) for line in said_in("UrdfWarning")), flaw.cause


def test_the_page_of_errors_has_what_is_said_of_poses_checks_and_files(tmp_path):
    (tmp_path / "r.urdf").write_text(robot_of(joint_of("revolute", LIMIT.format(1, 2))))
    (tmp_path / "r.srdf").write_text('<robot><group_state name="p"><joint name="j" value="x"/></group_state></robot>')
    with pytest.raises(pinik.RobotLoadError) as pose:
        _ = pinik.load(tmp_path / "r.urdf").poses["p"]
    assert any(matches(line, pose.value.cause.partition(" (line ")[0]) for line in said_in("RobotLoadError"))
    (flaw,) = lint((tmp_path / "r.urdf").read_bytes())
    assert any(matches(line, flaw.cause) for line in said_in("pinik check"))
    assert not any(matches(line, flaw.cause) for line in said_in("UrdfWarning"))
    for section in ("RobotLoadError", "InputError"):
        assert "there is no such file" in said_in(section)


def matches(template: str, message: str) -> bool:
    return (
        re.fullmatch(".*".join(map(re.escape, template.split("…"))), message, re.DOTALL) is not None
        and len(template) > 11
    )


@pytest.fixture(scope="module")
def address(site) -> Iterator[str]:
    class Silent(http.server.SimpleHTTPRequestHandler):
        def log_message(self, *_: object) -> None:
            pass

    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), partial(Silent, directory=str(site)))
    thread = threading.Thread(target=server.serve_forever)
    thread.start()
    yield f"127.0.0.1:{server.server_port}"
    server.shutdown()
    server.server_close()
    thread.join()


def test_a_site_that_is_read_from_disk_can_be_searched(site, tmp_path):
    folder = tmp_path / "a site & 'more' #1"
    folder.symlink_to(site, target_is_directory=True)
    with need_browser().sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        context = browser.new_context(viewport={"width": 1280, "height": 800})
        faults = Faults(context)
        page = context.new_page()
        page.goto((folder / "howto" / "index.html").as_uri())
        page.keyboard.press("/")
        page.keyboard.type("did you mean")
        page.locator(".md-search-result__link[href*='/errors.html']").first.click()
        page.wait_for_url("**/errors.html*")
        browser.close()
    assert faults.left == []


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_reader_searches_and_follows_without_another_host(address, scheme):
    with need_browser().sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        context = browser.new_context(color_scheme=scheme, viewport={"width": 1280, "height": 800})
        faults = Faults(context)
        faults.allow(address)
        faults.excuse("ERR_ABORTED")  # the search was still being read when the reader went on
        page = context.new_page()
        page.goto(f"http://{address}/index.html")
        assert (
            page.locator("body").get_attribute("data-md-color-scheme") == {"light": "default", "dark": "slate"}[scheme]
        )
        page.keyboard.press("/")
        page.keyboard.type("did you mean")
        page.locator(".md-search-result__link[href*='/errors.html']").first.click()
        page.wait_for_url("**/errors.html*")
        page.goto(f"http://{address}/methods.html")
        assert page.locator("math").count() > 5
        browser.close()
    assert faults.left == []


PASTED = [
    "restarts must be a whole number of at least 0; got -1",
    "r.urdf: joint 'elbow': unknown type 'prismatc'; did you mean 'prismatic'? (line 4)",
    "joint 'elbow': lower limit 1 is above upper limit -1; either the two are swapped",
    "joint 'j': a revolute joint needs a <limit> element (line 3)",
    "mesh 'package://foo/a.stl': not found: no package 'foo' was found; kinematics works without it",
    "robot.urdf: there is no such file (URDF text would begin with '<')",
    "its child link 'hand' is not defined",
    "collision checks need coal: pip install 'pinik[collisions]'",
]
ASKED = {
    "elbow up": "howto/answers",
    "tool is 10 cm long": "howto/targets",
    "where can my robot reach": "howto/robots",
    "a million targets": "howto/motion",
    "choose_weights": "howto/answers",
}


def found(page, address: str, words: str) -> list[str]:
    """The addresses that a search finds, those of one page together, best page first."""
    page.goto(f"http://{address}/index.html?q={quote(words)}")
    page.locator(".md-search-result__link").first.wait_for()
    return [link.get_attribute("href") for link in page.locator(".md-search-result__link").all()]


def test_a_pasted_message_finds_its_place_and_a_question_its_answer(address):
    with need_browser().sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
        for message in PASTED:
            pages = list(dict.fromkeys(link.partition("?")[0] for link in found(page, address, message)))
            assert f"http://{address}/errors.html" in pages[:3], (message, pages)
        for question, answer in ASKED.items():
            assert f"/{answer}.html" in found(page, address, question)[0], question
        links = found(page, address, "a revolute joint needs a <limit> element")
        page.goto(next(link for link in links if link.endswith("#message-a-joint-needs-a-limit-element")))
        page.locator("#message-a-joint-needs-a-limit-element:visible").wait_for()
        assert page.locator("h6").count() == 0
        browser.close()


# Animations in the site


def test_an_animation_stands_where_its_still_stands_and_is_small(site):
    page = (site / "methods.html").read_text("utf-8")
    (still,) = re.findall(r'<a class="plays" href="live/methods\.html"><img alt="[^"]+" src="([^"]+)"', page)
    assert (site / still).stat().st_size + (site / "live" / "methods.html").stat().st_size < 3_000_000


@pytest.mark.parametrize(
    ("scheme", "width"), [("light", 1280), ("dark", 1280), ("dark", 390)], ids=["light", "dark", "narrow"]
)
def test_an_animation_plays_once_it_is_seen_in_the_colours_of_the_site(address, scheme, width):
    with need_browser().sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        other = {"light": "dark", "dark": "light"}[scheme]
        context = browser.new_context(color_scheme=other, viewport={"width": width, "height": 800})
        faults = Faults(context)
        faults.allow(address)
        page = context.new_page()
        page.goto(f"http://{address}/methods.html")
        page.locator("a.plays").scroll_into_view_if_needed()
        page.locator("a.plays.playing").wait_for()
        frame = page.frame_locator("a.plays iframe")
        expect = need_browser().expect
        expect(frame.locator("#clock")).to_have_text(re.compile(r"[1-9]\.\d s of 13\.0 s"))
        expect(frame.locator("html")).to_have_attribute("data-theme", other)
        page.locator("form[data-md-component=palette] label:visible").click()
        expect(frame.locator("html")).to_have_attribute("data-theme", scheme)
        assert frame.locator(".chip").count() == 4
        browser.close()
    assert faults.left == []


def test_who_wants_no_motion_gets_the_still_which_leads_to_the_animation(address):
    with need_browser().sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        page = browser.new_context(reduced_motion="reduce").new_page()
        page.goto(f"http://{address}/methods.html")
        page.locator("a.plays").scroll_into_view_if_needed()
        page.wait_for_timeout(500)
        assert page.locator("iframe").count() == 0
        page.locator("a.plays").click()
        page.wait_for_function("window.pinik?.player")
        assert page.url.endswith("/live/methods.html")
        browser.close()


@pytest.mark.parametrize(("motion", "height"), [("reduce", 9 / 16), ("no-preference", 1.0)])
def test_a_still_is_whole_on_a_narrow_page(address, motion, height):
    with need_browser().sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        page = browser.new_context(reduced_motion=motion, viewport={"width": 390, "height": 800}).new_page()
        page.goto(f"http://{address}/methods.html")
        box = page.locator("a.plays").bounding_box()
        fit = page.locator("a.plays img").evaluate("image => getComputedStyle(image).objectFit")
        assert box["height"] / box["width"] == pytest.approx(height, abs=0.01)
        assert fit == "contain" or motion == "reduce"
        browser.close()


def test_the_methods_behave_as_the_page_says():
    """Seen by plain Pinocchio in what the animation shows."""
    recording = filmed(PLAYED["methods"]).recorded()
    model = recording.robot.model
    data, tip = model.createData(), model.getFrameId("tip")
    (ball,) = recording.balls
    errors, speeds = {}, {}
    for name, q in zip(recording.names, recording.q, strict=True):
        places = []
        for one in q:
            pinocchio.framesForwardKinematics(model, data, one)
            places.append(data.oMf[tip].translation.copy())
        errors[name] = np.linalg.norm(np.array(places) - ball.positions, axis=1)
        speeds[name] = np.abs(np.diff(q, axis=0)).max(axis=1) / np.diff(recording.times)
    times = recording.times
    laps, away = (times > 0.5) & (times < 8.0), (times > 10.0) & (times < 12.0)
    assert times[-1] == pytest.approx(13.0, abs=0.1)
    assert all(errors[name][laps].max() < 0.0002 for name in ("dls", "pinv"))
    assert all(0.010 < errors[name][laps].max() < 0.0155 for name in ("ccd", "jt"))
    for name, within, calm in (("dls", 0.0005, 0.01), ("ccd", 0.0015, 0.2), ("jt", 0.0035, 0.2)):
        np.testing.assert_allclose(errors[name][away], 0.1574, atol=within)
        assert speeds[name][away[1:]].max() < calm
    assert errors["pinv"][away].max() > 0.35
    assert speeds["pinv"][away[1:]].max() > 5.0
