"""All commands put together, and how their errors become exit statuses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import typer

from ..errors import PinikError
from . import check, fk, info, jacobian, output, robots, solve
from .exits import CommandError, ExitStatus

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
        from .. import __version__

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
    try:
        output.prepare_streams()
        command = typer.main.get_command(_app)
        # The commands return their status; --help and --version, which leave early, come back as one too.
        returned = command.main(args=arguments, prog_name="pinik", standalone_mode=False)
        status = ExitStatus(returned or ExitStatus.ANSWERED)
    except typer.TyperException as error:
        status = _wrong_usage(error)
    except CommandError as error:
        status = output.say_error(str(error), error.status)
    except (PinikError, OSError) as error:
        status = output.say_error(str(error), ExitStatus.WRONG_USAGE)
    except (KeyboardInterrupt, typer.Abort):
        status = ExitStatus.INTERRUPTED
    if status is ExitStatus.INTERRUPTED:
        output.say("interrupted")
    return status


def _wrong_usage(error: typer.TyperException) -> ExitStatus:
    context = getattr(error, "ctx", None)
    command = context.command_path if context is not None else "pinik"
    message = error.format_message().rstrip(".")
    return output.say_error(f"{message}; see '{command} --help'", ExitStatus.WRONG_USAGE)
