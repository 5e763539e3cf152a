#!/usr/bin/env python3
"""A backend of mssim. To time and verify it: mssim bench --scene cloth2500 --backend serial,openmp,./my_backend.py"""
import mssim_backend
import numpy as np


def prepare(system, method):
    first, second = system.springs.T

    def acceleration(x, v):
        d, u = x[second] - x[first], v[second] - v[first]
        length = np.sqrt(np.einsum("ij,ij->i", d, d))
        stretch = system.stiffness * (length - system.rest_length)  # N
        pull = (stretch + system.damping * np.einsum("ij,ij->i", u, d) / length) / length  # N/m
        n, forces = system.nodes, (pull[:, None] * d).T
        total = [np.bincount(first, f, n) - np.bincount(second, f, n) for f in forces]
        return np.stack(total, axis=1) / system.mass[:, None] - system.viscous_damping * v + system.gravity

    def step(x, v, count):
        for _ in range(count):
            x, v = method.step(x, v, system.dt, acceleration)
        return x, v

    return step


mssim_backend.serve(prepare, threads=1, precision="double", note="NumPy " + np.__version__)
