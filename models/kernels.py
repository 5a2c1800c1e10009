"""The one decorator of the compiled kernels, and where their machine code is kept.

A kernel that calls kernels of other files keeps their code inside its own cache entry, which numba renews only
when its own file changes. The cache folder therefore carries a digest of every source file of `models`: an edit
or an upgrade can never run old code. ``NUMBA_CACHE_DIR`` set by the user wins.
"""

import hashlib
import os
import shutil
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar, cast

import numba

_F = TypeVar("_F", bound=Callable[..., Any])


def _cache_folder() -> Path:
    digest = hashlib.sha256()
    folder = Path(__file__).parent
    for source in sorted(folder.rglob("*.py")):
        digest.update(source.relative_to(folder).as_posix().encode())
        digest.update(source.read_bytes())
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    return base / "cable-ident" / f"kernels-{digest.hexdigest()[:16]}"


def _drop_old(folder: Path, keep: int = 4) -> None:
    """Delete the kernels of older sources but a few, so that edits and upgrades do not pile up."""
    with suppress(OSError):
        others = sorted(
            (each for each in folder.parent.glob("kernels-*") if each != folder), key=lambda each: each.stat().st_mtime
        )
        for each in others[: -keep or None]:
            shutil.rmtree(each, ignore_errors=True)


if "NUMBA_CACHE_DIR" not in os.environ:
    _drop_old(_cache_folder())
    setattr(numba.config, "CACHE_DIR", str(_cache_folder()))  # noqa: B010 (numba makes its settings at run time)


def kernel(function: _F) -> _F:
    """Compile at first use, keep the machine code, release the interpreter lock, divide as IEEE does."""
    compiled: Any = numba.njit(cache=True, nogil=True, error_model="numpy")(function)
    return cast(_F, compiled)


def fast_kernel(function: _F) -> _F:
    """`kernel` that may reorder sums, for loops over stations and sines; infinities and NaN stay exact."""
    flags = {"contract", "reassoc", "nsz"}
    compiled: Any = numba.njit(cache=True, nogil=True, error_model="numpy", fastmath=flags)(function)
    return cast(_F, compiled)


def inner_kernel(function: _F) -> _F:
    """`kernel` that only kernels call: without a way in from Python, which costs as much to compile as the rest."""
    alone: Any = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    compiled: Any = numba.njit(cache=True, nogil=True, error_model="numpy", **alone)(function)
    return cast(_F, compiled)


def inline_kernel(function: _F) -> _F:
    """`kernel` written into its callers: for the parts of an inner loop that take many arrays."""
    compiled: Any = numba.njit(cache=True, nogil=True, error_model="numpy", forceinline=True)(function)
    return cast(_F, compiled)
