"""NumPy: whole arrays at a time, one array a component, results written into arrays that are there already."""

import common
import mssim_backend
import numpy as np

single = np.float32


class Springs:
    """The pull of springs, side by side in arrays of any shape; its arrays are used again in every step."""

    def __init__(self, shape, k, k_rest, c):
        self.k, self.k_rest, self.c = k, k_rest, c
        self.d = np.empty((3, *shape), single)
        self.u = np.empty((3, *shape), single)
        self.inverse = np.empty(shape, single)
        self.pull = np.empty(shape, single)

    def forces(self):
        """Makes forces of d, the vectors to the other ends, and u, their velocities; in place of d."""
        d, u, inverse, pull = self.d, self.u, self.inverse, self.pull
        np.einsum("i...,i...->...", d, u, out=pull)
        np.einsum("i...,i...->...", d, d, out=inverse)
        np.sqrt(inverse, out=inverse)
        np.divide(1, inverse, out=inverse)
        pull *= inverse
        pull *= self.c
        pull -= self.k_rest
        pull *= inverse
        pull += self.k
        d *= pull
        return d


class ClothSprings:
    """Both ends of a spring are slices of the grid: each of the six directions is done at once."""

    def __init__(self, system):
        self.shape = rows, columns = system.grid.rows, system.grid.columns
        constants = [a.astype(single) for a in common.kinds(system)]
        self.directions = []
        for row, column, kind in common.FORWARD:
            this = (slice(None), slice(rows - row), slice(max(0, -column), columns - max(0, column)))
            other = (slice(None), slice(row, rows), slice(max(0, column), columns - max(0, -column)))
            shape = (rows - row, columns - abs(column))
            self.directions.append((this, other, Springs(shape, *(a[kind] for a in constants))))

    def accelerate(self, x, v, a):
        x, v, a = (array.reshape(3, *self.shape) for array in (x, v, a))
        for this, other, springs in self.directions:
            np.subtract(x[other], x[this], out=springs.d)
            np.subtract(v[other], v[this], out=springs.u)
            force = springs.forces()
            a[this] += force
            a[other] -= force


class BodySprings:
    """A list of springs; their forces are added at the nodes by np.bincount, which is faster here than np.add.at."""

    def __init__(self, system):
        self.i, self.j = (np.ascontiguousarray(end) for end in system.springs.T)
        k = system.stiffness
        self.springs = Springs(k.shape, *(a.astype(single) for a in (k, k * system.rest_length, system.damping)))
        self.per_mass = (1 / system.mass).astype(single)
        self.nodes = system.nodes

    def accelerate(self, x, v, a):
        springs = self.springs
        for axis in range(3):
            np.subtract(x[axis, self.j], x[axis, self.i], out=springs.d[axis])
            np.subtract(v[axis, self.j], v[axis, self.i], out=springs.u[axis])
        for axis, force in enumerate(springs.forces()):
            total = np.bincount(self.i, force, self.nodes)
            total -= np.bincount(self.j, force, self.nodes)
            a[axis] += total * self.per_mass


class Program:
    def __init__(self, system, method):
        self.system = system
        self.springs = (ClothSprings if system.grid else BodySprings)(system)
        self.a = np.empty((3, system.nodes), single)

    def set(self, x, v):
        self.x, self.v = (np.ascontiguousarray(a.T, single) for a in (x, v))

    def step(self, count):
        system, x, v, a = self.system, self.x, self.v, self.a
        dt, viscous = single(system.dt), single(system.viscous_damping)
        gravity = system.gravity.astype(single)[:, None]
        for _ in range(count):
            np.multiply(v, -viscous, out=a)
            a += gravity
            self.springs.accelerate(x, v, a)
            a *= dt
            a[:, system.pins] = 0
            v += a
            np.multiply(v, dt, out=a)
            x += a
            if x[1].min() < system.floor.height:
                system.land(x.T, v.T)

    def get(self):
        return self.x.T, self.v.T


mssim_backend.serve(Program, threads=1, precision="single", note=common.note(
    __file__, f"NumPy {np.__version__}", "slices of the grid; bincount for bodies"))
