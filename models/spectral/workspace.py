"""Names of the rows of the kernels' workspaces."""

#: Rows of the station workspace.
PHI, TENSION, SLOPE, CHI, WORK, RATE, NORMAL, ALONG, WATER, SPREAD = range(10)
WORK_ROWS = 10
#: Rows of the matrix's workspace: moments, and sums over the stations.
DRAG, PULL, CROSS, DRAG_LIN, TIED, BENT, CROSS_ROW, CROSS_COL = range(8)
SUM_ROWS = 8
#: The state of the ends: what drives the cable, what the body bears, and the tensions found.
(
    P_TOP,  # p_top - l [m]
    P_TOP_RATE,
    ETA_2,  # [m]
    ETA_2_RATE,
    PAID,  # l [m]
    PAID_RATE,
    T_TOP,  # tension at the tow point [N]
    T_BOTTOM,  # tension at the vehicle [N]
    P_TOP_CHANGE,  # (p_top - l)'' [m/s2]
    PAID_CHANGE,  # l'' [m/s2]
    LOAD,  # the body's own force along the cable [N]
    LOAD_MASS,  # what the body weighs in along the cable [kg]
) = range(12)
END_ROWS = 12
#: Rows of the workspace `cable` (CABLE_ROWS, 2 + N): coordinates and rates, momentum and force, and the
#: lower end's d(y)/d(Phi) and its rate.
Y, V, MOMENTUM, FORCE, LEVER, SPIN = range(6)
CABLE_ROWS = 6
