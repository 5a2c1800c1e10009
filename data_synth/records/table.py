"""A CSV file as text cells, each with its place, and every way in which it can fail to be one."""

import csv
import math
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

import numpy as np

from models.quantity import InvalidInput
from models.trace import Floats


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Header and rows of a file; `lines` are the 1-based line numbers of the rows."""

    path: Path
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    lines: tuple[int, ...]

    def cells(self, column: str) -> list[str]:
        """The text of a column, row by row."""
        place = self.header.index(column)
        return [row[place].strip() for row in self.rows]

    def numbers(self, column: str) -> Floats:
        """(rows,) the column as numbers, NaN where a cell is empty.

        Raises
        ------
        InvalidInput
            A cell is not a finite number; says file, line, column and cell.
        """
        values = np.full(len(self.rows), np.nan)
        for i, cell in enumerate(self.cells(column)):
            if cell:
                values[i] = self._number(cell, self.lines[i], column)
        return values

    def instants(self, column: str) -> Floats:
        """(rows,) [s] since the first row's date and time in a column.

        Raises
        ------
        InvalidInput
            A cell is no date and time, or some have a zone and others do not.
        """
        stamps = []
        for i, cell in enumerate(self.cells(column)):
            try:
                stamps.append(datetime.fromisoformat(cell))
            except ValueError:
                raise InvalidInput(
                    f"{self.at(i)}, column {column}: a date and time is needed, but it holds {cell!r}."
                ) from None
        try:
            return np.array([(stamp - stamps[0]).total_seconds() for stamp in stamps])
        except TypeError:
            raise InvalidInput(f"{self.path}, column {column}: some times have a zone and others do not.") from None

    def _number(self, cell: str, line: int, column: str) -> float:
        try:
            value = float(cell) if "_" not in cell else math.nan
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise InvalidInput(
                f"{self.path}, line {line}, column {column}: a finite number or an empty cell is needed, "
                f"but it holds {cell!r}."
            )
        return value

    def at(self, row: int) -> str:
        """File and line of a row, to begin a message with."""
        return f"{self.path}, line {self.lines[row]}"


def read_table(path: Path, *, row_names: bool = False) -> Table:
    """Read a file with a header line; blank lines are skipped, a byte order mark is dropped.

    With `row_names` the rows may begin with a name that the header leaves out, as R writes them: the column ``row``.

    Raises
    ------
    InvalidInput
        The file is missing, unreadable, not text, empty, without rows, or has rows of another width.
    """
    try:
        with path.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.reader(file, strict=True)
            lines = [(reader.line_num, tuple(row)) for row in reader if any(cell.strip() for cell in row)]
    except FileNotFoundError:
        raise InvalidInput(f"{path}: there is no such file.") from None
    except IsADirectoryError:
        raise InvalidInput(f"{path}: a file is needed, but this is a folder.") from None
    except UnicodeDecodeError:
        raise InvalidInput(f"{path}: a CSV text file in UTF-8 is needed, but this is not text.") from None
    except csv.Error as error:
        raise InvalidInput(f"{path}: not a CSV file: {error}.") from None
    except OSError as error:
        raise InvalidInput(f"{path}: cannot be read: {error.strerror}.") from None
    if not lines:
        raise InvalidInput(f"{path}: a header line and rows are needed, but the file is empty.")
    header = tuple(cell.strip() for cell in lines[0][1])
    if any("\0" in cell for _, row in lines for cell in row):
        raise InvalidInput(f"{path}: a CSV text file in UTF-8 is needed, but this is not text.")
    if len(lines) == 1:
        raise InvalidInput(f"{path}: rows are needed, but the file has only a header line.")
    if row_names and len(lines[1][1]) == len(header) + 1:
        header = ("row", *header)
    for line, row in lines[1:]:
        if len(row) != len(header):
            raise InvalidInput(f"{path}, line {line}: {len(header)} cells are needed, but it has {len(row)}.")
    return Table(
        path=path, header=header, rows=tuple(row for _, row in lines[1:]), lines=tuple(line for line, _ in lines[1:])
    )
