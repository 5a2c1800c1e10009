"""Scores of fitted models on other records."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from ident.baselines import RIGID, rigid
from ident.configuration import Configuration
from ident.fit_files import read_fits
from ident.places import new_file
from ident.recorded import distinct, recorded_case
from ident.scores import baseline_row, saved_row, scores_table
from models.drive import Start
from models.statics import static_shape
from reports.files import write_scores


@dataclass(frozen=True, kw_only=True)
class VerifyResult:
    """The scores for the terminal, and what there is to say of the records."""

    scores: pd.DataFrame
    notes: tuple[str, ...]

    @property
    def table(self) -> list[dict[str, str]]:
        """A row a model and record."""
        return [
            {
                "model": str(row["model"]),
                "record": str(row["record"]),
                "rms m/s": f"{row['rms_velocity_m_s']:.4f}",
                "rms m": f"{row['rms_position_m']:.2f}",
                "without offset m": f"{row['rms_position_offset_removed_m']:.2f}",
                "fit %": f"{row['fit_percent']:.1f}",
                "outcome": str(row["outcome"]),
            }
            for row in self.scores.to_dict("records")
        ]


def verify(fit: Path, *, records: Sequence[Path], out: Path, start: Start | None, window: float | None) -> VerifyResult:
    """Score every model of a FIT.json on every record and write SCORES.csv; the ship as baseline beside them.

    Parameters
    ----------
    start, window
        As `fit` takes them; as fitted where left out.

    Raises
    ------
    InvalidInput
        A file cannot be read, scored or written.
    """
    distinct(records)
    with new_file(out) as temporary:
        content = read_fits(fit)
        configuration = Configuration.from_text(content.configuration_text, content.configuration_name, str(fit))
        shape = static_shape(configuration.tow)
        models = [(saved, saved.rebuild(configuration.tow, shape)) for saved in content.fits]
        rows = []
        notes: list[str] = []
        for path in records:
            recorded = recorded_case(
                path,
                settle=configuration.scoring.settle,
                window=content.window if window is None else window,
                start=content.start if start is None else start,
            )
            case = recorded.case
            notes += recorded.notes
            rows.append(baseline_row(RIGID, case, rigid(case.drive)))
            rows += [saved_row(saved, model, case) for saved, model in models]
        scores = scores_table(rows)
        write_scores(temporary, scores)
    return VerifyResult(scores=scores, notes=tuple(notes))
