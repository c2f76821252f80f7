"""What every figure needs beside it: the machine and the versions."""

from __future__ import annotations

import os
import platform

import numpy
import pinocchio

import pinik


def pytest_report_header() -> str:
    machine = f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, {platform.platform()}"
    versions = f"pinik {pinik.__version__}, Pinocchio {pinocchio.__version__}, numpy {numpy.__version__}"
    return f"measured on: {machine}; {versions}"
