"""The march of the chain in time: TR-BDF2 with error control, payout, slack events and the energy account.

A step h has two stages of the same size g = gamma h/2, the trapezoidal rule to t + gamma h and the second-order
backward formula to t + h, gamma = 2 - sqrt(2): second order and L-stable.
The error estimate is that of the embedded third-order formula, passed through the stage's own matrix so that axial
waves which the step rightly steps over do not count.
"""

import math
from typing import Any, NamedTuple

import numpy as np

from models.kernels import inner_kernel, kernel
from models.link_joint.chain import Chain
from models.link_joint.columns import Work, columns_of
from models.link_joint.elimination import reduce, substitute
from models.link_joint.energy import energy_of, power_of
from models.link_joint.gauss import make_consistent
from models.link_joint.stage import solve_stage
from models.link_joint.track import Track, first_row, hermite, note_slack, pull_on_ends, write_rows
from models.link_joint.vectors import (
    Axes,
    Floats,
    applied,
    combined,
    dot,
    matrix,
    minus,
    nought,
    plus,
    put,
    times,
    vector,
)
from models.link_joint.winding import change_of_links, merge, split

GAMMA = 2.0 - math.sqrt(2.0)
_D = 0.5 * GAMMA
_W = 0.25 * math.sqrt(2.0)
#: Weights of the embedded error: TR-BDF2 less the third-order formula through its stages.
_E0, _E1, _E2 = _W - (1.0 - _W) / 3.0, _W - (3.0 * _W + 1.0) / 3.0, _D - _D / 3.0
#: Third-order weights, for the account of energy.
_B0, _B1, _B2 = (1.0 - _W) / 3.0, (3.0 * _W + 1.0) / 3.0, _D / 3.0

#: Longest step of the error control, and the shortest before a step that is not solved is given up [s].
LONGEST, SHORTEST = 40.0, 1e-7
#: Local error that a step with slack links may have [m/s], and the shortest step that error alone asks for, over the
#: time a stretch takes along a link: links that fall slack and snap taut would else ask for ever shorter steps.
SLACK_ERROR, PATIENCE = 0.02, 0.05

#: Largest payout or haul in a step, over the top links' length.
_REELED = 0.2

DONE, STUCK, NOT_FINITE, BUDGET_SPENT, EVENTS_FULL, PAUSED = range(6)


class Curve(NamedTuple):
    """A piecewise cubic: times (k + 1,), coefficients (4, k, d) of falling powers, as scipy's."""

    t: Floats
    c: Floats


class State(NamedTuple):
    """x, v, a (3, m + 1, d) and T (3, m) at the begin, the middle point and the end of a step, changed in place."""

    x: Floats
    v: Floats
    a: Floats
    T: Floats


class Settings(NamedTuple):
    """`step` above zero fixes the step; otherwise `tolerance` [m/s] and `first` [s] steer it."""

    tolerance: float
    step: float
    first: float
    budget: int
    at_a_time: int  # steps of one call
    nominal: float  # unstretched length of the top links [m]


class Outcome(NamedTuple):
    """Where a march is or how it ended: code, time, link, quantity; counts, drift, energies; where it goes on from."""

    code: int
    t: float
    link: int
    quantity: float
    steps: int
    rejected: int
    iterations: int
    drift: float
    unexplained: float  # change of energy less work while all links are taut [J]
    snapped: float  # the same while links are slack or fall taut, below zero where impacts swallow energy [J]
    turnover: float  # absolute work, the scale of the two [J]
    nodes: int  # moving nodes
    h: float  # next step [s]
    row: int  # next output time
    base: float  # top link's length less what is paid out [m]


#: The outcome's whole numbers.
_COUNTS = ("code", "link", "steps", "rejected", "iterations", "nodes", "row")


@inner_kernel
def curve_at(curve: Curve, t: float, at: int, value: Floats, rate: Floats, second: Floats) -> int:
    """Value, rate and second derivative (d,) at t, searched from interval `at` on; returns the interval."""
    last = curve.t.size - 2
    while at < last and t >= curve.t[at + 1]:
        at += 1
    while at > 0 and t < curve.t[at]:
        at -= 1
    s = t - curve.t[at]
    for j in range(value.size):
        c0, c1, c2, c3 = curve.c[0, at, j], curve.c[1, at, j], curve.c[2, at, j], curve.c[3, at, j]
        value[j] = ((c0 * s + c1) * s + c2) * s + c3
        rate[j] = (3.0 * c0 * s + 2.0 * c1) * s + c2
        second[j] = 6.0 * c0 * s + 2.0 * c1
    return at


@inner_kernel
def _ship_strays(ship: Curve, at: int, t: float, h: float, n: int, x: Floats, v: Floats) -> float:
    """How far the ship's motion inside a step is from the cubic through its ends, over the step [m/s]."""
    d = x.shape[2]
    p, rate, second = np.empty(d), np.empty(d), np.empty(d)
    worst = 0.0
    for k in range(1, 6):
        s = k / 6.0
        at = curve_at(ship, t + s * h, at, p, rate, second)
        off = 0.0
        for j in range(d):
            off += (p[j] - hermite(s, h, x[0, n, j], v[0, n, j], x[2, n, j], v[2, n, j])) ** 2
        worst = max(worst, math.sqrt(off))
    return worst / h


@inner_kernel
def _local_error(c: Chain, n: int, h: float, s: State, w: Work, dV: Floats, dT: Floats) -> tuple[float, int]:
    """Error of a step [m/s] and the node it is largest at: the velocities' filtered, the positions' over the step."""
    v, W, axes, parent = s.v, w.W, w.axes, c.parent
    a0, a1, a2 = s.a[0], s.a[1], s.a[2]
    col = columns_of(axes)
    for i in range(n):
        W[i, col.RHO] = 0.0
        e = plus(combined(_E0, vector(axes, a0, i, 0), _E1, vector(axes, a1, i, 0)), times(_E2, vector(axes, a2, i, 0)))
        put(W, i, col.F, times(1.0 / _D, applied(matrix(axes, W, i, col.M), e)))
        put(W, i, col.R, nought(axes))
    for i in range(n):
        reduce(i, parent[i], parent[i] == n, 0.0, W, axes)
    substitute(c, n, w, dV, dT)
    worst, node = 0.0, 0
    for i in range(n):
        moved, placed = 0.0, 0.0
        for j in range(len(axes)):
            moved += dV[i, j] ** 2
            placed += (_E0 * v[0, i, j] + _E1 * v[1, i, j] + _E2 * v[2, i, j]) ** 2
        here = math.sqrt(max(moved, placed))
        if not here <= worst:
            worst, node = here, i
    return worst, node


@inner_kernel
def _set_stage(stage: int, n: int, h: float, s: State, jerk: Floats, xh: Floats, vh: Floats, axes: Axes) -> None:
    """What a stage starts from, and its guess of velocities and tensions."""
    x, v, a, T = s.x, s.v, s.a, s.T
    g = _D * h
    for i in range(n):
        if stage == 1:
            T[1, i] = T[0, i]
        else:
            T[2, i] = T[0, i] + (T[1, i] - T[0, i]) / GAMMA
        for j in range(len(axes)):
            if stage == 1:
                # The trapezoidal rule to t + gamma h.
                xh[i, j] = x[0, i, j] + g * v[0, i, j]
                vh[i, j] = v[0, i, j] + g * a[0, i, j]
                v[1, i, j] = v[0, i, j] + GAMMA * h * (a[0, i, j] + 0.5 * GAMMA * h * jerk[i, j])
            else:
                # The backward formula to t + h, guessed with the acceleration carried on.
                xh[i, j] = x[0, i, j] + _W * h * (v[0, i, j] + v[1, i, j])
                vh[i, j] = v[0, i, j] + _W * h * (a[0, i, j] + a[1, i, j])
                bend = 0.5 * (1.0 / GAMMA - 1.0) * (a[1, i, j] - a[0, i, j])
                v[2, i, j] = v[1, i, j] + (1.0 - GAMMA) * h * (a[1, i, j] + bend)


def begin(nodes: int, settings: Settings, t: float) -> Outcome:
    """A march that has not begun."""
    h = settings.step if settings.step > 0.0 else settings.first
    return Outcome(PAUSED, t, 0, 0.0, 0, 0, 0, 0.0, 0.0, 0.0, 0.0, nodes, h, 0, 0.0)


def march(
    c: Chain, ship: Curve, payout: Curve, s: State, settings: Settings, track: Track, w: Work, so_far: Outcome
) -> Outcome:
    """`_march`, whose outcome comes back in an array: a signal that arrives while a tuple of a class of Python's is
    made of compiled code would end the process."""
    numbers = np.zeros(len(Outcome._fields))
    _march_into(c, ship, payout, s, settings, track, w, so_far, numbers)
    values: dict[str, Any] = dict(zip(Outcome._fields, numbers.tolist(), strict=True))
    return Outcome(**values | {name: int(values[name]) for name in _COUNTS})


@kernel
def _march_into(
    c: Chain,
    ship: Curve,
    payout: Curve,
    s: State,
    settings: Settings,
    track: Track,
    w: Work,
    so_far: Outcome,
    numbers: Floats,
) -> None:
    """March and fill the numbers of the outcome, in the order of its fields."""
    o = _march(c, ship, payout, s, settings, track, w, so_far)
    numbers[0], numbers[1], numbers[2], numbers[3], numbers[4] = o.code, o.t, o.link, o.quantity, o.steps
    numbers[5], numbers[6], numbers[7], numbers[8] = o.rejected, o.iterations, o.drift, o.unexplained
    numbers[9], numbers[10], numbers[11], numbers[12] = o.snapped, o.turnover, o.nodes, o.h
    numbers[13], numbers[14] = o.row, o.base


@inner_kernel
def _march(
    c: Chain, ship: Curve, payout: Curve, s: State, settings: Settings, track: Track, w: Work, so_far: Outcome
) -> Outcome:
    """March the chain over the output times, from the first point of `s`; s, c and track change in place.

    Ends with PAUSED where there is more to do than a call may; the same call with its outcome goes on.
    """
    n, m = so_far.nodes, s.x.shape[1]
    d = len(w.axes)
    xh, vh, dV, dT = np.zeros((m, d)), np.zeros((m, d)), np.zeros((m, d)), np.zeros(m)
    jerk = np.zeros((m, d))
    paid, rates, spare, top = np.zeros(1), np.zeros((3, 1)), np.zeros(1), np.zeros(3)
    x, v, a, T = s.x, s.v, s.a, s.T
    t, h, row, base, at, at_pay = so_far.t, so_far.h, so_far.row, so_far.base, 0, 0
    end, winding, fixed = track.t[-1], payout.t.size > 0, settings.step > 0.0
    steps, rejected, iterations, drift = so_far.steps, so_far.rejected, so_far.iterations, so_far.drift
    unexplained, snapped, turnover = so_far.unexplained, so_far.snapped, so_far.turnover
    floor, accuracy = PATIENCE * _stretch_time(c, n), 1e-2 * settings.tolerance
    if winding:
        at_pay = curve_at(payout, t, at_pay, paid, rates[0], spare)
        w.reel[0] = rates[0, 0]
    energy0 = energy_of(c, n, x[0], v[0], T[0], w)
    power0, _ = power_of(c, n, x[0], v[0], a[0], T[0], w)
    if row == 0:
        base = c.length[n - 1] - paid[0]
        pull_on_ends(c, n, track, track.pull[0], x[0], v[0], a[0], T[0], w)
        first_row(track, n, x[0], v[0])
        row = 1
    rigid = False
    for i in range(n):
        rigid = rigid or c.compliance[i] == 0.0
    code, link, quantity = DONE, 0, 0.0
    last = steps + rejected + settings.at_a_time
    while row < track.t.size:
        if steps + rejected >= settings.budget:
            code, quantity = BUDGET_SPENT, h
            break
        if steps + rejected >= last:
            code = PAUSED
            break
        if fixed:
            h = settings.step
        # A step that would leave a sliver before the end takes it along or halves it.
        left = end - t
        if h > left or (left - h) < 1e-9 * max(1.0, abs(end)):
            h = left
        elif not fixed and h > 0.5 * left:
            h = 0.5 * left
        if winding:
            # The top link grows or shrinks by no more than a share of itself in a step.
            at_pay = curve_at(payout, t, at_pay, paid, rates[0], spare)
            here = paid[0]
            at_pay = curve_at(payout, t + h, at_pay, paid, rates[0], spare)
            while abs(paid[0] - here) > _REELED * settings.nominal and not fixed:
                h *= 0.5
                at_pay = curve_at(payout, t + h, at_pay, paid, rates[0], spare)
        g = _D * h
        used = 0
        for stage in range(1, 3):
            to = t + (GAMMA * h if stage == 1 else h)
            at = curve_at(ship, to, at, x[stage, n], v[stage, n], a[stage, n])
            if winding:
                at_pay = curve_at(payout, to, at_pay, paid, rates[stage], spare)
                top[stage] = base + paid[0]
                c.length[n - 1], w.reel[0] = top[stage], rates[stage, 0]
            _set_stage(stage, n, h, s, jerk, xh, vh, w.axes)
            used, link, quantity = solve_stage(c, n, g, xh, vh, x[stage], v[stage], T[stage], w, dV, dT, accuracy)
            if used < 0:
                break
            iterations += used
            for i in range(n):
                for j in range(d):
                    a[stage, i, j] = (v[stage, i, j] - vh[i, j]) / g
        if used < 0:
            rejected += 1
            h *= 0.25
            if fixed or h < SHORTEST:
                code = STUCK if quantity < 1e6 else NOT_FINITE
                break
            continue
        loose = False
        for i in range(n):
            loose = loose or T[0, i] <= 0.0 or T[1, i] <= 0.0 or T[2, i] <= 0.0
        error = 1.0
        if not fixed:
            worst, node = _local_error(c, n, h, s, w, dV, dT)
            error = worst / (max(settings.tolerance, SLACK_ERROR) if loose else settings.tolerance)
            error = max(error, _ship_strays(ship, at, t, h, n, x, v) / settings.tolerance)
            if not np.isfinite(error):
                code, link, quantity = NOT_FINITE, node, worst
                break
            if error > 1.0 and h > floor:
                rejected += 1
                h = max(floor, h * max(0.2, 0.9 * error ** (-1.0 / 3.0)))
                continue
        if rigid:
            make_consistent(c, n, x[2], v[2], a[2], T[2], spare[0] if winding else 0.0, w, dV, dT)
        if winding:
            c.length[n - 1], w.reel[0] = top[1], rates[1, 0]
        power_g, drag_g = power_of(c, n, x[1], v[1], a[1], T[1], w)
        pull_on_ends(c, n, track, track.pull[1], x[1], v[1], a[1], T[1], w)
        if winding:
            c.length[n - 1], w.reel[0] = top[2], rates[2, 0]
        power1, drag1 = power_of(c, n, x[2], v[2], a[2], T[2], w)
        energy1 = energy_of(c, n, x[2], v[2], T[2], w)
        missing = energy1 - energy0 - h * (_B0 * power0 + _B1 * power_g + _B2 * power1)
        if loose:
            snapped += missing
        else:
            unexplained += missing
        turnover += h * (_B1 * (abs(power_g - drag_g) + abs(drag_g)) + (1.0 - _B1) * (abs(power1 - drag1) + abs(drag1)))
        energy0, power0 = energy1, power1
        drift = max(drift, _drift(c, n, x[2], v[2], T[2], w))
        pull_on_ends(c, n, track, track.pull[2], x[2], v[2], a[2], T[2], w)
        if not note_slack(c, n, track, t + h, T):
            code = EVENTS_FULL
            break
        row = write_rows(track, row, n, t, h, GAMMA, x, v)
        for part in range(track.ends.size):
            for j in range(2):
                track.pull[0, part, j] = track.pull[2, part, j]
        for i in range(n + 1):
            for j in range(d):
                jerk[i, j] = (a[2, i, j] - a[0, i, j]) / h if rigid else (a[2, i, j] - a[1, i, j]) / ((1.0 - GAMMA) * h)
                x[0, i, j], v[0, i, j], a[0, i, j] = x[2, i, j], v[2, i, j], a[2, i, j]
        for i in range(n):
            T[0, i] = T[2, i]
        t += h
        steps += 1
        changed = change_of_links(c, n, m, settings.nominal) if winding else 0
        if changed != 0:
            if changed > 0:
                split(c, n, x[0], v[0], a[0], T[0], settings.nominal, w.reel[0], w.axes)
            else:
                merge(c, n, x[0], v[0], a[0], T[0], w.reel[0], w.axes)
            n += changed
            jerk[:] = 0.0
            base = c.length[n - 1] - paid[0]
            energy0 = energy_of(c, n, x[0], v[0], T[0], w)
            power0, _ = power_of(c, n, x[0], v[0], a[0], T[0], w)
        if not fixed:
            h = min(LONGEST, max(floor, h * min(3.0, 0.9 * (error + 1e-12) ** (-1.0 / 3.0))))
    return Outcome(
        code, t, link, quantity, steps, rejected, iterations, drift, unexplained, snapped, turnover, n, h, row, base
    )


@inner_kernel
def _drift(c: Chain, n: int, X: Floats, V: Floats, T: Floats, w: Work) -> float:
    """Largest closure error of a taut link over its length."""
    worst, axes = 0.0, w.axes
    up = len(axes) - 1
    for i in range(n):
        if T[i] <= 0.0:
            continue
        p = c.parent[i]
        r = minus(vector(axes, X, i, 0), vector(axes, X, p, 0))
        size, wanted = math.sqrt(dot(r, r)), 1.0
        if c.compliance[i] > 0.0:
            depth = -0.5 * (X[i, up] + X[p, up])
            pressure = (1.0 - 2.0 * c.poisson[i]) * c.specific_weight * depth * c.area[i]
            wanted += c.compliance[i] * (T[i] - pressure)
            if c.damping[i] > 0.0:
                rate = dot(r, minus(vector(axes, V, i, 0), vector(axes, V, p, 0))) / size
                wanted -= c.damping[i] * (rate - (w.reel[0] if p == n else 0.0)) / c.length[i]
        worst = max(worst, abs(size / c.length[i] - wanted))
    return worst


@inner_kernel
def _stretch_time(c: Chain, n: int) -> float:
    """Shortest time that a stretch takes along a link [s]; of a rigid link that of a stiff steel one."""
    shortest = np.inf
    for i in range(n):
        shortest = min(shortest, c.length[i] * math.sqrt(c.mass[i] * max(c.compliance[i], 1e-9)))
    return shortest
