"""The four records of a run: to identify on, and to verify on without noise, as measured, and in a current."""

from dataclasses import dataclass

from ident.cases import Case, case_from_fixes, case_from_truth
from ident.configuration import Configuration
from ident.truth import Verification, fixes, identification_ship, reference_run, start_of, verification
from models.spectral import SpectralResult
from models.trace import Trace

IDENTIFICATION, TRUTH, MEASURED, CURRENT = (
    "identification",
    "verification-truth",
    "verification-measured",
    "verification-current",
)


@dataclass(frozen=True, kw_only=True, eq=False)
class Records:
    """The four records of a run, each prepared for scoring, with the traces they came from."""

    run: SpectralResult
    ship: Trace
    check: Verification
    fixes: Trace
    cases: dict[str, Case]


def prepare_records(configuration: Configuration, seed: int) -> Records:
    ship = identification_ship(configuration, seed)
    result = reference_run(configuration, ship)
    check = verification(configuration, seed)
    seen = fixes(configuration, check.truth, seed)
    settle, start = configuration.scoring.settle, start_of(configuration.tow)
    cases = {
        IDENTIFICATION: case_from_truth(IDENTIFICATION, ship, result.vehicle, settle, start=start),
        TRUTH: case_from_truth(TRUTH, check.ship, check.truth, settle, start=start),
        MEASURED: case_from_fixes(MEASURED, check.ship, seen, settle, window=configuration.sensor.window, start=start),
        CURRENT: case_from_truth(CURRENT, check.ship, check.in_current, settle, start=start),
    }
    return Records(run=result, ship=ship, check=check, fixes=seen, cases=cases)
