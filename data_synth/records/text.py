"""A file as text, packed by gzip or not, and a table of numbers with comment lines read from it."""

import gzip
import math
import zlib
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from models.quantity import InvalidInput
from models.trace import Floats

_GZIP = b"\x1f\x8b"


def read_text(path: Path) -> str:
    """The text of a file in UTF-8; a byte order mark is dropped.

    Raises
    ------
    InvalidInput
        The file is missing, unreadable, damaged, empty or not text.
    """
    try:
        data = path.read_bytes()
        text = (gzip.decompress(data) if data.startswith(_GZIP) else data).decode("utf-8-sig")
    except FileNotFoundError:
        raise InvalidInput(f"{path}: there is no such file.") from None
    except IsADirectoryError:
        raise InvalidInput(f"{path}: a file is needed, but this is a folder.") from None
    except (gzip.BadGzipFile, EOFError, zlib.error):
        raise InvalidInput(f"{path}: the packed file is damaged.") from None
    except UnicodeDecodeError:
        raise InvalidInput(f"{path}: a text file in UTF-8 is needed, but this is not text.") from None
    except (OSError, ValueError) as error:  # ValueError: a zero byte in the name
        raise InvalidInput(f"{path}: cannot be read: {getattr(error, 'strerror', None) or error}.") from None
    if not text.strip():
        raise InvalidInput(f"{path}: the file is empty.")
    return text


def numbered_lines(text: str) -> list[tuple[int, str]]:
    """The lines that are neither blank nor a comment (``#``), each with its number."""
    lines = ((i, line.strip()) for i, line in enumerate(text.splitlines(), start=1))
    return [(i, line) for i, line in lines if line and not line.startswith("#")]


def read_columns(path: Path, text: str, required: Sequence[str], optional: Sequence[str] = ()) -> dict[str, Floats]:
    """Columns of finite numbers under a header of names, parted by commas.

    Raises
    ------
    InvalidInput
        A column is missing, unknown or there twice, there are no rows, or a cell is no finite number; says the line.
    """
    lines = numbered_lines(text)
    names = [name.strip() for name in lines[0][1].split(",")] if lines else []
    wrong = [name for name in names if name not in (*required, *optional) or names.count(name) > 1]
    missing = [name for name in required if name not in names]
    if wrong or missing:
        more = f" and may have {', '.join(optional)}" if optional else ""
        raise InvalidInput(
            f"{path}: the columns {', '.join(required)} are needed{more}, but the header has {', '.join(names)}."
        )
    if len(lines) == 1:
        raise InvalidInput(f"{path}: rows are needed, but the file has only a header line.")
    rows = []
    for number, line in lines[1:]:
        cells = line.split(",")
        if len(cells) != len(names):
            raise InvalidInput(f"{path}, line {number}: {len(names)} cells are needed, but it has {len(cells)}.")
        rows.append([as_number(path, number, name, cell) for name, cell in zip(names, cells, strict=True)])
    table = np.array(rows)
    return {name: table[:, i] for i, name in enumerate(names)}


def as_number(path: Path, line: int, column: str, cell: str) -> float:
    """A cell as a finite number.

    Raises
    ------
    InvalidInput
        It is none; says file, line, column and cell.
    """
    try:
        value = float(cell) if "_" not in cell else math.nan
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InvalidInput(
            f"{path}, line {line}, column {column}: a finite number is needed, but it holds {cell.strip()!r}."
        )
    return value
