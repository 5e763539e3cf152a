#!/usr/bin/env python3
"""A backend that holds method.step and system.land against formulas written out, before it steps with them; an object with
set, step and get. For python_backend_test.sh."""
import mssim_backend
import numpy as np


def semi_euler(x, v, dt, a):
    v = v + dt * a(x, v)
    return x + dt * v, v


def explicit_euler(x, v, dt, a):
    return x + dt * v, v + dt * a(x, v)


def midpoint(x, v, dt, a):
    x_half, v_half = x + dt / 2 * v, v + dt / 2 * a(x, v)
    return x + dt * v_half, v + dt * a(x_half, v_half)


def rk4(x, v, dt, a):
    v1, a1 = v, a(x, v)
    v2, a2 = v + dt / 2 * a1, a(x + dt / 2 * v1, v + dt / 2 * a1)
    v3, a3 = v + dt / 2 * a2, a(x + dt / 2 * v2, v + dt / 2 * a2)
    v4, a4 = v + dt * a3, a(x + dt * v3, v + dt * a3)
    return x + dt / 6 * (v1 + 2 * v2 + 2 * v3 + v4), v + dt / 6 * (a1 + 2 * a2 + 2 * a3 + a4)


def held(method):
    """With the acceleration of the start in every stage."""
    return lambda x, v, dt, a: (lambda once: method(x, v, dt, lambda *_: once))(a(x, v))


formulas = {
    "semi-euler": semi_euler,
    "midpoint": midpoint,
    "rk4": rk4,
    "midpoint-frozen": held(midpoint),
    "rk4-frozen": held(rk4),
    "explicit-euler": explicit_euler,
    "verlet": semi_euler,  # whose states mssim moves half a step ahead
}


def require_same(found, expected, what):
    worst = max(np.abs(f - e).max() for f, e in zip(found, expected))
    if not worst < 1e-13:
        raise AssertionError(f"{what} differs by {worst}")


def check_step(system, method):
    random = np.random.default_rng(1)
    x, v = (random.uniform(-1, 1, (system.nodes, 3)) for _ in range(2))
    x[:, 1] += system.floor.height + 5  # above the floor
    x[system.pins], v[system.pins] = system.position[system.pins], 0
    free = np.ones((system.nodes, 1))
    free[system.pins] = 0

    def acceleration(x, v):
        return np.cos(3 * x) - 0.5 * v * np.abs(v)

    before = x.copy(), v.copy()
    found = method.step(x, v, 0.125, acceleration)
    require_same((x, v), before, "what the step began with")
    require_same(found, formulas[method.name](x, v, 0.125, lambda x, v: free * acceleration(x, v)), method.name)


def check_floor(system):
    """Of nodes at these heights above the floor, with these velocities, each twice as fast as the next."""
    floor = system.floor
    if system.nodes < 8 or len(system.pins) >= system.nodes - 8:
        raise AssertionError("the scene is too small to test the floor")
    nodes = np.setdiff1d(np.arange(system.nodes), system.pins)[:4]
    x, v = system.position + [0, 1 - floor.height, 0], system.velocity.copy()
    x[nodes, 1] = floor.height + np.array([-0.01, -0.02, 0.01, -0.01])
    v[nodes] = [[3, -1, 4], [0.1, -4, 0], [3, -1, 4], [1, 2, 3]]
    e, mu = floor.restitution, floor.friction
    expected_x, expected_v = x.copy(), v.copy()
    expected_x[nodes[[0, 1, 3]], 1] = floor.height
    slow = 1 - mu * (1 + e) / 5  # slides at 5 m/s, and its vertical speed changes by 1 + e
    expected_v[nodes[0]] = [3 * slow, e, 4 * slow]
    expected_v[nodes[1]] = [0, 4 * e, 0]  # friction stops it: 4 mu (1 + e) is more than 0.1 m/s
    for pin in system.pins[:1]:
        x[pin, 1] = expected_x[pin, 1] = floor.height - 1  # and stays there
    system.land(x, v)
    require_same((x, v), (expected_x, expected_v), "the floor")


def check_system(system):
    n, springs = system.nodes, len(system.springs)
    shapes = {"position": (n, 3), "velocity": (n, 3), "mass": (n,), "springs": (springs, 2), "rest_length": (springs,)}
    shapes.update(stiffness=(springs,), damping=(springs,), kind=(springs,), gravity=(3,))
    for name, shape in shapes.items():
        if getattr(system, name).shape != shape:
            raise AssertionError(f"{name} is {getattr(system, name).shape}, not {shape}")
    if system.scene == "cloth2500":
        found = (n, springs, system.threads, system.dt, system.grid.rows, system.grid.columns, system.grid.spacing)
        if found != (2500, 14502, 1, 5e-5, 50, 50, 0.01) or system.tetrahedra is not None:
            raise AssertionError(f"cloth2500 is {found}")
    elif system.scene == "cloth2500-small":  # the second stretch of the verification
        if (n, system.grid.rows, system.grid.columns, system.grid.spacing) != (221, 13, 17, 0.01) or system.tetrahedra is not None:
            raise AssertionError(f"cloth2500-small is {system.grid}")
    elif system.grid is not None or system.tetrahedra.shape[1] != 4 or system.tetrahedra.max() >= n:
        raise AssertionError("a body has a grid, or no tetrahedra")


class Checked:
    def __init__(self, system, method):
        self.system, self.method = system, method
        self.first, self.second = system.springs.T

    def acceleration(self, x, v):
        d, u = x[self.second] - x[self.first], v[self.second] - v[self.first]
        length = np.linalg.norm(d, axis=1, keepdims=True)
        along = d / length
        stretching = (u * along).sum(axis=1, keepdims=True)
        system = self.system
        force = (system.stiffness[:, None] * (length - system.rest_length[:, None]) + system.damping[:, None] * stretching) * along
        total = np.zeros_like(x)
        np.add.at(total, self.first, force)
        np.subtract.at(total, self.second, force)
        return total / system.mass[:, None] + system.gravity - system.viscous_damping * v

    def set(self, x, v):
        self.x, self.v = x, v

    def step(self, count):
        for _ in range(count):
            self.x, self.v = self.method.step(self.x, self.v, self.system.dt, self.acceleration)

    def get(self):
        return self.x, self.v


def prepare(system, method):
    check_system(system)
    check_step(system, method)
    check_floor(system)
    mssim_backend.say(note=f"checked {method.name}")
    return Checked(system, method)


mssim_backend.serve(prepare, note="not checked")
