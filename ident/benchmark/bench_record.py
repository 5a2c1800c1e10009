"""What the benchmark collects on the way: rows, targets, and what it left out for lack of time."""

import math
import time
from dataclasses import dataclass, field, replace
from typing import Any

import pandas as pd

from ident.terminal import Progress
from ident.timing import Timing

#: Columns of bench.csv.
COLUMNS = (
    "configuration",
    "method",
    "setting",
    "error_kind",
    "error_rms_velocity_m_s",
    "seconds_per_hour",
    "compile_s",
    "repetitions",
    "spread",
)
#: Columns of frequency.csv, which has no simulated time: `seconds` are those of one call.
FREQUENCY_COLUMNS = (
    "configuration",
    "part",
    "setting",
    "frequencies",
    "segments",
    "tolerance",
    "solves",
    "error_share",
    "seconds",
    "repetitions",
    "spread",
)
HOUR = 3600.0


@dataclass(kw_only=True)
class Record:
    """What is collected on the way."""

    progress: Progress
    budget: float
    judged: bool = True  # whether enough is run to be held against the figures to reach
    begun: float = field(default_factory=time.perf_counter)
    rows: list[tuple[Any, ...]] = field(default_factory=list)
    frequency_rows: list[tuple[Any, ...]] = field(default_factory=list)
    cut: list[tuple[str, str]] = field(default_factory=list)
    targets: list[dict[str, Any]] = field(default_factory=list)
    compile_s: dict[str, float] = field(default_factory=dict)

    def tell(self, what: str) -> None:
        """Progress, by the share of the budget that is spent."""
        self.progress(what, 0.98 * self._spent / max(self._spent, self.budget))

    def compiled(self, method: str, seconds: float) -> None:
        """What a method took to compile [s]."""
        self.compile_s[method] = seconds

    def has_time(self, what: str, seconds: float) -> bool:
        """Whether so much is left of the budget; tells the progress, or lists what is left out."""
        left = max(0.0, self.budget - self._spent)
        if seconds > left:
            self.cut.append((what, f"takes about {seconds:.2g} s, and {left:.0f} s were left"))
            return False
        self.tell(what)
        return True

    @property
    def _spent(self) -> float:
        return time.perf_counter() - self.begun

    def row(self, configuration: str, method: str, setting: str, kind: str, error: float, timing: Timing) -> None:
        """A row of bench.csv; the timing is of a second of record."""
        self.rows.append(
            (configuration, method, setting, kind, error, HOUR * timing.seconds, timing.repetitions, timing.spread)
        )

    def table(self) -> pd.DataFrame:
        """bench.csv, with what each method took to compile; empty for what is not ours."""
        without = [name for name in COLUMNS if name != "compile_s"]
        made = pd.DataFrame(self.rows, columns=without)
        return made.assign(compile_s=made["method"].map(self.compile_s))[list(COLUMNS)]

    def untimed(self, configuration: str, method: str, setting: str, kind: str, error: float, timing: Timing) -> None:
        """A row of bench.csv of a method without simulated time, which leaves the seconds an hour empty."""
        self.row(configuration, method, setting, kind, error, replace(timing, seconds=math.nan))

    def call(
        self,
        configuration: str,
        part: str,
        timing: Timing,
        setting: str = "",
        frequencies: int | None = None,
        segments: int | None = None,
        tolerance: float = math.nan,
        solves: int | None = None,
        share: float = math.nan,
    ) -> None:
        """A row of frequency.csv; the timing is of one call, `share` an error over the largest amplitude."""
        run = (frequencies, segments, tolerance, solves, share)
        taken = (timing.seconds, timing.repetitions, timing.spread)
        self.frequency_rows.append((configuration, part, setting, *run, *taken))

    def target(self, what: str, asked: str, found: str, met: bool) -> None:
        """A row of the table of targets."""
        self.targets.append({"target": what, "asked": asked, "found": found, "met": met if self.judged else "-"})
