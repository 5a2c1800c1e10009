"""Where results go: built beside their place and moved in when complete, so that nothing half-written looks whole."""

import os
import secrets
import shutil
import threading
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from models.quantity import InvalidInput

#: Set when the user has asked to stop, even where a library swallowed the exception.
interruption = threading.Event()

#: The file that marks a folder as an earlier result, which a new one may replace.
MANIFEST = "manifest.json"


@contextmanager
def new_folder(out: Path) -> Iterator[Path]:
    """A temporary folder beside `out` to build a result in; it becomes `out` when the block ends well.

    An earlier result (a folder with a manifest) is replaced whole, and stays untouched when the block raises or is
    interrupted.

    Raises
    ------
    InvalidInput
        Before the block is entered: `out` is a file, a folder that holds something else, a mount point or the
        current folder, or the place cannot be written.
    """
    target = _resolved(out)
    _check_folder(target, out)
    temporary = _beside(target)
    with _explained(out):
        temporary.mkdir()
    try:
        yield temporary
        _stop_if_asked()
        with _explained(out):
            _swap_in(temporary, target)
    finally:
        shutil.rmtree(temporary, ignore_errors=True)


@contextmanager
def new_file(out: Path) -> Iterator[Path]:
    """A temporary file beside `out` to write a result to; it becomes `out` when the block ends well.

    An existing file is replaced in one step, and stays untouched when the block raises or is interrupted.

    Raises
    ------
    InvalidInput
        Before the block is entered: `out` is a folder or another thing that is not a file, or the place cannot be
        written.
    """
    target = _resolved(out)
    if target.is_dir():
        raise InvalidInput(f"{out} is a folder; give the name of a file.")
    if target.exists() and not target.is_file():
        raise InvalidInput(f"{out} is not a regular file; give the name of a file.")
    if target.exists() and not os.access(target, os.W_OK):
        raise InvalidInput(f"{out} is write-protected; give another file.")
    temporary = _beside(target, target.suffix)
    with _explained(out):
        temporary.touch(exist_ok=False)
    try:
        yield temporary
        _stop_if_asked()
        with _explained(out):
            temporary.replace(target)
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def _stop_if_asked() -> None:
    if interruption.is_set():
        raise KeyboardInterrupt


def _resolved(out: Path) -> Path:
    """`out` with links followed, in a parent that exists and can be written."""
    try:
        target = out.resolve()
        if not target.parent.is_dir():
            raise InvalidInput(f"{out} cannot be made, because there is no folder {target.parent}; make it first.")
    except (OSError, ValueError, RuntimeError) as error:  # a link to itself, a name that is no name
        if isinstance(error, InvalidInput):
            raise
        raise InvalidInput(f"{str(out)!r} cannot be written: {_reason(error)}.") from error
    if not os.access(target.parent, os.W_OK | os.X_OK):
        raise InvalidInput(f"{out} cannot be made, because the folder {target.parent} is write-protected.")
    return target


def _check_folder(target: Path, out: Path) -> None:
    """Refuse every place that a whole folder cannot be moved to."""
    with _explained(out):
        if not target.exists():
            return
        if not target.is_dir():
            raise InvalidInput(f"{out} is a file, and a folder is to be made there; give another name.")
        if target == Path.cwd() or target in Path.cwd().parents:
            raise InvalidInput(f"{out} is the current folder or holds it, and cannot be replaced; name a new folder.")
        if target.is_mount():
            raise InvalidInput(f"{out} is a mount point and cannot be replaced; name a new folder inside it.")
        if any(target.iterdir()) and not (target / MANIFEST).is_file():
            raise InvalidInput(
                f"{out} holds something else than an earlier result (it has no {MANIFEST}); name a new or empty folder."
            )
        if not os.access(target, os.W_OK):
            raise InvalidInput(f"{out} is write-protected; name another folder.")


def _swap_in(temporary: Path, target: Path) -> None:
    """Move a complete folder to its place; what was there goes only when the new one stands."""
    _check_folder(target, target)  # the work took a while
    if not target.exists():
        temporary.rename(target)
        return
    earlier = _beside(target)
    try:
        target.rename(earlier)
        temporary.rename(target)
    finally:
        if target.exists():
            shutil.rmtree(earlier, ignore_errors=True)
        else:
            earlier.rename(target)


def _beside(target: Path, suffix: str = "") -> Path:
    """A hidden name in the same folder; the suffix is kept because writers choose their format by it."""
    return target.with_name(f".cable-ident-{secrets.token_hex(6)}{suffix}")


@contextmanager
def _explained(out: Path) -> Iterator[None]:
    """Turn what the file system says about a place into an input error that names it."""
    try:
        yield
    except OSError as error:
        raise InvalidInput(f"{out} cannot be written: {_reason(error)}.") from error


def _reason(error: Exception) -> str:
    return getattr(error, "strerror", None) or str(error)
