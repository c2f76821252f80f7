"""All commands put together, and how their errors become exit statuses."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import Annotated, Any

import typer

from ..errors import PinikError
from ..version import __version__
from .commands import accuracy, check, compare, fk, info, jacobian, live, robots, solve
from .terminal import output
from .terminal.exits import CommandError, ExitStatus, in_words

__all__ = ["main"]

_app = typer.Typer(
    name="pinik",
    rich_markup_mode="rich",
    add_completion=False,
    context_settings={"help_option_names": ["--help", "-h"]},
)
_app.command("solve", epilog=solve.EPILOG)(solve.solve)
_app.command("fk")(fk.fk)
_app.command("jacobian")(jacobian.jacobian)
_app.command("info")(info.info)
_app.command("check")(check.check)
_app.command("robots")(robots.robots)
_app.command("live")(live.live)
_app.command("compare", epilog=compare.EPILOG)(compare.compare)
_app.command("accuracy")(accuracy.accuracy)


@_app.callback(invoke_without_command=True)
def _pinik(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Show the version and exit.")] = False,
) -> None:
    """Inverse kinematics on any URDF: where its frames are, and which joint angles put them elsewhere.

    Exit status: 0 solved or answered, 1 a target missed (the best answer is still
    printed), 2 wrong usage or bad input, 3 the robot could not be loaded, 130 interrupted.

    Example:

      pinik solve arm --frame tip --position 0.3 0.1 0.8
    """
    if version:
        output.emit(f"pinik {__version__}")
        raise typer.Exit(ExitStatus.ANSWERED)
    if context.invoked_subcommand is None:
        raise CommandError("no command given; 'pinik --help' lists them")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command line.

    Args:
        arguments: Everything after "pinik"; this process's own when None.

    Returns:
        The exit status, see `ExitStatus`.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    try:
        output.prepare_streams()
        if not {"--help", "-h"}.isdisjoint(words):
            _keep_help_texts_plain()
        command = typer.main.get_command(_app)
        # The commands return their status; --help and --version, which leave early, come back as one too.
        returned = command.main(args=words, prog_name="pinik", standalone_mode=False)
        status = ExitStatus(returned or ExitStatus.ANSWERED)
        output.finish()
    except typer.TyperException as error:
        status = _wrong_usage(error, words)
    except CommandError as error:
        status = output.say_error(str(error), error.status)
    except SystemExit:  # Typer's, and rich's: the reader of the help has gone
        output.abandon_stdout()
        status = ExitStatus.ANSWERED
    except (PinikError, OSError) as error:
        status = output.say_error(str(error), ExitStatus.WRONG_USAGE)
    except (KeyboardInterrupt, typer.Abort):
        status = ExitStatus.INTERRUPTED
    except Exception as error:
        status = output.say_error(f"unforeseen, please report it: {in_words(error)}", ExitStatus.WRONG_USAGE)
    if status is ExitStatus.INTERRUPTED:
        output.say("interrupted")
    return status


def _keep_help_texts_plain() -> None:
    """Let the help paint the names of options alone, not every hyphen in a text."""
    from typer import rich_utils

    rich_utils.OptionHighlighter.highlights = [r"^(?P<option>--[\w-]+)$", r"^(?P<switch>-\w)$", "(?P<usage>Usage: )"]


def _wrong_usage(error: typer.TyperException, words: Sequence[str]) -> ExitStatus:
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "pinik"
    if command == "pinik":  # some errors do not know their command
        names = {info.name for info in _app.registered_commands}
        command = " ".join(["pinik", *[word for word in words if word in names][:1]])
    message = error.format_message().rstrip(".")
    faults: list[Any] = getattr(error.__cause__, "errors", list)()
    if faults and isinstance(error, typer.BadParameter):
        kind = "a whole number" if "int" in faults[0]["type"] else "a number"
        message = message.removesuffix(error.message.rstrip(".")) + f"{faults[0]['input']!r} is not {kind}"
    return output.say_error(f"{message}; see '{command} --help'", ExitStatus.WRONG_USAGE)
