"""Fingerprints: what the results of a job depend on, by name. Two that differ say where."""

from __future__ import annotations

import functools
import json
import platform
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio

from ...echoes import QUOTED, shortened
from ...engine import ABI, load
from ...version import __version__

__all__ = ["Fingerprint", "as_json", "differences", "versions"]

Fingerprint = Mapping[str, Any]
"""Name → what can be written as JSON, such as {"inputs": …, "options": {…}, "robot": …, "versions": versions()}."""

_MOST_LISTED = 5


@functools.cache
def _versions() -> tuple[tuple[str, str], ...]:
    module = load()
    return (
        ("pinik", __version__),
        ("engine", "none" if isinstance(module, str) else ABI),
        ("pinocchio", pinocchio.__version__),
        ("numpy", np.__version__),
        ("python", ".".join(platform.python_version_tuple()[:2])),
        ("processor", _processor()),
    )


def versions() -> dict[str, str]:
    """The versions in this process on which the last bits of answers depend, by name."""
    return dict(_versions())


def _processor() -> str:
    """The kind of processor: the compiled engine and numpy round otherwise where it has AVX2 and FMA."""
    kind = platform.machine()
    try:
        flags = Path("/proc/cpuinfo").read_text("utf-8").partition("flags")[2].partition("\n")[0].split()
    except OSError:
        return kind
    wide = [name for name in ("avx2", "fma", "avx512f") if name in flags]
    return f"{kind} with {', '.join(wide)}" if wide else kind


def as_json(fingerprint: Fingerprint) -> dict[str, Any]:
    """The fingerprint as JSON gives it back: tuples become lists, and keys become texts."""
    read: dict[str, Any] = json.loads(json.dumps(fingerprint))
    return read


def differences(before: Fingerprint, now: Fingerprint) -> str:
    """Where two fingerprints differ, in words: "options.seed was 0 and is 1"; empty where they are equal."""
    old, new = _flat(as_json(before)), _flat(as_json(now))
    parts = []
    for name in [*old, *(name for name in new if name not in old)]:
        if name not in new:
            parts.append(f"{name} was {_quoted(old[name])} and is not given")
        elif name not in old:
            parts.append(f"{name} was not given and is {_quoted(new[name])}")
        elif old[name] != new[name]:
            parts.append(f"{name} was {_quoted(old[name])} and is {_quoted(new[name])}")
    more = len(parts) - _MOST_LISTED
    return ", ".join(parts[:_MOST_LISTED]) + (f", and {more} more" if more > 0 else "")


def _flat(value: Any, name: str = "") -> dict[str, Any]:
    if not isinstance(value, dict):
        return {name: value}
    flat: dict[str, Any] = {}
    for key, item in value.items():
        flat |= _flat(item, f"{name}.{key}" if name else key)
    return flat


def _quoted(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return f"{text[:9]}…{text[-1]}" if _is_digest(value) else shortened(text, QUOTED)


def _is_digest(value: Any) -> bool:
    return isinstance(value, str) and len(value) == 64 and not set(value) - set("0123456789abcdef")
