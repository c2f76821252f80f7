"""A pytest plugin that loads the engine that was built with sanitizers, before pinik loads the installed one.

`make sanitize` names its path in PINIK_SANITIZED_ENGINE.
"""

from __future__ import annotations

import importlib.util
import os
import sys

import pinocchio  # noqa: F401  loads the libraries that the engine needs

spec = importlib.util.spec_from_file_location("pinik._native", os.environ["PINIK_SANITIZED_ENGINE"])
assert spec is not None
assert spec.loader is not None
module = importlib.util.module_from_spec(spec)
sys.modules["pinik._native"] = module
spec.loader.exec_module(module)
