"""Columns of the work array: a row holds what a stage knows of node i and of the link above it.

One array for all of it, because every array that is handed to a kernel inside a loop costs as much as the sums there.

| column | holds | width |
| --- | --- | --- |
| K, M | stiffness against dV, mass of the node, row by row | 9 |
| F, R | force out of balance, and what the eliminated nodes below add to it | 3 |
| INVERSE | K^-1 | 9 |
| E | K^-1 t | 3 |
| KAPPA | k of dT = tau0 + k.dV_p | 3 |
| G | G of dV_i = v + G dV_p | 9 |
| L, B | the node's stiffness against dV_p, the parent's against dV_i | 9 |
| TANGENT, SIZE | t from the upper to the lower end, and length of the link | 3, 1 |
| V, TAU | v and tau0 | 3, 1 |
| SCALE | 1/(t.K^-1 t + c/sigma), 0 of a slack link | 1 |
| RHO | closure error over sigma | 1 |
| LOWER, UPPER | tangent at a third of the link from that end, and the share of the link's own in it | 4 |
"""

K, M, F, R, INVERSE, E, KAPPA, G, L, B = 0, 9, 18, 21, 24, 33, 36, 39, 48, 57
TANGENT, SIZE, V, TAU, SCALE, RHO, LOWER, UPPER, WIDTH = 66, 69, 70, 73, 74, 75, 76, 80, 84
