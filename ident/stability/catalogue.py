"""All cases of the catalogue, in its order, and the tables of what is expected of them.

Every module of cases has a tuple `CASES`.
"""

from collections.abc import Sequence
from difflib import get_close_matches
from importlib import import_module
from pathlib import Path

from ident.stability.case import Case, Expectation, expectations, pairs
from models.quantity import InvalidInput

_HERE = Path(__file__).parent
TABLES = (_HERE / "expected.csv", _HERE / "expected_reduced.csv")
_MODULES = (
    "chain_cases",
    "matrix_cases",
    "spectral_cases",
    "reduced_cases",
    "record_cases",
    "fit_cases",
    "controls",
)


def catalogue(only: Sequence[str] = (), *, reduced: bool = False) -> list[tuple[Case, Expectation]]:
    """The cases with their expectations; `only` those whose names begin with one of the words given.

    Raises
    ------
    InvalidInput
        Cases and tables do not match, or a word of `only` names nothing that is run.
    """
    every = [case for module in _MODULES for case in import_module(f"ident.stability.{module}").CASES]
    found = pairs(every, expectations(*TABLES))
    for word in only:
        if not word:
            raise InvalidInput("A name of a case is empty; give the beginnings of names joined by commas.")
        if not any(case.name.startswith(word) for case in every):
            near = get_close_matches(word, [case.name for case in every], cutoff=0.4)
            groups = dict.fromkeys(case.name.partition("-")[0] for case in every)
            likely = f", such as {', '.join(near)}" if near else ""
            raise InvalidInput(f'No case begins with "{word}"; names begin with {", ".join(groups)}{likely}.')
    named = [(case, row) for case, row in found if not only or case.name.startswith(tuple(only))]
    chosen = [(case, row) for case, row in named if case.reduced or not reduced]
    if not chosen:
        raise InvalidInput(
            f"The quick form has none of {', '.join(case.name for case, _ in named)}; leave --quick out."
        )
    return chosen
