"""Exit codes: 0 done, 2 bad input or an unwritable place, 1 a numerical failure, 130 interrupted.

Whatever ends a command ends it with one line on the error stream; an error of the program itself too, unless
CABLE_IDENT_DEBUG is set.
"""

import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import NoReturn

import typer

from ident.places import interruption
from ident.terminal import write_error
from models.quantity import InvalidInput, NumericalFailure

#: The base of all errors of parsing, wherever typer keeps its copy of click.
USAGE_ERROR: type[Exception] = typer.BadParameter.__mro__[2]


def exit_code(work: Callable[[], None]) -> int:
    """Do the work, flush the output, and tell how it ended."""
    try:
        with _interruptible():
            work()
            _flush()
    except BaseException as error:
        return _code(error)
    return 0


def _code(error: BaseException) -> int:
    """Exit code of an error, its line written."""
    if isinstance(error, typer.Exit):
        _drop_output()
        return error.exit_code
    if isinstance(error, BrokenPipeError):  # the reader has seen enough
        _drop_output()
        return 0
    if isinstance(error, KeyboardInterrupt):
        return _failed("interrupted.", 130)
    if isinstance(error, USAGE_ERROR):
        return _failed(getattr(error, "format_message", error.__str__)(), 2)
    if isinstance(error, InvalidInput):
        return _failed(str(error), 2)
    if isinstance(error, OSError):
        _drop_output()
        place = f"{error.filename}: " if error.filename else ""
        return _failed(f"{place}{error.strerror or error}.", 2)
    if isinstance(error, NumericalFailure):
        return _failed(str(error), 1)
    if not isinstance(error, Exception) or os.environ.get("CABLE_IDENT_DEBUG"):
        raise error
    return _failed(f"internal: {type(error).__name__}: {error}; set CABLE_IDENT_DEBUG=1 for the traceback.", 1)


def _failed(message: str, code: int) -> int:
    write_error(message)
    return code


def _flush() -> None:
    if sys.stdout is not None:
        sys.stdout.flush()


def _drop_output() -> None:
    """Where the output cannot be written, let what is left of it go nowhere, so that the interpreter ends quietly."""
    try:
        _flush()
    except OSError:
        with suppress(OSError, ValueError):
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


@contextmanager
def _interruptible() -> Iterator[None]:
    """Treat a request to end, or a closed terminal, as Ctrl-C, so that nothing half-made is left behind."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    names = [name for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)]
    numbers = [getattr(signal, name) for name in names]
    usual = (signal.SIG_DFL, signal.default_int_handler)
    before = {number: signal.getsignal(number) for number in numbers if signal.getsignal(number) in usual}
    try:
        for number in before:
            signal.signal(number, _interrupt)
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        interruption.clear()


def _interrupt(number: int, frame: object) -> NoReturn:
    # A callback of a library may swallow the exception: whoever goes on asks `interruption` before the result is kept.
    interruption.set()
    raise KeyboardInterrupt
