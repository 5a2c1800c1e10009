"""Compare a page of the committed gallery with one made anew: the tables must agree, run times aside."""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

_TIMED = ["simulation_s_per_hour", "identification_s"]
#: Other machines round otherwise, and a search may then end elsewhere on its floor.
_RELATIVE, _ABSOLUTE = 0.02, 1e-4


def main() -> int:
    name, made = sys.argv[1], Path(sys.argv[2])
    committed = Path("reports/gallery") / name
    from ident.cli import main as command

    code = command(["run", name, "--out", str(made), "--quiet"])
    if code:
        return code
    wrong = _differences(committed, made, "scores.csv", ["model", "record"], [*_TIMED, "simulations"])
    wrong += _differences(committed, made, "parameters.csv", ["model", "parameter"], ["low", "high"], "determined")
    wrong += _headings(committed, made)
    for line in wrong:
        sys.stderr.write(f"{line}\n")
    return 1 if wrong else 0


def _differences(
    committed: Path, made: Path, file: str, keys: list[str], ignored: list[str], only: str | None = None
) -> list[str]:
    """The cells that differ; with `only`, of the rows that say yes there: the others lie on a floor."""
    before, after = (pd.read_csv(folder / file).drop(columns=ignored).set_index(keys) for folder in (committed, made))
    if only is not None:
        before, after = (table[table[only] == "yes"] for table in (before, after))
    if list(before.index) != list(after.index) or list(before.columns) != list(after.columns):
        return [f"{file}: rows or columns differ from the gallery's"]
    wrong = []
    for column in before.columns:
        old, new = before[column], after[column]
        if pd.api.types.is_numeric_dtype(old):
            same = np.isclose(old, new, rtol=_RELATIVE, atol=_ABSOLUTE, equal_nan=True)
        else:
            same = (old.fillna("") == new.fillna("")).to_numpy()
        wrong += [
            f"{file}: {key} {column}: gallery {old[key]}, now {new[key]}"
            for key, fine in zip(before.index, same, strict=True)
            if not fine
        ]
    return wrong


def _headings(committed: Path, made: Path) -> list[str]:
    before, after = (
        [
            line
            for line in (folder / "report.md").read_text(encoding="utf-8").splitlines()
            if line.startswith(("#", "!["))
        ]
        for folder in (committed, made)
    )
    return [] if before == after else ["report.md: headings or figures differ from the gallery's"]


def _text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


if __name__ == "__main__":
    sys.exit(main())
