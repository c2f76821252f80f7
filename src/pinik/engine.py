"""The compiled engine: the module `pinik._native`, or the reason why it cannot be used."""

from __future__ import annotations

import functools
import importlib.util
import warnings
from typing import Any

import coal  # which Pinocchio has imported already
import pinocchio

__all__ = ["ABI", "load"]

ABI = "00d16a990ebe3c40"
"""The digest of the module's stub, which identifies its signatures; the module contains the same digest
(src/native/bindings/abi.hpp)."""


@functools.cache
def load() -> Any:
    """Return the compiled module, or a string that says why it cannot be used."""
    if importlib.util.find_spec("pinik._native") is None:
        return "it was not built when pinik was installed: no C++ compiler worked, or the wheel was the pure one"
    try:
        from . import _native
    except ImportError as error:
        return f"it does not load: {error}"
    if getattr(_native, "abi", None) != ABI:
        why = "the compiled module belongs to another build of pinik; install pinik again"
        warnings.warn(f"pinik solves in Python, tens of times slower: {why}", RuntimeWarning, stacklevel=2)
        return why
    built = {"Pinocchio": _native.pinocchio_version, "coal": _native.coal_version}
    for name, here in (("Pinocchio", pinocchio.__version__), ("coal", coal.__version__)):
        if built[name] != here:
            return f"it was built against {name} {built[name]}, and {here} is installed; install pinik again"
    return _native
