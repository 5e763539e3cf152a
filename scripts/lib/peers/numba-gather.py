"""Numba as its documentation shows it: a parallel loop over nodes, each of which gathers its springs."""

import common
import mssim_backend
import numba
import numpy as np
from numba import njit, prange

ROWS, COLUMNS, KINDS = (tuple(column) for column in zip(*common.ALL_TWELVE))
fast = dict(fastmath=True, error_model="numpy")


@njit(**fast)
def pull(d, u, k, k_rest, c):
    """Acceleration by a spring over the vector to its other end."""
    inverse = np.float32(1) / np.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    return k + (c * (u[0] * d[0] + u[1] * d[1] + u[2] * d[2]) * inverse - k_rest) * inverse


@njit(**fast)
def minus(a, b):
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@njit(**fast)
def move(x, v, a, free, world, x_next, v_next):
    """Semi-implicit Euler, and the floor."""
    dt, viscous, gravity, floor, restitution, friction = world
    vx = v[0] + dt * free * (a[0] - viscous * v[0])
    vy = v[1] + dt * free * (a[1] - viscous * v[1] - gravity)
    vz = v[2] + dt * free * (a[2] - viscous * v[2])
    y = x[1] + dt * vy
    if y < floor and free > 0:
        rebound = -restitution * vy if vy < 0 else vy
        slide = np.sqrt(vx * vx + vz * vz + np.float32(1e-30))
        grip = max(np.float32(0), np.float32(1) - friction * (rebound - vy) / slide)
        x_next[0], x_next[1], x_next[2] = x[0] + dt * vx, floor, x[2] + dt * vz
        v_next[0], v_next[1], v_next[2] = grip * vx, rebound, grip * vz
    else:
        x_next[0], x_next[1], x_next[2] = x[0] + dt * vx, y, x[2] + dt * vz
        v_next[0], v_next[1], v_next[2] = vx, vy, vz


@njit(inline="always", **fast)
def pulled(a, x, v, i, j, row, column, k, k_rest, c):
    """The acceleration a of a node and that of its spring to another one."""
    dx, dy, dz = x[i, j, 0] - x[row, column, 0], x[i, j, 1] - x[row, column, 1], x[i, j, 2] - x[row, column, 2]
    ux, uy, uz = v[i, j, 0] - v[row, column, 0], v[i, j, 1] - v[row, column, 1], v[i, j, 2] - v[row, column, 2]
    p = pull((dx, dy, dz), (ux, uy, uz), k, k_rest, c)
    return a[0] + p * dx, a[1] + p * dy, a[2] + p * dz


@njit(parallel=True, **fast)
def step_cloth(x, v, x_next, v_next, free, springs, world):
    rows, columns, _ = x.shape
    k, k_rest, c = springs
    for row in prange(rows):
        for column in range(columns):
            a = (np.float32(0), np.float32(0), np.float32(0))
            if 2 <= row < rows - 2 and 2 <= column < columns - 2:
                a = pulled(a, x, v, row, column + 1, row, column, k[0], k_rest[0], c[0])
                a = pulled(a, x, v, row + 1, column, row, column, k[0], k_rest[0], c[0])
                a = pulled(a, x, v, row + 1, column + 1, row, column, k[1], k_rest[1], c[1])
                a = pulled(a, x, v, row + 1, column - 1, row, column, k[1], k_rest[1], c[1])
                a = pulled(a, x, v, row, column + 2, row, column, k[2], k_rest[2], c[2])
                a = pulled(a, x, v, row + 2, column, row, column, k[2], k_rest[2], c[2])
                a = pulled(a, x, v, row, column - 1, row, column, k[0], k_rest[0], c[0])
                a = pulled(a, x, v, row - 1, column, row, column, k[0], k_rest[0], c[0])
                a = pulled(a, x, v, row - 1, column - 1, row, column, k[1], k_rest[1], c[1])
                a = pulled(a, x, v, row - 1, column + 1, row, column, k[1], k_rest[1], c[1])
                a = pulled(a, x, v, row, column - 2, row, column, k[2], k_rest[2], c[2])
                a = pulled(a, x, v, row - 2, column, row, column, k[2], k_rest[2], c[2])
            else:
                for n in range(12):
                    i, j, kind = row + ROWS[n], column + COLUMNS[n], KINDS[n]
                    if 0 <= i < rows and 0 <= j < columns:
                        a = pulled(a, x, v, i, j, row, column, k[kind], k_rest[kind], c[kind])
            move(x[row, column], v[row, column], a, free[row, column], world, x_next[row, column], v_next[row, column])


@njit(parallel=True, **fast)
def step_bodies(x, v, x_next, v_next, free, springs, world):
    starts, others, k, k_rest, c, mass = springs
    for i in prange(len(x)):
        fx = fy = fz = np.float32(0)
        for s in range(starts[i], starts[i + 1]):
            d = minus(x[others[s]], x[i])
            p = pull(d, minus(v[others[s]], v[i]), k[s], k_rest[s], c[s])
            fx, fy, fz = fx + p * d[0], fy + p * d[1], fz + p * d[2]
        move(x[i], v[i], (fx / mass[i], fy / mass[i], fz / mass[i]), free[i], world, x_next[i], v_next[i])


def prepare(system, method):
    single = np.float32
    floor = system.floor
    world = tuple(single(a) for a in (system.dt, system.viscous_damping, -system.gravity[1], floor.height,
                                      floor.restitution, floor.friction))
    shape, free = (system.nodes, 3), common.free_nodes(system)
    if system.grid:
        step_once = step_cloth
        shape = (system.grid.rows, system.grid.columns, 3)
        free = free.reshape(shape[:2])
        springs = tuple(a.astype(single) for a in common.kinds(system))
    else:
        step_once = step_bodies
        starts, others, spring = common.neighbours(system)
        k = system.stiffness[spring]
        springs = (starts, others, *(a.astype(single) for a in (k, k * system.rest_length[spring],
                                                               system.damping[spring], system.mass)))
    numba.set_num_threads(min(system.threads, numba.config.NUMBA_NUM_THREADS))

    def step(x, v, count):
        for _ in range(count):
            step_once(x, v, spare[0], spare[1], free, springs, world)
            x, v, spare[0], spare[1] = spare[0], spare[1], x, v
        return x, v

    class Program:
        def set(self, x, v):
            self.x, self.v = (a.astype(single).reshape(shape) for a in (x, v))

        def step(self, count):
            self.x, self.v = step(self.x, self.v, count)

        def get(self):
            return self.x.reshape(-1, 3), self.v.reshape(-1, 3)

    spare = [np.empty(shape, single), np.empty(shape, single)]
    program = Program()
    program.set(system.position, system.velocity)
    program.step(1)  # compiles
    program.set(system.position, system.velocity)
    return program


mssim_backend.serve(prepare, precision="single", note=common.note(
    __file__, f"Numba {numba.__version__}", "prange over nodes, gather, fastmath, threads by OpenMP"))
