"""Quadrants: a kernel over nodes, each of which gathers its springs."""

import common
import mssim_backend
import numpy as np
import quadrants as qd

single = qd.f32


@qd.func
def pull(d, u, k, k_rest, c):
    inverse = 1 / qd.sqrt(d.dot(d))
    return (k + (c * u.dot(d) * inverse - k_rest) * inverse) * d


def vectors(shape):
    return qd.Vector.field(3, single, shape)


def filled(values, dtype=single):
    field = qd.field(dtype, values.shape)
    field.from_numpy(values.astype(np.float32 if dtype == single else np.int32))
    return field


def mover(system, free):
    """Semi-implicit Euler and the floor, for the node at index i."""
    dt, viscous, gravity = system.dt, system.viscous_damping, -system.gravity[1]
    floor, restitution, friction = system.floor.height, system.floor.restitution, system.floor.friction

    @qd.func
    def move(i, x, v, a, x_next: qd.template(), v_next: qd.template()):
        v += dt * free[i] * (a - viscous * v - qd.Vector([0.0, gravity, 0.0]))
        x += dt * v
        if x.y < floor and free[i] > 0:
            rebound = qd.select(v.y < 0, -restitution * v.y, v.y)
            grip = qd.max(0.0, 1 - friction * (rebound - v.y) / qd.sqrt(v.x * v.x + v.z * v.z + 1e-30))
            x.y = floor
            v = qd.Vector([grip * v.x, rebound, grip * v.z])
        x_next[i] = x
        v_next[i] = v

    return move


def cloth_kernel(system, shape):
    rows, columns = shape
    k, k_rest, c = common.kinds(system)
    move = mover(system, filled(common.free_nodes(system).reshape(shape)))

    @qd.kernel
    def step(x: qd.template(), v: qd.template(), x_next: qd.template(), v_next: qd.template()):
        for i in qd.grouped(x):
            a = qd.Vector([0.0, 0.0, 0.0])
            if 2 <= i.x < rows - 2 and 2 <= i.y < columns - 2:
                for row, column, kind in qd.static(common.ALL_TWELVE):
                    j = i + qd.Vector([row, column])
                    a += pull(x[j] - x[i], v[j] - v[i], k[kind], k_rest[kind], c[kind])
            else:
                for row, column, kind in qd.static(common.ALL_TWELVE):
                    j = i + qd.Vector([row, column])
                    if 0 <= j.x < rows and 0 <= j.y < columns:
                        a += pull(x[j] - x[i], v[j] - v[i], k[kind], k_rest[kind], c[kind])
            move(i, x[i], v[i], a, x_next, v_next)

    return step


def bodies_kernel(system):
    starts, others, spring = common.neighbours(system)
    starts, others = filled(starts, qd.i32), filled(others, qd.i32)
    stiffness = system.stiffness[spring]
    k, k_rest, c = (filled(a) for a in (stiffness, stiffness * system.rest_length[spring], system.damping[spring]))
    mass = filled(system.mass)
    move = mover(system, filled(common.free_nodes(system)))

    @qd.kernel
    def step(x: qd.template(), v: qd.template(), x_next: qd.template(), v_next: qd.template()):
        for i in x:
            force = qd.Vector([0.0, 0.0, 0.0])
            for s in range(starts[i], starts[i + 1]):
                j = others[s]
                force += pull(x[j] - x[i], v[j] - v[i], k[s], k_rest[s], c[s])
            move(i, x[i], v[i], force / mass[i], x_next, v_next)

    return step


class Program:
    def __init__(self, system, method):
        qd.init(arch=qd.cpu, cpu_max_num_threads=system.threads, fast_math=True, default_fp=single, log_level=qd.ERROR,
                offline_cache=False)
        shape = (system.grid.rows, system.grid.columns) if system.grid else (system.nodes,)
        self.kernel = cloth_kernel(system, shape) if system.grid else bodies_kernel(system)
        self.state = vectors(shape), vectors(shape)
        self.next = vectors(shape), vectors(shape)
        self.shape = (*shape, 3)
        self.set(system.position, system.velocity)
        self.step(2)  # compiles

    def set(self, x, v):
        for field, values in zip(self.state, (x, v)):
            field.from_numpy(values.astype(np.float32).reshape(self.shape))

    def step(self, count):
        for _ in range(count):
            self.kernel(*self.state, *self.next)
            self.state, self.next = self.next, self.state
        qd.sync()

    def get(self):
        return tuple(field.to_numpy().reshape(-1, 3) for field in self.state)


mssim_backend.serve(Program, precision="single", note=common.note(
    __file__, f"Quadrants {'.'.join(map(str, qd.__version__))}", "gather from fields of vectors, fast_math"))
