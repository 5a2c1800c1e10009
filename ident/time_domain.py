"""What a page shows of a study's case in the time domain: the tow in its sea, or every strategy of a compensator."""

import math
from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from data_synth.rao import Rao
from data_synth.spectra import Spectrum
from ident import compensated_checks
from ident.chain_record import ChainSetting
from ident.compensated_checks import CompensatedCheck, check_compensated
from ident.compensator_seas import LOCKED, Seaway
from ident.harmonic_checks import check_harmonics
from ident.sea_checks import DURATION, RUN_IN, SeaCheck, check_sea
from ident.terminal import Progress
from models.compensator import Setting
from models.tow import Tow
from models.transfer_matrix import Direction, DragForm
from reports.files import write_table
from reports.time_domain import TimeDomain

#: Strategies that are simulated, each in about ten seconds.
STRATEGIES = ("locked", "tuned-stiffness", "tuned-damping")
#: Single frequencies over that of the sea's peak.
_RATIOS = (0.75, 1.0, 1.5)


def of_sea(
    tow: Tow,
    spectrum: Spectrum,
    *,
    rao: Rao | None,
    direction: Direction,
    drag: DragForm,
    seed: int,
    duration: float = DURATION,
    run_in: float = RUN_IN,
) -> TimeDomain:
    """The tow through the chain, as `check_sea`, and by single frequencies as large as that sea."""
    check = check_sea(
        tow, spectrum, rao=rao, direction=direction, drag=drag, seed=seed, duration=duration, run_in=run_in
    )
    return TimeDomain(
        duration=duration,
        run_in=run_in,
        seed=seed,
        table=check.table,
        costs=check.costs,
        slack=check.chain.slack,
        harmonics=check_harmonics(
            tow,
            [ratio * spectrum.peak for ratio in _RATIOS],
            amplitude=math.sqrt(2.0) * check.chain.imposed,
            direction=direction,
            drag=drag,
        ),
    )


def of_compensator(
    sea: Seaway,
    settings: Mapping[str, Setting],
    *,
    seed: int,
    progress: Progress,
    share: tuple[float, float],
    duration: float = DURATION,
    run_in: float = compensated_checks.RUN_IN,
    setting: ChainSetting | None = None,
) -> TimeDomain:
    """Those of `STRATEGIES` that there are, each through the chain in the same drawn sea.

    `share` is where this begins and ends in the progress; `setting` is the chain's, or as each strategy asks for.
    """
    checks: dict[str, SeaCheck | CompensatedCheck] = {}
    rows = []
    names = [name for name in STRATEGIES if name in settings]
    for i, name in enumerate(names):
        progress(f"time domain, {name}", share[0] + (share[1] - share[0]) * i / len(names))
        if settings[name] == LOCKED:
            checks[name] = check_sea(
                sea.configuration.tow,
                sea.spectrum,
                rao=sea.rao,
                direction="axial",
                seed=seed,
                duration=duration,
                run_in=run_in,
                setting=setting,
            )
            continue
        found = check_compensated(
            sea, settings[name], seed=seed, duration=duration, run_in=run_in, chain_setting=setting
        )
        last = found.history.iloc[-1]
        rows.append(
            {
                "strategy": name,
                "runs": len(found.history),
                "correction_percent": float(last["correction_percent"]),
                "residual_percent": float(last["residual_percent"]),
                "left_percent": found.left_percent,
                "settled": found.settled,
            }
        )
        checks[name] = found

    def stacked(tables: Mapping[str, pd.DataFrame]) -> pd.DataFrame:
        parts = [table.assign(strategy=name) for name, table in tables.items()]
        made = pd.concat(parts, ignore_index=True)
        return made[["strategy", *(column for column in made.columns if column != "strategy")]]

    return TimeDomain(
        duration=duration,
        run_in=run_in,
        seed=seed,
        table=stacked({name: check.table for name, check in checks.items()}),
        costs=stacked({name: check.costs for name, check in checks.items()}),
        slack=sum(check.chain.slack for check in checks.values()),
        runs=pd.DataFrame(rows),
    )


def write_files(folder: Path, shown: TimeDomain) -> None:
    """Write the tables: ``time-domain.csv``, its ``-costs``, and ``-harmonics`` or, with a compensator, ``-runs``."""
    tables = {"": shown.table, "-costs": shown.costs, "-harmonics": shown.harmonics, "-runs": shown.runs}
    for ending, table in tables.items():
        if len(table):
            write_table(folder / f"time-domain{ending}.csv", table)
