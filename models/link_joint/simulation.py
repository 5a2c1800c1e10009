"""Simulating a towed system with the link-joint chain: resolution, error estimate and the run's own checks."""

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from models.link_joint import march as kernel
from models.link_joint.chain import FEWEST_LINKS, Layout, current_of, with_room
from models.link_joint.columns import work_for
from models.link_joint.gauss import accelerations
from models.link_joint.grading import Grading
from models.link_joint.plane import Plane, plane_of
from models.link_joint.steady import at_rest
from models.link_joint.track import Track
from models.link_joint.vectors import Floats
from models.payout import Payout, rounded
from models.quantity import InvalidInput, NumericalFailure
from models.towed_system import VEHICLE_PART, TowedSystem
from models.trace import Trace

Start = Literal["rest", "steady"]

#: Links of the first part that an unasked resolution starts from, and where its search ends.
FIRST_LINKS, LAST_LINKS = 24, 768
#: A run whose energy account does not close to this share is refused.
LARGEST_IMBALANCE = 0.05
#: A ship does not move faster [m/s] or gain speed faster [m/s2] than this: its track jumps.
FASTEST, SHARPEST = 30.0, 20.0
#: An error that falls by less than this over a doubling does not fall as that of a smooth motion.
_STALLS = 0.7
#: Cable that moves by this under its own weight turns over too little energy to be judged by its account [m].
_JUDGED = 0.02
#: Most steps of a run, and most links times steps: a minute or two.
STEP_BUDGET, LINK_BUDGET = 5_000_000, 100_000_000
#: Links times steps after which the march comes back to Python, where it can be interrupted; and least steps.
AT_A_TIME, LEAST_STEPS = 2_000_000, 100
MOST_EVENTS = 2000


@dataclass(frozen=True, slots=True, kw_only=True)
class SlackEvent:
    """A part's cable went slack at `t` and was taut again at `until` [s], infinite where it never was.

    `s` [m] is the cable between its upper end and the slack link next to it; `peak` [N] the largest tension anywhere
    in the part within ten seconds of being taut again. In a rigid chain the peak depends on the step, not on the cable.
    """

    part: str
    t: float
    until: float
    s: float
    peak: float


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class LinkJointResult:
    """The lower ends of all parts on the ship's times, and how far to trust them.

    Attributes
    ----------
    bodies
        One trace a part: position, velocity, and tension (n, 2) at the upper and lower end of its cable.
    error, position_error
        [m/s] and [m], RMS of the worst body, estimated with half the links and an eighth of the local accuracy;
        ``None`` where no companion was run.
    links
        Of every part, at the start.
    drift
        Largest closure error of a link over its length.
    imbalance
        What the account of energy does not explain, over the work that was turned over.
    snap_loss
        [J] that impacts of slack links have swallowed: where steps are longer than a stretch along a link, a snap is
        inelastic.
    tension_max
        (parts,) [N] anywhere in the part, over all steps.
    shape_times, shapes
        Times asked for and, one array each, positions (nodes, 3) of all nodes, the ship's last.
    """

    names: tuple[str, ...]
    bodies: tuple[Trace, ...]
    error: float | None
    position_error: float | None
    links: tuple[int, ...]
    steps: int
    rejected: int
    iterations: int
    drift: float
    imbalance: float
    snap_loss: float
    slack: tuple[SlackEvent, ...]
    tension_max: Floats
    shape_times: Floats
    shapes: tuple[Floats, ...]
    layout: Layout

    @property
    def vehicle(self) -> Trace:
        """The lower end of the part that ends at a planar tow's vehicle, else of the first part."""
        return self.bodies[self.names.index(VEHICLE_PART) if VEHICLE_PART in self.names else 0]


def simulate(
    system: TowedSystem,
    ship: Trace,
    *,
    links: int | None = None,
    tolerance: float = 1e-3,
    step: float | None = None,
    start: Start = "steady",
    payout: Payout | None = None,
    shapes_at: Floats | None = None,
    companion: bool = True,
    planar: bool = True,
) -> LinkJointResult:
    """Simulate the chain under the ship's motion.

    Parameters
    ----------
    links
        On the first part; the others get the same length of link, at least four. Left out, they are doubled until the
        error meets the tolerance.
    tolerance
        RMS velocity error [m/s]. With `links` given it steers the steps alone, and the error is what it is. A step with
        slack links may have a local error of 0.02 m/s, and no step is cut below a twentieth of the time that a stretch
        takes along a link.
    step
        A fixed step [s] instead of error control.
    start
        ``steady``: in the straight tow at the ship's first velocity; ``rest``: in the steady shape of `system.speed`.
    payout
        Cable through the sheave, any amount that leaves some.
    shapes_at
        Times [s], each the ship's sample next to it, of which the whole chain is kept.
    companion
        Whether to estimate the error by a second, coarser run.
    planar
        Whether a scene that lies in one vertical plane does without the axis across it. Nothing else changes.

    Raises
    ------
    InvalidInput
        The ship's track has gaps or jumps; more cable is hauled than there is; a setting is out of bounds.
    NumericalFailure
        No steady shape, no convergence, a spent budget, or an account of energy that does not close; says time, link
        and quantity. With `links` left out also when the tolerance is not met.
    """
    _check(system, ship, links, tolerance, step, payout)
    span = float(ship.t[-1] - ship.t[0])
    if companion and step is not None and step > 0.5 * span:
        raise InvalidInput(
            f"A step of {step:g} s leaves no coarser run of the {span:g} s to tell the error by; give at most half of "
            "them."
        )
    rest = (system.speed if start == "rest" else 0.0, 0.0, 0.0)
    plane = plane_of(current_of(system)[1], rest, ship) if planar else None
    grading = Grading(system, _usual_velocity(system, ship), plane)
    snapshots = np.zeros(0) if shapes_at is None else np.asarray(shapes_at, dtype=float)

    def run(count: int, local: float, dt: float | None) -> LinkJointResult:
        return _run(system, grading.build(count), ship, local, dt, start, payout, snapshots, plane)

    if links is not None:
        fine = run(links, tolerance, step)
        if not companion:
            return fine
        if links < 2 * FEWEST_LINKS:
            finer = run(2 * links, tolerance / 8.0, None if step is None else 0.5 * step)
            return _with_error(fine, finer, 4.0 / 3.0)
        return _with_error(fine, run(links // 2, 8.0 * tolerance, None if step is None else 2.0 * step))
    local, count = tolerance, FIRST_LINKS
    coarse, before = run(count // 2, 8.0 * local, None if step is None else 2.0 * step), math.inf
    while True:
        fine = _with_error(run(count, local, step), coarse)
        assert fine.error is not None
        if fine.error <= tolerance:
            return fine
        # Slack and snaps do not converge as a smooth motion does: no use to go on.
        stalls = count > 2 * FIRST_LINKS and fine.error > _STALLS * before
        if stalls or count >= LAST_LINKS:
            events = f", after {len(fine.slack)} slack events" if fine.slack else ""
            raise NumericalFailure(
                f"The chain does not reach {tolerance:g} m/s: with {count} links its error is still "
                f"{fine.error:.2g} m/s{events}; ask for a larger tolerance, or give the links and take the error as it "
                "is."
            )
        if 4 * (fine.steps + fine.rejected) * sum(fine.links) > LINK_BUDGET:
            raise NumericalFailure(
                f"The chain does not reach {tolerance:g} m/s: with {count} links and {fine.steps} steps its error is "
                f"still {fine.error:.2g} m/s, and twice the links would take more than {LINK_BUDGET:g} links times "
                "steps; ask for a larger tolerance, or give the links and take the error as it is."
            )
        coarse, before = fine, fine.error
        count, local, step = 2 * count, local / 8.0, None if step is None else 0.5 * step


def _with_error(fine: LinkJointResult, other: LinkJointResult, share: float = 1.0 / 3.0) -> LinkJointResult:
    """A run with its error: links and steps converge at second order, so that a third of the difference to a run with
    half of them is left, or four thirds of that to one with twice as many."""

    def worst(one: str) -> float:
        parts = zip(fine.bodies, other.bodies, strict=True)
        return max(float(np.sqrt(np.mean(np.sum((getattr(a, one) - getattr(b, one)) ** 2, axis=1)))) for a, b in parts)

    return replace(fine, error=share * worst("velocity"), position_error=share * worst("position"))


def _run(
    system: TowedSystem,
    layout: Layout,
    ship: Trace,
    tolerance: float,
    step: float | None,
    start: Start,
    payout: Payout | None,
    snapshots: Floats,
    plane: Plane | None,
) -> LinkJointResult:
    n, chain = layout.count, layout.chain if plane is None else plane.chain(layout.chain)
    nominal = float(chain.length[n - 1])

    def moving(vectors: Floats) -> Floats:
        """Along the axes that the chain moves in."""
        return np.ascontiguousarray(vectors if plane is None else plane.along(vectors))

    curve = kernel.Curve(np.ascontiguousarray(ship.spline.x), moving(ship.spline.c))
    first_velocity = ship.spline(ship.t[0], 1)
    velocity = (system.speed, 0.0, 0.0) if start == "rest" else (*first_velocity[:2].tolist(), 0.0)
    winding = kernel.Curve(np.zeros(0), np.zeros((4, 0, 1)))
    extra = 0
    if payout is not None:
        spline = rounded(payout, float(ship.t[0]), float(ship.t[-1]))
        winding = kernel.Curve(np.ascontiguousarray(spline.x), np.ascontiguousarray(spline.c))
        extra = max(0, math.ceil(float(payout.length.max() - payout.length[0]) / nominal)) + 2
    try:
        x, T, _ = at_rest(layout, velocity, plane)
    except NumericalFailure as failure:
        raise NumericalFailure(f"At the start: {failure}") from failure
    x += moving(ship.position[0])
    v = np.tile(moving(np.array(velocity)), (n + 1, 1))
    v[n] = moving(first_velocity)
    a, T = accelerations(chain, x, v, T, moving(np.asarray(ship.spline(ship.t[0], 2))))
    chain = with_room(chain, extra, nominal)
    nodes, d = n + 1 + extra, x.shape[1]

    def room(values: Floats) -> Floats:
        held = np.zeros((3, nodes, *values.shape[1:]))
        held[0, : len(values)] = values
        return held

    state = kernel.State(x=room(x), v=room(v), a=room(a), T=room(T))
    parts = len(layout.links)
    tops = np.array([end + count - 1 for end, count in zip(layout.lower_end, layout.links, strict=True)])
    rows = np.full(len(ship), -1)
    kept = np.unique(np.clip(np.searchsorted(ship.t, snapshots), 0, len(ship) - 1))
    rows[kept] = np.arange(kept.size)
    track = Track(
        t=np.array(ship.t),
        ends=np.array(layout.lower_end),
        tops=tops,
        x=np.zeros((len(ship), parts, d)),
        v=np.zeros((len(ship), parts, d)),
        T=np.zeros((len(ship), parts, 2)),
        row_of_shape=rows,
        shapes=np.zeros((kept.size, nodes, d)),
        nodes=np.zeros(kept.size, np.int64),
        T_max=np.zeros(parts),
        events=np.zeros((MOST_EVENTS, 5)),
        used=np.zeros(1, np.int64),
        latest=np.full(parts, -1),
        slack=np.zeros(parts, np.int64),
        pull=np.zeros((3, parts, 2)),
    )
    span = float(ship.t[-1] - ship.t[0])
    settings = kernel.Settings(
        tolerance=tolerance,
        step=0.0 if step is None else step,
        first=min(0.05, span),
        budget=_budget(n),
        at_a_time=max(LEAST_STEPS, AT_A_TIME // n),
        nominal=nominal,
    )
    out, work = kernel.begin(n, settings, float(ship.t[0])), work_for(nodes, d)
    while out.code == kernel.PAUSED:
        out = kernel.march(chain, curve, winding, state, settings, track, work, out)
    # Impacts of slack links may swallow energy, never make it.
    hung = float(np.sum(np.abs(chain.weight * chain.length)) + np.sum(np.abs(chain.body_weight)))
    scale = max(out.turnover, _JUDGED * hung, 1e-9)
    imbalance = (abs(out.unexplained) + max(0.0, out.snapped)) / scale
    _judge(out, imbalance, layout, system)
    places, rates, shapes = track.x, track.v, track.shapes
    if plane is not None:
        places, shapes = plane.places_in_space(places), plane.places_in_space(shapes)
        rates = plane.in_space(rates)
    bodies = tuple(
        Trace(t=ship.t, position=places[:, k], velocity=rates[:, k], tension=track.T[:, k]) for k in range(parts)
    )
    names = tuple(part.name for part in system.parts)
    return LinkJointResult(
        names=names,
        bodies=bodies,
        error=None,
        position_error=None,
        links=layout.links,
        steps=out.steps,
        rejected=out.rejected,
        iterations=out.iterations,
        drift=out.drift,
        imbalance=imbalance,
        snap_loss=max(0.0, -out.snapped),
        slack=tuple(
            SlackEvent(part=names[int(k)], t=b, until=u, s=s, peak=p)
            for k, b, u, s, p in track.events[: track.used[0]].tolist()
        ),
        tension_max=track.T_max,
        shape_times=ship.t[kept],
        shapes=tuple(shape[: count + 1].copy() for shape, count in zip(shapes, track.nodes, strict=True)),
        layout=layout,
    )


def _usual_velocity(system: TowedSystem, ship: Trace) -> tuple[float, float, float]:
    """The ship's root mean square speed through the water at the surface, in the direction it starts in [m/s].

    A ship that starts at rest has the direction of its greatest speed.
    """
    water = np.zeros(2) if system.current is None else system.current.velocity_at(0.0)
    rates = ship.spline(ship.t, 1)[:, :2] - water
    speeds = np.hypot(rates[:, 0], rates[:, 1])
    first = 0 if speeds[0] > 1e-6 else int(speeds.argmax())
    way = rates[first] / speeds[first] if speeds[first] > 0.0 else np.array([1.0, 0.0])
    x, y = water + float(np.sqrt(np.mean(speeds**2))) * way
    return float(x), float(y), 0.0


def _budget(links: int) -> int:
    """Most steps of a chain of so many links."""
    return max(LEAST_STEPS, min(STEP_BUDGET, LINK_BUDGET // links))


def _judge(out: kernel.Outcome, imbalance: float, layout: Layout, system: TowedSystem) -> None:
    """Raise for a march that failed, or whose energy account does not close."""
    if out.code == kernel.DONE:
        if imbalance > LARGEST_IMBALANCE:
            raise NumericalFailure(
                f"The chain's account of energy does not close: {imbalance:.1%} of the work is unexplained at t = "
                f"{out.t:.6g} s, more than {LARGEST_IMBALANCE:.0%}; use a smaller step or tolerance."
            )
        return
    link = layout.chain.part.size - 1 - out.link if out.link < layout.chain.part.size else 0
    part = system.parts[int(layout.chain.part[min(out.link, layout.chain.part.size - 1)])].name
    where = f"at t = {out.t:.6g} s, link {link + 1} from the ship (part {part})"
    reasons = {
        kernel.STUCK: f"a step is not solved {where}: closure error or change {out.quantity:.3g}; use a smaller step",
        kernel.NOT_FINITE: f"velocities leave the finite range {where}: {out.quantity:.3g} m/s; use a smaller step",
        kernel.BUDGET_SPENT: f"{_budget(layout.chain.part.size)} steps are spent at t = {out.t:.6g} s, the last of "
        f"{out.quantity:.3g} s",
        kernel.EVENTS_FULL: f"more than {MOST_EVENTS} slack events by t = {out.t:.6g} s",
    }
    raise NumericalFailure(f"The link-joint chain failed: {reasons[out.code]}.")


def _check(
    system: TowedSystem, ship: Trace, links: int | None, tolerance: float, step: float | None, payout: Payout | None
) -> None:
    if not (tolerance > 0.0 and math.isfinite(tolerance)):
        raise InvalidInput(f"The tolerance must be above 0 m/s, but it is {tolerance:g} m/s.")
    if step is not None and not (step > 0.0 and math.isfinite(step)):
        raise InvalidInput(f"The step must be above 0 s, but it is {step:g} s.")
    if not ship.valid.all():
        raise InvalidInput(
            f"The ship needs a position at every time, but t = {ship.t[int(np.argmin(ship.valid))]:g} s has none."
        )
    gaps = np.diff(ship.t)
    speeds = np.linalg.norm(np.diff(ship.position, axis=0), axis=1) / gaps
    if speeds.max() > FASTEST:
        i = int(np.argmax(speeds > FASTEST))
        raise InvalidInput(
            f"The ship's track jumps: between t = {ship.t[i]:g} s and {ship.t[i + 1]:g} s it moves "
            f"{speeds[i] * gaps[i]:.4g} m, at {speeds[i]:.3g} m/s; at most {FASTEST:g} m/s can be. Repair the track."
        )
    sharp = np.linalg.norm(ship.spline(ship.t, 2), axis=1)
    if sharp.max() > SHARPEST:
        i = int(np.argmax(sharp > SHARPEST))
        raise InvalidInput(
            f"The ship's track jumps: at t = {ship.t[i]:g} s it accelerates by {sharp[i]:.3g} m/s2; at most "
            f"{SHARPEST:g} m/s2 can be. Repair or smooth the track."
        )
    if payout is not None:
        left = system.parts[0].cable.length + float(payout.length.min() - payout.length[0])
        least = 2.0 * system.parts[0].cable.length / (links or FIRST_LINKS)
        if left < least:
            raise InvalidInput(
                f"The payout hauls the cable in to {left:g} m, but two links of {0.5 * least:g} m must be left; haul "
                "less, or give more links."
            )
