"""What is kept of a march: the ends of the parts on the output times, whole shapes, and slack events."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from models.kernels import inner_kernel
from models.link_joint.chain import Chain
from models.link_joint.columns import Work, columns_of
from models.link_joint.forces import FAR, NEAR, end_force, water_at
from models.link_joint.vectors import Floats, combined, dot, minus, plus, raised, times, vector

#: Time after the cable is taut again in which its largest tension counts as the snap's [s].
SNAP = 10.0
#: Links that fall slack again within this time belong to the same event [s].
CHATTER = 0.5


class Track(NamedTuple):
    """Where results go: output times (k,), per part the lower end's node, its top link and the lower end's motion."""

    t: Floats
    ends: NDArray[np.int64]  # (parts,)
    tops: NDArray[np.int64]  # (parts,) link; the first part's follows the payout
    x: Floats  # (k, parts, d), along the axes that the chain moves in
    v: Floats
    T: Floats  # (k, parts, 2)
    row_of_shape: NDArray[np.int64]  # (k,) row of `shapes`, -1 where none is kept
    shapes: Floats  # (rows, m + 1, d), the ship's node in its own row of use
    nodes: NDArray[np.int64]  # (rows,) moving nodes of each shape
    T_max: Floats  # (parts,)
    events: Floats  # (most, 5) part, begin, end, metres from the upper end, peak
    used: NDArray[np.int64]  # (1,) events so far
    latest: NDArray[np.int64]  # (parts,) event that is still looked at, -1 for none
    slack: NDArray[np.int64]  # (parts,) slack links after the last step
    pull: Floats  # (3, parts, 2) at the upper and lower end of every part, at the three points of a step


@inner_kernel
def hermite(s: float, h: float, x0: float, v0: float, x1: float, v1: float) -> float:
    """The cubic at the share s of an interval h, from values and rates at its ends."""
    s2 = s * s
    s3 = s2 * s
    value: float = (2 * s3 - 3 * s2 + 1) * x0 + (s3 - 2 * s2 + s) * h * v0 + (3 * s2 - 2 * s3) * x1 + (s3 - s2) * h * v1
    return value


@inner_kernel
def _end_tension(c: Chain, n: int, i: int, end: int, X: Floats, V: Floats, A: Floats, T: Floats, w: Work) -> float:
    """Pull of the cable on what holds its lower (0) or upper (1) end [N]: the link's, and its half link's load.

    The ship's motion stands in the last row of V and A.
    """
    if T[i] <= 0.0:
        return 0.0
    W, axes = w.W, w.axes
    col, up = columns_of(axes), len(axes) - 1
    p = c.parent[i]
    q, o = (i, p) if end == 0 else (p, i)
    half = 0.5 * c.length[i]
    water = water_at(axes, c.current_depth, c.current_x, c.current_y, X[q, up], X[o, up])
    u = minus(combined(NEAR, vector(axes, V, q, 0), FAR, vector(axes, V, o, 0)), water)
    kn, kt = c.normal_drag[i] * half, c.tangential_drag[i] * half
    drag = end_force(c.law, kn, kt, u, vector(axes, W, i, col.UPPER if end == 1 else col.LOWER))
    t, a = vector(axes, W, i, col.TANGENT), vector(axes, A, q, 0)
    m, ma = c.mass[i] * half, c.added_mass[i] * half
    inertia = minus(times(m + ma, a), times(ma * dot(a, t), t))
    pull = minus(plus(times(T[i] if end == 1 else -T[i], t), drag), raised(inertia, c.weight[i] * half))
    return math.sqrt(dot(pull, pull))


@inner_kernel
def pull_on_ends(
    c: Chain, n: int, track: Track, pull: Floats, X: Floats, V: Floats, A: Floats, T: Floats, w: Work
) -> None:
    """Pull (parts, 2) at both ends of every part [N], at one point of a step, of which W holds the links' tangents."""
    for part in range(track.ends.size):
        top = n - 1 if part == 0 else track.tops[part]
        for end in range(2):
            pull[part, 1 - end] = _end_tension(c, n, top if end == 1 else track.ends[part], end, X, V, A, T, w)


@inner_kernel
def first_row(track: Track, n: int, x: Floats, v: Floats) -> None:
    """The state at the first output time."""
    d = track.x.shape[2]
    for part in range(track.ends.size):
        i = track.ends[part]
        for j in range(d):
            track.x[0, part, j], track.v[0, part, j] = x[i, j], v[i, j]
        for j in range(2):
            track.T[0, part, j] = track.pull[0, part, j]
    k = track.row_of_shape[0]
    if k >= 0:
        track.nodes[k] = n
        for i in range(n + 1):
            for j in range(d):
                track.shapes[k, i, j] = x[i, j]


@inner_kernel
def write_rows(track: Track, row: int, n: int, t: float, h: float, gamma: float, x: Floats, v: Floats) -> int:
    """The output times inside a step from t, with x and v (3, m + 1, d) at its three points; returns the next row.

    Positions by the cubic through both ends, velocities and tensions by the parabola through the three points.
    """
    d = track.x.shape[2]
    while row < track.t.size and track.t[row] <= t + h * (1.0 + 1e-12) + 1e-12:
        s = min(1.0, (track.t[row] - t) / h)
        l0 = (s - gamma) * (s - 1.0) / gamma
        l1 = s * (s - 1.0) / (gamma * (gamma - 1.0))
        l2 = s * (s - gamma) / (1.0 - gamma)
        for part in range(track.ends.size):
            i = track.ends[part]
            for j in range(d):
                track.x[row, part, j] = hermite(s, h, x[0, i, j], v[0, i, j], x[2, i, j], v[2, i, j])
                track.v[row, part, j] = l0 * v[0, i, j] + l1 * v[1, i, j] + l2 * v[2, i, j]
            for j in range(2):
                value = l0 * track.pull[0, part, j] + l1 * track.pull[1, part, j] + l2 * track.pull[2, part, j]
                track.T[row, part, j] = max(0.0, value)
        k = track.row_of_shape[row]
        if k >= 0:
            track.nodes[k] = n
            for i in range(n + 1):
                for j in range(d):
                    track.shapes[k, i, j] = hermite(s, h, x[0, i, j], v[0, i, j], x[2, i, j], v[2, i, j])
        row += 1
    return row


@inner_kernel
def note_slack(c: Chain, n: int, track: Track, t: float, T: Floats) -> bool:
    """Largest tensions and slack events after a step to t, with T (3, m); False where there is no room for events."""
    for part in range(track.ends.size):
        top = n - 1 if part == 0 else track.tops[part]
        slack, highest, peak = 0, 0, max(track.pull[1, part, 0], track.pull[2, part, 0])
        for i in range(track.ends[part], top + 1):
            peak = max(peak, T[1, i], T[2, i])
            if T[2, i] <= 0.0:
                slack += 1
                highest = i
        track.T_max[part] = max(track.T_max[part], peak)
        k = track.latest[part]
        if slack > 0 and track.slack[part] == 0:
            if k >= 0 and t <= track.events[k, 2] + CHATTER:
                track.events[k, 2] = np.inf
            else:
                if track.used[0] == track.events.shape[0]:
                    return False
                k = track.used[0]
                track.used[0] += 1
                track.latest[part] = k
                above = -0.5 * c.length[highest]
                for i in range(highest, top + 1):
                    above += c.length[i]
                event = track.events[k]
                event[0], event[1], event[2], event[3], event[4] = part, t, np.inf, above, 0.0
        elif k >= 0 and slack == 0:
            if track.slack[part] > 0:
                track.events[k, 2] = t
            if t <= track.events[k, 2] + SNAP:
                track.events[k, 4] = max(track.events[k, 4], peak)
            else:
                track.latest[part] = -1
        track.slack[part] = slack
    return True
