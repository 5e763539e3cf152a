"""NVIDIA Warp on the processor: a kernel with a thread a node, each of which gathers its springs. Warp runs it on one thread."""

import common
import mssim_backend
import numpy as np
import warp as wp

wp.config.log_level = 40  # errors
wp.config.enable_backward = False  # no gradients

ROWS, COLUMNS, KINDS = (list(column) for column in zip(*common.ALL_TWELVE))


@wp.struct
class World:
    rows: int
    columns: int
    k: wp.vec3
    k_rest: wp.vec3
    c: wp.vec3
    dt: float
    viscous: float
    gravity: float
    floor: float
    restitution: float
    friction: float


@wp.func
def pull(d: wp.vec3, u: wp.vec3, k: float, k_rest: float, c: float):
    inverse = 1.0 / wp.sqrt(wp.dot(d, d))
    return (k + (c * wp.dot(u, d) * inverse - k_rest) * inverse) * d


@wp.func
def move(i: int, x: wp.vec3, v: wp.vec3, a: wp.vec3, free: float, world: World, x_next: wp.array(dtype=wp.vec3),
         v_next: wp.array(dtype=wp.vec3)):
    v += world.dt * free * (a - world.viscous * v - wp.vec3(0.0, world.gravity, 0.0))
    x += world.dt * v
    if x[1] < world.floor and free > 0.0:
        rebound = wp.where(v[1] < 0.0, -world.restitution * v[1], v[1])
        slide = wp.sqrt(v[0] * v[0] + v[2] * v[2] + 1.0e-30)
        grip = wp.max(0.0, 1.0 - world.friction * (rebound - v[1]) / slide)
        x = wp.vec3(x[0], world.floor, x[2])
        v = wp.vec3(grip * v[0], rebound, grip * v[2])
    x_next[i] = x
    v_next[i] = v


@wp.kernel
def step_cloth(x: wp.array(dtype=wp.vec3), v: wp.array(dtype=wp.vec3), x_next: wp.array(dtype=wp.vec3),
               v_next: wp.array(dtype=wp.vec3), free: wp.array(dtype=float), world: World):
    i = wp.tid()
    row = i // world.columns
    column = i - row * world.columns
    here, speed = x[i], v[i]
    a = wp.vec3()
    if row >= 2 and row < world.rows - 2 and column >= 2 and column < world.columns - 2:
        for n in range(12):  # Warp unrolls it
            j = i + wp.static(ROWS[n]) * world.columns + wp.static(COLUMNS[n])
            kind = wp.static(KINDS[n])
            a += pull(x[j] - here, v[j] - speed, world.k[kind], world.k_rest[kind], world.c[kind])
    else:
        for n in range(12):
            r, q = row + wp.static(ROWS[n]), column + wp.static(COLUMNS[n])
            if r >= 0 and r < world.rows and q >= 0 and q < world.columns:
                j = r * world.columns + q
                kind = wp.static(KINDS[n])
                a += pull(x[j] - here, v[j] - speed, world.k[kind], world.k_rest[kind], world.c[kind])
    move(i, here, speed, a, free[i], world, x_next, v_next)


@wp.kernel
def step_bodies(x: wp.array(dtype=wp.vec3), v: wp.array(dtype=wp.vec3), x_next: wp.array(dtype=wp.vec3),
                v_next: wp.array(dtype=wp.vec3), free: wp.array(dtype=float), world: World, starts: wp.array(dtype=int),
                others: wp.array(dtype=int), springs: wp.array(dtype=wp.vec3), mass: wp.array(dtype=float)):
    i = wp.tid()
    force = wp.vec3()
    for s in range(starts[i], starts[i + 1]):
        j = others[s]
        spring = springs[s]
        force += pull(x[j] - x[i], v[j] - v[i], spring[0], spring[1], spring[2])
    move(i, x[i], v[i], force / mass[i], free[i], world, x_next, v_next)


def world_of(system):
    world = World()
    world.dt, world.viscous, world.gravity = system.dt, system.viscous_damping, -system.gravity[1]
    world.floor, world.restitution, world.friction = system.floor.height, system.floor.restitution, system.floor.friction
    if system.grid:
        world.rows, world.columns = system.grid.rows, system.grid.columns
        world.k, world.k_rest, world.c = (wp.vec3(*a) for a in common.kinds(system))
    return world


def array(values, dtype=float):
    return wp.array(values, dtype=dtype, device="cpu")


class Program:
    def __init__(self, system, method):
        self.x, self.v, self.x_next, self.v_next = (array(a, wp.vec3) for a in (system.position, system.velocity) * 2)
        kernel, inputs = step_cloth, [array(common.free_nodes(system)), world_of(system)]
        if not system.grid:
            kernel = step_bodies
            starts, others, spring = common.neighbours(system)
            k = system.stiffness[spring]
            springs = np.stack((k, k * system.rest_length[spring], system.damping[spring]), axis=1)
            inputs += [array(starts, int), array(others, int), array(springs, wp.vec3), array(system.mass)]
        # Recorded once and launched often, which spares the checks of every launch.
        self.there, self.back = (
            wp.launch(kernel, system.nodes, [*state, *inputs], device="cpu", record_cmd=True)
            for state in ((self.x, self.v, self.x_next, self.v_next), (self.x_next, self.v_next, self.x, self.v)))

    def set(self, x, v):
        self.x.assign(x)
        self.v.assign(v)

    def step(self, count):
        for _ in range(count // 2):
            self.there.launch()
            self.back.launch()
        if count % 2:
            self.there.launch()
            self.x.assign(self.x_next)
            self.v.assign(self.v_next)

    def get(self):
        return self.x.numpy(), self.v.numpy()


mssim_backend.serve(Program, threads=1, precision="single", note=common.note(
    __file__, f"Warp {wp.config.version}", "gather, launches recorded; one thread is all that it takes on a processor"))
