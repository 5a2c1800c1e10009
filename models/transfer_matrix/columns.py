"""Columns of the work arrays of the matrix method: what the kernels read of the cable and of the body.

Symbols as in `models.transfer_matrix.line`. Everything is real and does not depend on frequency.
"""

#: Ends of segments, two rows a segment, so that a property may jump where two sections meet.
(
    COMPLIANCE,  # 1/EA [1/N]
    LOSS,  # tau_a [s]
    SQUEEZE,  # d strain / d height [1/m]
    STRETCH,  # 1 + e
    CURVATURE,  # phi' [rad/m]
    CURVATURE_T,  # phi'/T [rad/(m N)]
    WEIGHT_T,  # w cos phi [N/m]
    WEIGHT_A,  # w sin phi / T [rad/m]
    MASS,  # m [kg/m]
    MASS_A,  # (m + m_a)/T [kg/(m N)]
    DRAG_T,  # k_t c [N s2/m3]
    DRAG_A,  # k_n c / T
    STRAIN_T,  # change of the tangential drag with strain [N/m]
    STRAIN_A,  # change of the normal drag with strain, over T [rad/m]
    ANGLE_T,  # U sin phi: tangential relative velocity by the moved angle [m/s]
    ANGLE_A,  # U cos phi: normal relative velocity by the moved angle [m/s]
    SHEAR_T,  # -U' cos phi: tangential relative velocity by the moved height [1/s]
    SHEAR_A,  # U' sin phi: normal relative velocity by the moved height [1/s]
    SINE,  # sin phi
    COSINE,  # cos phi
) = range(20)
END_COLUMNS = 20

#: Nodes: what the linearised drag of a node needs.
(
    NODE_ANGLE_T,
    NODE_ANGLE_A,
    NODE_SHEAR_T,
    NODE_SHEAR_A,
    NODE_SINE,
    NODE_COSINE,
    NODE_FLOW_T,  # |U cos phi| [m/s]
    NODE_FLOW_A,  # |U sin phi| [m/s]
    NODE_FORCE_T,  # k_t c times the length that the node stands for: the weight of its damping
    NODE_FORCE_A,
    NODE_LENGTH,  # length that the node stands for [m]
) = range(11)
NODE_COLUMNS = 11

#: The body at the lower end.
(
    BODY_MASS_P,  # M + M_aP [kg]
    BODY_MASS_Q,
    BODY_INERTIA,  # J [kg m2]
    BODY_CROSS_P,  # r_aQ M_aP [kg m]
    BODY_CROSS_Q,  # -r_aP M_aQ [kg m]
    BODY_STIFF_P,  # -T sin psi - (B - W) cos Phi [N]
    BODY_STIFF_Q,  # T cos psi + (B - W) sin Phi [N]
    BODY_STIFF_M,  # restoring moment a radian [N m]
    BODY_TENSION,  # T_1 [N]
    BODY_SIN,  # sin psi, psi = phi_1 - Phi
    BODY_COS,
    BODY_TOW_P,  # r_cP [m]
    BODY_TOW_Q,
    BODY_DRAG_P,  # r_dP [m]
    BODY_DRAG_Q,
    BODY_K_P,  # 1/2 rho C A_P [N s2/m2]
    BODY_K_Q,
    BODY_K_TURN,  # 1/2 rho C A l^3/32 [N m s2]
    BODY_FLOW_P,  # mean relative velocity over the body, -U cos Phi [m/s]
    BODY_FLOW_Q,  # U sin Phi
    BODY_ANGLE_P,  # change of it a radian of pitch [m/s]
    BODY_ANGLE_Q,
    BODY_SHEAR_P,  # change of it a metre of height [1/s]
    BODY_SHEAR_Q,
    BODY_SLOPE_SIN,  # sin phi_1, cos phi_1: the height of the tow point is p sin + q cos
    BODY_SLOPE_COS,
    BODY_PITCHES,  # 1 for a towfish, 0 for a point
    BODY_COUPLED,  # 1 where the drag of both directions is coupled
) = range(28)
BODY_COLUMNS = 28
