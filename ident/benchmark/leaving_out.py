"""What scenes leave out, as a part of the benchmark: the cases, their table and its target."""

from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass

import pandas as pd

from ident.benchmark.bench_record import Record
from ident.configuration import load
from ident.leaving_out.case import Case, measure, table
from ident.leaving_out.idle_operations import spent
from ident.leaving_out.responses import by_matrix, by_reduced
from ident.leaving_out.scenes import STEP, Scene, by_chain, by_spectral, step_scene, under_way
from reports.leaving_out import LeavingOutMaterial

#: Largest relative difference of the scene without a term from the full model with the term at zero.
EQUAL = 1e-12
_SPENT = ["simulator", "term", "spared", "idle"]
#: What the whole table is expected to take [s].
_TAKES = 20.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Effort:
    """How much is run: configurations by simulator, and the length of a record over its usual one."""

    spectral: tuple[str, ...] = ("autec-1200", "mangus-2500", "swath-4000")
    chain: tuple[str, ...] = ("autec-1200",)
    moving: tuple[str, ...] = ("multipart-2200",)
    matrix: tuple[str, ...] = ("autec-1200", "swath-4000")
    reduced: tuple[str, ...] = ("autec-1200",)
    repetitions: int = 5
    scale: float = 1.0


FULL = Effort()
#: Enough to see that everything still runs.
REDUCED = Effort(spectral=("swath-4000",), moving=(), matrix=("swath-4000",), repetitions=1, scale=0.1)


def cases(effort: Effort) -> list[Case]:
    """All terms of all scenes."""
    kinds: list[tuple[Callable[[Scene], list[Case]], tuple[str, ...], Callable[[str, float], Scene]]] = [
        (by_spectral, effort.spectral, step_scene),
        (by_chain, effort.chain, step_scene),
        (by_chain, effort.moving, under_way),
        (by_matrix, effort.matrix, step_scene),
        (by_reduced, effort.reduced, step_scene),
    ]
    return [each for make, names, scene in kinds for name in names for each in make(scene(name, effort.scale))]


def record(run: Record, effort: Effort = FULL) -> LeavingOutMaterial:
    """The part of the page on leaving out, with its target; empty where there is no time for it."""
    share = effort.repetitions / FULL.repetitions * len(effort.spectral) / len(FULL.spectral)
    if not run.has_time("what scenes leave out", _TAKES * share):
        return LeavingOutMaterial()
    found = table([measure(case, effort.repetitions) for case in cases(effort)])
    worst = found.loc[int(found["apart"].argmax())]
    run.target(
        "scenes without a term against the full model with it at zero",
        f"{EQUAL:g} of the largest value",
        f"{worst['apart']:.1e} ({worst['scene']}, {worst['simulator']}, {worst['term']})",
        bool(worst["apart"] <= EQUAL),
    )
    operations = pd.DataFrame([astuple(each) for each in spent(load(effort.chain[0]).tow)], columns=_SPENT)
    return LeavingOutMaterial(words=_words(found), table=found, operations=operations)


def _words(found: pd.DataFrame) -> Sequence[str]:
    """How it was measured, and what stands out."""
    extra = found["seconds_zero"] / found["seconds_off"]
    most = found.loc[int(extra.argmax())]
    idle = found.loc[int(found["idle"].argmax())]
    how = (
        "Each row is a scene without a term, with the term built but too small to change a digit, and with the term "
        "as strong as the row says. The first two must agree: their difference is the largest of any motion or tension "
        "at any time, over the largest value of that quantity. Simulators in time are compared at fixed steps of "
        f"{STEP:g} s where they steer their own, since with error control a change in the last digit moves the steps. "
        "Times are CPU times of a whole call, with mesh and steady shape. Simulations are 600 s of a ship that starts "
        "to 0.5 m/s, or gains as much; responses are to 1 m along the cable's top. The chain's third axis is left out "
        "wherever ship and current share a vertical plane; at zero it is carried along."
    )
    what = (
        f"Most is saved by leaving out {most['term']} ({most['scene']}, {most['simulator']}): with it at zero a call "
        f"takes {extra.max():.2f} times as long. Some arrays hold columns of zeros for a "
        f"term that is off: at most {idle['idle'] / 1e3:.1f} kB of {idle['built'] / 1e3:.1f} kB ({idle['scene']}, "
        f"{idle['simulator']}, {idle['term']})."
    )
    return how, what
