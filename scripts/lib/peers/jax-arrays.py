"""JAX: whole arrays at a time, as in NumPy, compiled by XLA into one loop over steps."""

import os

os.environ.setdefault("JAX_PLATFORMS", "cpu")

import common
import jax
import jax.numpy as jnp
import mssim_backend
import numpy as np

single = np.float32


def spring_force(apart, k, k_rest, c):
    """apart: the other ends' state less that of these ends, [x y z and their velocities, ...]."""
    d, u = apart[:3], apart[3:]
    inverse = 1 / jnp.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
    closing = u[0] * d[0] + u[1] * d[1] + u[2] * d[2]
    return (k + (c * closing * inverse - k_rest) * inverse) * d


def cloth_acceleration(system):
    """Both ends of a spring are slices of the grid: each of the six directions is done at once."""
    rows, columns = system.grid.rows, system.grid.columns
    constants = [a.astype(single) for a in common.kinds(system)]

    def acceleration(state):
        a = jnp.zeros_like(state[:3])
        for row, column, kind in common.FORWARD:
            this = (slice(None), slice(rows - row), slice(max(0, -column), columns - max(0, column)))
            other = (slice(None), slice(row, rows), slice(max(0, column), columns - max(0, -column)))
            force = spring_force(state[other] - state[this], *(a[kind] for a in constants))
            a = a.at[this].add(force).at[other].add(-force)
        return a

    return acceleration


def body_acceleration(system):
    """A list of springs; adding at both ends is faster on a processor than padding all nodes to as many neighbours."""
    i, j = (jnp.asarray(end, jnp.int32) for end in system.springs.T)
    k = system.stiffness
    constants = [jnp.asarray(a, single) for a in (k, k * system.rest_length, system.damping)]
    per_mass = jnp.asarray(1 / system.mass, single)

    def acceleration(state):
        force = spring_force(state[:, j] - state[:, i], *constants)
        return jnp.zeros_like(state[:3]).at[:, i].add(force).at[:, j].add(-force) * per_mass

    return acceleration


class Program:
    def __init__(self, system, method):
        self.shape = (6, system.grid.rows, system.grid.columns) if system.grid else (6, system.nodes)
        acceleration = (cloth_acceleration if system.grid else body_acceleration)(system)
        free = jnp.asarray(common.free_nodes(system).reshape(self.shape[1:]))
        dt, viscous, gravity = (single(a) for a in (system.dt, system.viscous_damping, -system.gravity[1]))
        floor, restitution, friction = (
            single(a) for a in (system.floor.height, system.floor.restitution, system.floor.friction))

        def step_once(_, components):
            x, y, z, vx, vy, vz = components
            ax, ay, az = acceleration(jnp.stack(components))
            h = dt * free
            vx, vy, vz = vx + h * (ax - viscous * vx), vy + h * (ay - viscous * vy - gravity), vz + h * (az - viscous * vz)
            x, y, z = x + dt * vx, y + dt * vy, z + dt * vz
            low = (y < floor) & (free > 0)
            rebound = jnp.where(vy < 0, -restitution * vy, vy)
            grip = jnp.maximum(0, 1 - friction * (rebound - vy) / jnp.sqrt(vx * vx + vz * vz + single(1e-30)))
            slide = jnp.where(low, grip, 1)
            return x, jnp.where(low, floor, y), z, slide * vx, jnp.where(low, rebound, vy), slide * vz

        self.steps = jax.jit(lambda state, count: jax.lax.fori_loop(0, count, step_once, state), donate_argnums=0)
        self.set(system.position, system.velocity)
        self.step(1)  # compiles

    def set(self, x, v):
        self.state = tuple(jnp.array(a, single) for a in np.concatenate((x, v), axis=1).T.reshape(self.shape))

    def step(self, count):
        self.state = jax.block_until_ready(self.steps(self.state, count))

    def get(self):
        both = np.stack([np.asarray(a).ravel() for a in self.state], axis=1)
        return both[:, :3], both[:, 3:]


mssim_backend.serve(Program, precision="single", note=common.note(
    __file__, f"JAX {jax.__version__}", "slices of the grid; scatter-add for bodies; one jitted loop over steps"))
