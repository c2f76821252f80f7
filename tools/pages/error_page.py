"""docs/errors.md, from the code: every class of error and warning, what to do about it, and its messages."""

from __future__ import annotations

import inspect
import re

import pinik
from pages.messages import BY_CHECK, COMMAND_LINE, messages
from pinik.description.advice import ADVICE
from pinik.scale.jobs import cluster

WHAT_TO_DO = {
    "PinikError": "Catch it to catch all errors that pinik raises on purpose. Any other exception is a fault of pinik: "
    "please report it.",
    "InputError": "Read the requirement in the message, and change the argument that it begins with. `error.argument` "
    "has its name.",
    "UnknownNameError": "Take one of the names that the message suggests; `error.valid` has all of them. If no name is "
    "similar, the message has the form `no frame '…'; available: '…', '…'`, or ends with `there are none`.",
    "RobotLoadError": "The message names the element and its line. `pinik check FILE` shows all faulty joints at once, "
    "and `pinik check FILE --fix OUT.urdf` mends what has one answer.",
    "SolveError": "The target was missed; `error.solution` has the best configuration and says why. "
    "[Missed targets](howto/answers.md#why-was-my-target-missed) has the usual causes.",
    "EngineError": 'Leave out `engine="native"`, or install pinik where a C++ compiler is, as the message says.',
    "MissingExtraError": "Run the install line that the message ends with.",
    "ClusterError": "Start the scheduler or its workers, or install the same versions on all machines.",
    "InputWarning": "The answer is for the nearest rotation matrix: give more digits, or take a quaternion. "
    "Angles are taken as radians, as everywhere.",
    "UrdfWarning": "The robot works, and something in its file is not as it should be. `pinik check FILE` says more. "
    "With `pinik.load(..., strict=True)` it is an error.",
    "RuntimeWarning": "Install pinik again: its compiled engine belongs to another build, so solves run in Python.",
    "DeprecationWarning": "Use the new name, which the message gives. The old one works for one more minor version; "
    "see [Versions](versions.md).",
}

STATUSES = {
    "CONVERGED": "Nothing.",
    "STALLED": "The message says what can be reached alone, and which joints are at their limits. Try more `restarts`, "
    "a wider `tolerance`, or an axis instead of a full orientation.",
    "MAX_ITERATIONS": "Raise `max_iterations`, or take `dls`.",
    "TIME_LIMIT": "Raise `time_limit`; the best configuration so far is the answer.",
    "UNREACHABLE": "It is proved that no configuration reaches it. The message says by how much; `solution.q` is the "
    "nearest configuration found.",
    "COLLIDING": "The message names what touches. Change the target or the world, or give `solve` more `restarts`.",
}

TRACKER_STATUSES = {
    "OK": "Nothing.",
    "LIMITED": "Call again: the next ticks bring the frame nearer. Raise the speeds if it lags behind.",
    "HELD": "Move the target back, or go on from another branch.",
    "BLOCKED": "Move the target or the obstacle away.",
}

INTRODUCTION = """\
# Errors and warnings

Wrong arguments and files raise an error that says what was expected and what was given. A target that is missed is no
error: the solution says so, and why. Every error is a `pinik.PinikError` and also the builtin that it resembles, so
`except ValueError` catches an `InputError`.

To find a message that you have met, paste its words into the search field of this site. `…` stands for what differs: a
name, a number, or the rest of a sentence. This page is made from the code.

## How a solve ends

`solution.status` is one of these, and `solution.message` says more:

| status | meaning | what to do |
|---|---|---|
"""


def error_page() -> str:
    text = INTRODUCTION
    text += "".join(f"| `{one.name}` | {one.value} | {STATUSES[one.name]} |\n" for one in pinik.Status)
    text += "\nA `Tracker` says after each tick how it went:\n\n| status | meaning | what to do |\n|---|---|---|\n"
    text += "".join(f"| `{one.name}` | {one.value} | {TRACKER_STATUSES[one.name]} |\n" for one in pinik.TrackerStatus)
    found = messages()
    for name, advice in WHAT_TO_DO.items():
        text += f"\n## {name}\n\n{_meaning(name)}\n\n**What to do:** {advice}\n" + _table(found.get(name, set()))
        if name == "UrdfWarning":
            text += _flaws()
    text += "\n## pinik check\n\n[`pinik check`](check.md) alone tells these:\n"
    text += _table(found[BY_CHECK])
    text += "\n## The command line\n\nA command prints its error on stderr and ends with a [status](command-line.md"
    text += "#exit-statuses) other than 0. It has all messages above, and these:\n" + _table(found[COMMAND_LINE])
    return text


def _meaning(name: str) -> str:
    named = getattr(pinik, name, getattr(cluster, name, None))
    if named is None:
        return f"Python's own `{name}`."
    builtins = [base.__name__ for base in named.__bases__ if base.__module__ == "builtins" and base is not Exception]
    meaning = re.sub(r"\n(?=\S)", " ", inspect.cleandoc(named.__doc__).split("\n\n")[0])
    return f"{meaning} It is also a `{builtins[0]}`." if builtins else meaning


def _table(found: set[str]) -> str:
    if not found:
        return ""
    in_order = sorted(found, key=lambda message: (message.casefold(), message))
    rows = "".join(f"    * {_escaped(message)}\n" for message in in_order)
    return f'\n??? info "{len(found)} message{"s" * (len(found) > 1)}"\n\n{rows}'


def _escaped(message: str) -> str:
    return "`` " + message.replace("\n", " ").replace("``", "` `") + " ``"


def _flaws() -> str:
    rows = "".join(f"| `{code}` | {advice.why} | {advice.mend} |\n" for code, advice in ADVICE.items())
    return (
        "\nA flaw of a robot description has a code, which `warning.code` and [`pinik check`](check.md#codes) show:\n\n"
        "| code | why it matters | what to do |\n|---|---|---|\n" + re.sub(r"(<[^>|`]+>)", r"`\1`", rows)
    )
