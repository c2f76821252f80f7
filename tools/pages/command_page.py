"""docs/command-line.md, from the commands' own help: each with its usage, arguments and options."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import typer

from pinik.cli.app import _application
from pinik.cli.terminal.exits import ExitStatus

DOCS = Path(__file__).parents[2] / "docs"

INTRODUCTION = """\
# Command line

`pip install 'pinik[cli]'` brings the `pinik` command. Results go to stdout and messages to stderr. Every command that
prints results takes `--json`; [JSON](json.md) describes the fields. Lengths are in metres, and angles in radians, or in
degrees with `--deg`. A `-` in place of a file is stdin.

This page is made from the commands themselves, which say the same with `--help`.

## Exit statuses

| status | meaning |
|---|---|
"""

STREAMS = """
If stdout is closed or its disk is full, the answer is lost, and the status is 2. If only the reader of a pipe has gone,
as in `pinik info arm | head`, the command ends silently with its usual status. Messages that cannot be written to
stderr do not change the status. Files that pinik writes are written whole or not at all: an error or an interrupt
leaves the file that was there before.
"""

STATUSES = {
    ExitStatus.ANSWERED: "all targets are solved, or the question is answered",
    ExitStatus.MISSED: "a target was missed; the best answer is still printed",
    ExitStatus.WRONG_USAGE: "wrong usage, bad input, or an answer or a file that cannot be written",
    ExitStatus.NO_ROBOT: "the robot cannot be loaded",
    ExitStatus.INTERRUPTED: "Ctrl-C (SIGINT) ended the command",
    ExitStatus.TERMINATED: "SIGTERM ended the command",
}


def command_page() -> str:
    statuses = "".join(f"| {status.value} | {STATUSES[status]} |\n" for status in ExitStatus)
    commands = typer.main.get_command(_application(())).commands.items()
    return INTRODUCTION + statuses + STREAMS + "".join(_command(name, command) for name, command in commands)


def _command(name: str, command: Any) -> str:
    text = f"\n## pinik {name}\n\n{_prose(command.help)}"
    context = typer.Context(command, info_name=f"pinik {name}")
    usage = " ".join(command.collect_usage_pieces(context))
    text += f"\n```text\npinik {name} {usage}\n```\n"
    panels: dict[str, list[Any]] = {}
    for parameter in command.params:
        if parameter.name != "help":
            panels.setdefault(getattr(parameter, "rich_help_panel", None) or "", []).append(parameter)
    for panel, parameters in panels.items():
        if panel:
            text += f"\n**{panel}**\n"
        text += "\n| | |\n|---|---|\n" + "".join(_row(parameter, context) for parameter in parameters)
    if command.epilog:
        text += f'\n??? note "{command.epilog.partition(":")[0]}"\n\n    ```text\n'
        body = command.epilog.partition("\n\n")[2] if "\n\n" in command.epilog else command.epilog
        text += "".join(f"    {line}\n" if line else "\n" for line in _plain(body).splitlines()) + "    ```\n"
    return text


def _row(parameter: Any, context: Any) -> str:
    names = ", ".join(f"`{name}`" for name in [*parameter.opts, *parameter.secondary_opts] if name.startswith("-"))
    is_flag = getattr(parameter, "is_flag", False)
    metavar = parameter.metavar or ("" if is_flag else parameter.display_type(context).upper())
    # Markdown's readers do not agree how a bar is written in a table's code.
    value = f"<code>{metavar.replace('|', '&#124;')}</code>" if "|" in metavar else f"`{metavar}`"
    shown = f"{names} {value}" if names and not is_flag else names or value
    words = re.sub(r"([\[\]|])", r"\\\1", _plain(getattr(parameter, "help", None) or "")).replace("\n", " ")
    return f"| {shown} | {_linked(words)}{_default(parameter, is_flag)} |\n"


def _default(parameter: Any, is_flag: bool) -> str:
    default = parameter.default
    if is_flag or default in (None, (), [], "") or callable(default) or not getattr(parameter, "show_default", True):
        return ""
    value = getattr(default, "value", default)
    value = " ".join(map(str, value)) if isinstance(value, (list, tuple)) else value
    return f" Default: `{value}`."


def _prose(text: str) -> str:
    return "\n\n".join(_paragraphs(_plain(text))) + "\n"


def _paragraphs(text: str) -> Iterator[str]:
    """The paragraphs of a help text; indented examples become a block of code."""
    for paragraph in text.split("\n\n"):
        if paragraph.startswith(" "):
            lines = "\n".join(line.removeprefix("  ") for line in paragraph.splitlines())
            yield f"```sh\n{lines}\n```"
        else:
            yield _linked(paragraph.strip())


def _linked(words: str) -> str:
    """Links, by their titles, to the pages that help texts name by their files."""
    return re.sub(r"docs/(\w+\.md)", lambda page: f"[{_title(page[1])}]({page[1]})", words)


def _title(page: str) -> str:
    return (DOCS / page).read_text("utf-8").partition("\n")[0].removeprefix("# ")


def _plain(text: str) -> str:
    """Without rich's escapes."""
    return re.sub(r"\\\[", "[", text)
