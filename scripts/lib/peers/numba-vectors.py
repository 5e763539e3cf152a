"""Numba with care for vectors (cloths only): each component of a row by itself in memory, a ring of nodes around the cloth in place
of conditions, and a loop over a row that LLVM turns into vector instructions."""

import llvmlite.binding as llvm

# LLVM leaves a loop over as many rows as these scalar, unless it may compare the addresses of all of them before.
for option in ("runtime-memory-check-threshold", "memory-check-merge-threshold", "pragma-vectorize-memory-check-threshold"):
    llvm.set_option("", f"--{option}=4096")

import common
import mssim_backend
import numba
import numpy as np
from numba import njit, prange

fast = dict(fastmath=True, error_model="numpy")
inlined = dict(inline="always", **fast)
u = np.uint64  # of an index that may be negative Numba asks whether it is


@njit(**inlined)
def node(s, row, column):
    return (s[row, 0, column], s[row, 1, column], s[row, 2, column],
            s[row, 3, column], s[row, 4, column], s[row, 5, column])


@njit(**inlined)
def pulled(a, here, there, k, k_rest, c, exists):
    """The acceleration a of a node and that of one more spring."""
    dx, dy, dz = there[0] - here[0], there[1] - here[1], there[2] - here[2]
    closing = (there[3] - here[3]) * dx + (there[4] - here[4]) * dy + (there[5] - here[5]) * dz
    inverse = np.float32(1) / np.sqrt(dx * dx + dy * dy + dz * dz)
    p = (k + (c * closing * inverse - k_rest) * inverse) * exists
    return a[0] + p * dx, a[1] + p * dy, a[2] + p * dz


@njit(parallel=True, **fast)
def step_once(s, t, free, exists, springs, world):
    """From s to t, both [rows + 4, x y z and their velocities, columns + 4].

    exists: [first two rows, an inner one, last two; spring; column] 1 where there is a spring.
    """
    rows, columns = free.shape
    (k0, k1, k2), (l0, l1, l2), (c0, c1, c2) = springs
    dt, viscous, gravity, floor, restitution, friction = world
    for row in prange(rows):
        r0, r1, r2, r3, r4 = u(row), u(row + 1), u(row + 2), u(row + 3), u(row + 4)
        e = u(row if row < 2 else max(2, row + 5 - rows))
        for i in range(u(columns)):
            i1, i2, i3, i4 = i + u(1), i + u(2), i + u(3), i + u(4)
            here = node(s, r2, i2)
            zero = np.float32(0)
            a = pulled((zero, zero, zero), here, node(s, r2, i3), k0, l0, c0, exists[e, 0, i])
            a = pulled(a, here, node(s, r3, i2), k0, l0, c0, exists[e, 1, i])
            a = pulled(a, here, node(s, r3, i3), k1, l1, c1, exists[e, 2, i])
            a = pulled(a, here, node(s, r3, i1), k1, l1, c1, exists[e, 3, i])
            a = pulled(a, here, node(s, r2, i4), k2, l2, c2, exists[e, 4, i])
            a = pulled(a, here, node(s, r4, i2), k2, l2, c2, exists[e, 5, i])
            a = pulled(a, here, node(s, r2, i1), k0, l0, c0, exists[e, 6, i])
            a = pulled(a, here, node(s, r1, i2), k0, l0, c0, exists[e, 7, i])
            a = pulled(a, here, node(s, r1, i1), k1, l1, c1, exists[e, 8, i])
            a = pulled(a, here, node(s, r1, i3), k1, l1, c1, exists[e, 9, i])
            a = pulled(a, here, node(s, r2, i), k2, l2, c2, exists[e, 10, i])
            a = pulled(a, here, node(s, r0, i2), k2, l2, c2, exists[e, 11, i])
            h = dt * free[r0, i]
            vx = here[3] + h * (a[0] - viscous * here[3])
            vy = here[4] + h * (a[1] - viscous * here[4] - gravity)
            vz = here[5] + h * (a[2] - viscous * here[5])
            t[r2, 0, i2], t[r2, 1, i2], t[r2, 2, i2] = here[0] + dt * vx, here[1] + dt * vy, here[2] + dt * vz
            t[r2, 3, i2], t[r2, 4, i2], t[r2, 5, i2] = vx, vy, vz
        land(row, t, free, floor, restitution, friction)


@njit(**fast)
def land(row, t, free, floor, restitution, friction):
    """The floor, for a row: few nodes are ever below it. (Given the row itself, LLVM loses sight of what the loop above writes.)"""
    lowest = np.float32(np.inf)
    for i in range(free.shape[1]):
        lowest = min(lowest, t[row + 2, 1, i + 2])
    if lowest >= floor:
        return
    for i in range(free.shape[1]):
        p = t[row + 2, :, i + 2]
        if p[1] < floor and free[row, i] > 0:
            rebound = -restitution * p[4] if p[4] < 0 else p[4]
            slide = np.sqrt(p[3] * p[3] + p[5] * p[5] + np.float32(1e-30))
            grip = max(np.float32(0), np.float32(1) - friction * (rebound - p[4]) / slide)
            p[1], p[3], p[4], p[5] = floor, grip * p[3], rebound, grip * p[5]


@njit(**fast)
def steps(count, s, t, free, exists, springs, world):
    for _ in range(count // 2):
        step_once(s, t, free, exists, springs, world)
        step_once(t, s, free, exists, springs, world)
    if count % 2:
        step_once(s, t, free, exists, springs, world)
        s[:] = t


class Cloth:
    def __init__(self, system, method):
        if not system.grid:
            raise mssim_backend.Unsupported("this one is written for cloths")
        single = np.float32
        self.rows, self.columns = rows, columns = system.grid.rows, system.grid.columns
        numba.set_num_threads(min(system.threads, numba.config.NUMBA_NUM_THREADS))
        self.free = common.free_nodes(system).reshape(rows, columns)
        self.springs = tuple(tuple(a.astype(single)) for a in common.kinds(system))
        floor = system.floor
        self.world = tuple(single(a) for a in (system.dt, system.viscous_damping, -system.gravity[1], floor.height,
                                               floor.restitution, floor.friction))
        row, column = np.array([0, 1, 2, rows - 2, rows - 1]), np.arange(columns)
        self.exists = np.array([[(0 <= r + dr < rows) & (column + dc >= 0) & (column + dc < columns)
                                 for dr, dc, _ in common.ALL_TWELVE] for r in row], single)
        # The nodes of the ring stand far from all others, that no spring to them has the length zero.
        self.state = np.zeros((rows + 4, 6, columns + 4), single)
        self.state[:, 0] = 1e3 * (1 + np.arange(columns + 4))
        self.set(system.position, system.velocity)
        self.other = self.state.copy()
        self.step(2)  # compiles
        self.set(system.position, system.velocity)

    def set(self, x, v):
        both = np.concatenate((x, v), axis=1).reshape(self.rows, self.columns, 6)
        self.state[2:-2, :, 2:-2] = both.transpose(0, 2, 1)

    def step(self, count):
        steps(count, self.state, self.other, self.free, self.exists, self.springs, self.world)

    def get(self):
        both = self.state[2:-2, :, 2:-2].transpose(0, 2, 1).reshape(-1, 6)
        return both[:, :3], both[:, 3:]


mssim_backend.serve(Cloth, precision="single", note=common.note(
    __file__, f"Numba {numba.__version__}", "gather from padded rows by component, vectorised, fastmath, threads by OpenMP"))
