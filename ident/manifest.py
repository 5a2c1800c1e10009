"""What made a result: versions, machine, seed, configuration as used."""

import os
import platform
import sys
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from ident.configuration import Configuration

_LIBRARIES = ("numpy", "scipy", "numba", "pandas", "matplotlib", "control")


def versions() -> dict[str, str]:
    """Version of the program, of Python and of the libraries that compute."""
    found = {"cable-ident": _version("cable-ident"), "python": platform.python_version()}
    return found | {name: _version(name) for name in _LIBRARIES}


def manifest(command: str, configuration: Configuration, seed: int | None, **more: Any) -> dict[str, Any]:
    """The content of manifest.json; `more` is what the study itself adds."""
    return {
        "program": "cable-ident",
        "command": command,
        "seed": seed,
        "versions": versions(),
        "machine": {
            "system": f"{platform.system()} {platform.machine()}",
            "processors": os.cpu_count(),
            "byte_order": sys.byteorder,
        },
        **more,
        "configuration_name": configuration.name,
        "configuration": configuration.text,
    }


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"
