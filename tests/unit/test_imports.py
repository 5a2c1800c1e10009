"""Which packages are imported, and how little the command line needs to start."""

import importlib
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HEAVY = ("numba", "scipy", "control", "pandas", "matplotlib")


def loaded_by(code: str) -> set[str]:
    """Top-level names of the modules that a fresh interpreter holds after the code."""
    code += "\nimport sys; sys.stderr.write(' '.join(sorted({name.partition('.')[0] for name in sys.modules})))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    return set(done.stderr.split())


@pytest.mark.parametrize("package", ["models", "data_synth", "reports", "ident"])
def test_packages_are_those_of_this_checkout(package: str) -> None:
    file = importlib.import_module(package).__file__
    assert file is not None
    assert Path(file).resolve().parent == ROOT / package


def test_command_line_starts_without_the_heavy_libraries() -> None:
    loaded = loaded_by("import ident.cli")
    assert "typer" in loaded
    assert loaded.isdisjoint({*HEAVY, "numpy", "rich"})


def test_light_commands_need_no_heavy_library(tmp_path: Path) -> None:
    lines = [["--help"], ["list"], ["show", "mangus-740"], ["new", str(tmp_path / "new.toml")], ["run", "--help"]]
    loaded = loaded_by(f"from ident.cli import main\nfor line in {lines!r}:\n    assert main(line) == 0")
    assert loaded.isdisjoint({*HEAVY, "numpy"})


def test_configuration_module_needs_no_heavy_library() -> None:
    assert loaded_by("import ident.configuration").isdisjoint(HEAVY)
