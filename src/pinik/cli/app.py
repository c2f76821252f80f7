"""The command line as a whole: all commands together, and the exit status of every error."""

from __future__ import annotations

import inspect
import sys
import warnings
from collections.abc import Callable, Sequence
from typing import Annotated, Any

import numpy as np
import typer

from ..errors import PinikError
from ..interrupts import Terminated, as_exceptions
from ..version import __version__
from .commands import (
    accuracy,
    batch,
    check,
    collisions,
    compare,
    fk,
    info,
    jacobian,
    live,
    reach,
    robots,
    solve,
    solve_all,
    track,
)
from .reports.solver_help import solvers_help
from .terminal import output
from .terminal.exits import CommandError, ExitStatus, in_words

__all__ = ["main"]

_COMMANDS: dict[str, Callable[..., ExitStatus]] = {
    "solve": solve.solve,
    "solve-all": solve_all.solve_all,
    "track": track.track,
    "reach": reach.reach,
    "batch": batch.batch,
    "fk": fk.fk,
    "jacobian": jacobian.jacobian,
    "info": info.info,
    "check": check.check,
    "collisions": collisions.collisions,
    "robots": robots.robots,
    "live": live.live,
    "compare": compare.compare,
    "accuracy": accuracy.accuracy,
}


def _application() -> typer.Typer:
    """The commands with their help, which names the methods that are registered now."""
    app = typer.Typer(
        name="pinik",
        rich_markup_mode="rich",
        add_completion=False,
        context_settings={"help_option_names": ["--help", "-h"]},
    )
    methods = dict.fromkeys(("solve", "solve-all", "track", "reach", "batch"), solvers_help())
    epilogs = methods | {"compare": compare.EPILOG}
    for name, command in _COMMANDS.items():
        app.command(name, help=_flowing(command.__doc__), epilog=epilogs.get(name))(command)
    app.callback(invoke_without_command=True, help=_flowing(_pinik.__doc__))(_pinik)
    return app


def _flowing(text: str | None) -> str:
    """A docstring as help, whose paragraphs break where the terminal ends; the lines of examples, indented, stay."""
    paragraphs = inspect.cleandoc(text or "").split("\n\n")
    return "\n\n".join(one if one.startswith(" ") else one.replace("\n", " ") for one in paragraphs)


def _pinik(
    context: typer.Context,
    version: Annotated[bool, typer.Option("--version", help="Show the version and exit.")] = False,
) -> None:
    """Inverse and forward kinematics for any robot with a URDF file.

    Exit status: 0 for success, 1 if a target was missed (the best answer is still
    printed), 2 for wrong usage, bad input or an answer that cannot be written, 3 if
    the robot cannot be loaded, 130 if interrupted (Ctrl-C), 143 if terminated.

    Example:

      pinik solve arm --frame tip --position 0.3 0.1 0.8
    """
    if version:
        output.emit(f"pinik {__version__}")
        raise typer.Exit(ExitStatus.ANSWERED)
    if context.invoked_subcommand is None:
        raise CommandError("no command given; 'pinik --help' lists the commands")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command line.

    Args:
        arguments: Everything after "pinik"; this process's own when None.

    Returns:
        The exit status, see `ExitStatus`.
    """
    words = list(sys.argv[1:] if arguments is None else arguments)
    try:
        # numpy need not warn of infinities and NaN, as plain Pinocchio checks each answer.
        with as_exceptions(), warnings.catch_warnings(), np.errstate(all="ignore"):
            warnings.showwarning = _show_warning
            output.prepare_streams()
            return _run(words)
    except (KeyboardInterrupt, typer.Abort):
        output.say("interrupted")
        return ExitStatus.INTERRUPTED
    except Terminated:
        output.say("terminated")
        return ExitStatus.TERMINATED


def _run(words: Sequence[str]) -> ExitStatus:
    """Run one command line; only interrupts are raised."""
    for_help = not {"--help", "-h"}.isdisjoint(words)
    try:
        if for_help:
            _keep_help_texts_plain()
        command = typer.main.get_command(_application())
        # The commands return their status, and so do --help and --version, which end early.
        returned = command.main(args=list(words), prog_name="pinik", standalone_mode=False)
        if returned == ExitStatus.INTERRUPTED:  # which Typer makes of a KeyboardInterrupt
            raise KeyboardInterrupt
        output.finish()
        return ExitStatus(returned or ExitStatus.ANSWERED)
    except typer.TyperException as error:
        return _wrong_usage(error, words)
    except typer.Abort:
        raise
    except CommandError as error:
        return output.say_error(str(error), error.status)
    except SystemExit:  # raised by Typer and rich when the reader of the help has gone
        output.abandon(sys.stdout)
        return ExitStatus.ANSWERED
    except OSError as error:
        if not for_help:
            return output.say_error(str(error), ExitStatus.WRONG_USAGE)
        output.abandon(sys.stdout)
        return output.say_error(f"cannot write the help: {output.reason_of(error)}", ExitStatus.WRONG_USAGE)
    except PinikError as error:
        return output.say_error(str(error), ExitStatus.WRONG_USAGE)
    except Exception as error:
        return output.say_error(f"unexpected, please report it: {in_words(error)}", ExitStatus.WRONG_USAGE)


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    """A warning of any library on one line of stderr, without the place in the code."""
    output.warn(str(message))


def _keep_help_texts_plain() -> None:
    """Let the help colour the names of options only, not every hyphen in a text."""
    from typer import rich_utils

    rich_utils.OptionHighlighter.highlights = [r"^(?P<option>--[\w-]+)$", r"^(?P<switch>-\w)$", "(?P<usage>Usage: )"]


def _wrong_usage(error: typer.TyperException, words: Sequence[str]) -> ExitStatus:
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "pinik"
    if command == "pinik":  # some errors do not know their command
        command = " ".join(["pinik", *[word for word in words if word in _COMMANDS][:1]])
    message = error.format_message().rstrip(".")
    faults: list[Any] = getattr(error.__cause__, "errors", list)()
    if faults and isinstance(error, typer.BadParameter):
        kind = "a whole number" if "int" in faults[0]["type"] else "a number"
        message = message.removesuffix(error.message.rstrip(".")) + f"{faults[0]['input']!r} is not {kind}"
    return output.say_error(f"{message}; see '{command} --help'", ExitStatus.WRONG_USAGE)
