"""The body at the lower end, and how its motion moves the cable's end.

Body coordinates b = (X, Z) of a point, or (X, Z, Phi) of a towfish (H (15)-(17)), X and Z counted from the static
place [m], Phi absolute [rad]. The cable's end deflection (p_b, eta_1) is a function of b (T (2.61)-(2.63)); its
Jacobian carries the end force back to the body. Added mass acts in body axes without the terms of rotating
added mass, as H has it: d/dt of the body-axis momentum is the force.
"""

import math

import numpy as np
from numpy.typing import NDArray

from models.kernels import inline_kernel
from models.spectral.basis import FLOW_0, PITCH, SHEAR_0, TANGENT_X, TANGENT_Z, Fields
from models.spectral.workspace import FORCE, LEVER, LOAD, LOAD_MASS, MOMENTUM, SPIN, V, Y

Floats = NDArray[np.float64]


@inline_kernel
def end_motion(f: Fields, b: Floats, w: Floats, cable: Floats) -> None:
    """Fill the cable's lower end in `cable` (rows Y, V), and d(y)/d(Phi) and its rate (rows LEVER, SPIN)."""
    t_x, t_z = f.scalar[TANGENT_X], f.scalar[TANGENT_Z]
    ex, ez, vx, vz = b[0], b[1], w[0], w[1]
    if f.body.size > 3:
        P, Q = f.body[13], f.body[14]
        s, c = math.sin(b[2]), math.cos(b[2])
        s0, c0 = math.sin(f.scalar[PITCH]), math.cos(f.scalar[PITCH])
        ex += P * (c - c0) - Q * (s - s0)
        ez += P * (s - s0) + Q * (c - c0)
        lx, lz = -P * s - Q * c, P * c - Q * s
        vx += lx * w[2]
        vz += lz * w[2]
        cable[LEVER, 0], cable[LEVER, 1] = t_x * lx + t_z * lz, -t_z * lx + t_x * lz
        sx, sz = -lz * w[2], lx * w[2]
        cable[SPIN, 0], cable[SPIN, 1] = t_x * sx + t_z * sz, -t_z * sx + t_x * sz
    cable[Y, 0], cable[Y, 1] = t_x * ex + t_z * ez, -t_z * ex + t_x * ez
    cable[V, 0], cable[V, 1] = t_x * vx + t_z * vz, -t_z * vx + t_x * vz


@inline_kernel
def body_balance(f: Fields, b: Floats, w: Floats, momentum: Floats, F: Floats) -> None:
    """Fill the body's own momentum and the forces on it other than the cable's."""
    flow = f.scalar[FLOW_0] + f.scalar[SHEAR_0] * b[1]
    if f.body.size == 3:
        m, k, W = f.body[0], f.body[1], f.body[2]
        u, v = w[0] - flow, w[1]
        speed = math.sqrt(u * u + v * v)
        momentum[0], momentum[1] = m * w[0], m * w[1]
        F[0], F[1] = -k * speed * u, -k * speed * v - W
        return
    a = f.body
    M, M_aP, M_aQ, inertia, W, B, k_P, k_Q, k_r = a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]
    r_aP, r_aQ, r_bP, r_bQ, r_dP, r_dQ = a[9], a[10], a[11], a[12], a[15], a[16]
    s, c = math.sin(b[2]), math.cos(b[2])
    U, V = w[0] * c + w[1] * s, -w[0] * s + w[1] * c
    u, v = U - flow * c, V + flow * s
    k = k_P * abs(u) + k_Q * abs(v)
    F_P, F_Q = (B - W) * s - k * u, (B - W) * c - k * v
    a_P, a_Q = M_aP * U, M_aQ * V
    momentum[0] = M * w[0] + a_P * c - a_Q * s
    momentum[1] = M * w[1] + a_P * s + a_Q * c
    momentum[2] = inertia * w[2] + r_aP * a_Q - r_aQ * a_P
    # The frame of the added mass turns: R' a, with R' = Phi' R S.
    g_P, g_Q = F_P - w[2] * a_Q, F_Q + w[2] * a_P
    F[0], F[1] = g_P * c - g_Q * s, g_P * s + g_Q * c
    F[2] = B * (r_bP * c - r_bQ * s) - k_r * w[2] * abs(w[2]) - k * (r_dP * v - r_dQ * u)


@inline_kernel
def bear(f: Fields, b: Floats, w: Floats, F: Floats, cable: Floats, end: Floats) -> None:
    """Fill what the body bears along the cable: its own force F there, and its mass.

    A towfish gives way by turning too: 1/M_t = t M^-1 t + lever^2/J, without the moment of its added mass.
    """
    t_x, t_z = f.scalar[TANGENT_X], f.scalar[TANGENT_Z]
    if f.body.size == 3:
        end[LOAD], end[LOAD_MASS] = t_x * F[0] + t_z * F[1], f.body[0]
        return
    s, c = math.sin(b[2]), math.cos(b[2])
    M_P, M_Q, J = f.body[0] + f.body[1], f.body[0] + f.body[2], f.body[3]
    t_P, t_Q = t_x * c + t_z * s, -t_x * s + t_z * c
    lever = cable[LEVER, 0]
    give = t_P * t_P / M_P + t_Q * t_Q / M_Q + lever * lever / J
    free = t_P * (F[0] * c + F[1] * s) / M_P + t_Q * (-F[0] * s + F[1] * c) / M_Q
    free += lever * F[2] / J + cable[SPIN, 0] * w[2]
    end[LOAD], end[LOAD_MASS] = free / give, 1.0 / give


@inline_kernel
def couple(f: Fields, cable: Floats, momentum: Floats, F: Floats) -> None:
    """Add the cable's end momentum and force (rows MOMENTUM, FORCE), carried to the body by the transposed Jacobian."""
    t_x, t_z = f.scalar[TANGENT_X], f.scalar[TANGENT_Z]
    momentum[0] += t_x * cable[MOMENTUM, 0] - t_z * cable[MOMENTUM, 1]
    momentum[1] += t_z * cable[MOMENTUM, 0] + t_x * cable[MOMENTUM, 1]
    F[0] += t_x * cable[FORCE, 0] - t_z * cable[FORCE, 1]
    F[1] += t_z * cable[FORCE, 0] + t_x * cable[FORCE, 1]
    if f.body.size > 3:
        for i in range(2):
            momentum[2] += cable[LEVER, i] * cable[MOMENTUM, i]
            F[2] += cable[LEVER, i] * cable[FORCE, i] + cable[SPIN, i] * cable[MOMENTUM, i]
