"""Where the machine code of the kernels is kept, and how they are compiled."""

import importlib
import os
import pkgutil
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from numba.core.dispatcher import Dispatcher

import models
from models import kernels

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture
def tree(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A copy of the sources, as the folder that the digest is made over."""
    copy = tmp_path / "models"
    shutil.copytree(ROOT / "models", copy, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(kernels, "__file__", str(copy / "kernels.py"))
    return copy


def test_an_edit_of_any_source_changes_the_folder(tree: Path) -> None:
    before = kernels._cache_folder()
    assert before.name.startswith("kernels-")
    for source in (tree / "statics.py", tree / "spectral" / "basis.py"):
        text = source.read_bytes()
        source.write_bytes(text + b"# edited\n")
        assert kernels._cache_folder() != before
        source.write_bytes(text)
        assert kernels._cache_folder() == before


def test_a_new_or_renamed_source_changes_the_folder(tree: Path) -> None:
    before = kernels._cache_folder()
    (tree / "tow.py").rename(tree / "towing.py")
    renamed = kernels._cache_folder()
    (tree / "more.py").write_text("")
    assert len({before, renamed, kernels._cache_folder()}) == 3


def test_what_is_no_source_and_when_it_was_touched_do_not_count(tree: Path) -> None:
    before = kernels._cache_folder()
    (tree / "notes.txt").write_text("x")
    os.utime(tree / "statics.py", (1.0, 1.0))
    assert kernels._cache_folder() == before


def test_the_folder_lies_in_the_users_cache(tree: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    assert kernels._cache_folder().parent == tmp_path / "cache" / "cable-ident"
    monkeypatch.setenv("XDG_CACHE_HOME", "")
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    monkeypatch.setenv("USERPROFILE", str(tmp_path / "home"))
    assert kernels._cache_folder().parent == tmp_path / "home" / ".cache" / "cable-ident"


def folder_of_numba(environment: dict[str, str]) -> str:
    code = "import models.kernels, numba; print(numba.config.CACHE_DIR)"
    kept = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env=kept | environment, capture_output=True, text=True, check=True
    )
    return done.stdout.strip()


def test_numba_uses_the_folder_unless_the_user_names_one(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert folder_of_numba({"XDG_CACHE_HOME": str(tmp_path)}) == str(kernels._cache_folder())
    own = str(tmp_path / "own")
    assert folder_of_numba({"XDG_CACHE_HOME": str(tmp_path), "NUMBA_CACHE_DIR": own}) == own


def test_every_kernel_releases_the_lock_divides_as_ieee_and_compiles_late() -> None:
    found = {
        f"{module.name}.{name}": value
        for module in pkgutil.walk_packages(models.__path__, "models.")
        for name, value in vars(importlib.import_module(module.name)).items()
        if isinstance(value, Dispatcher)
    }
    assert "models.link_joint.march._march_into" in found
    for name, each in found.items():
        assert each.targetoptions["nogil"] is True, name
        assert each.targetoptions["error_model"] == "numpy", name
        assert each._cache.cache_path, name  # cached on disk
        assert each._can_compile, name  # no explicit signature
