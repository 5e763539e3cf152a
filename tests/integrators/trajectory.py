"""Traces of small cloths against SciPy: DOP853 (Hairer, Norsett and Wanner 1993) to a tolerance of 1e-12, on forces written here
from the formulas of src/model/system.h. Arguments: INTEGRATOR:DAMPED_ORDER:ORDER; traces are SCENE-INTEGRATOR-DT.h5, two steps each."""
import glob
import json
import math
import sys

from trace_in_python import Trace, missing, module, np, require, skip

integrate = module("scipy.integrate")
if missing:
    skip()


def accelerations(trace, scene):
    """Of the free nodes at their positions and velocities; pinned ones have none."""
    first, second = trace.springs.T
    stiffness, damping, rest = (trace.spring[key] for key in ("stiffness", "damping", "rest_length"))
    cloth = scene["cloth"]
    pinned = cloth["pins"]["row"] * cloth["columns"] + np.arange(0, cloth["columns"], cloth["pins"]["every_columns"])

    def of(x, v):
        d, u = x[second] - x[first], v[second] - v[first]
        length = np.sqrt((d * d).sum(axis=1))
        n = d / length[:, None]
        f = (stiffness * (length - rest) + damping * (u * n).sum(axis=1))[:, None] * n
        force = np.zeros_like(x)
        np.add.at(force, first, f)
        np.add.at(force, second, -f)
        a = force / trace.mass[:, None] - scene["viscous_damping_per_s"] * v - [0, scene["gravity_m_per_s2"], 0]
        a[pinned] = 0
        return a

    return of, pinned


def exact(trace, scene):
    """The positions at the time of the trace's last frame."""
    acceleration, pinned = accelerations(trace, scene)
    shape = trace.position[0].shape

    def slope(_, y):
        x, v = y.reshape(2, *shape)
        return np.concatenate([v.ravel(), acceleration(x, v).ravel()])

    start = np.concatenate([trace.position[0].ravel(), trace.velocity[0].ravel()]).astype(float)
    solution = integrate.solve_ivp(slope, (0, trace.time[-1]), start, method="DOP853", rtol=1e-12, atol=1e-13)
    require(solution.success, solution.message)
    end = solution.y[:, -1].reshape(2, *shape)[0]
    moved = np.linalg.norm(end - trace.position[0], axis=1)
    require((moved[pinned] == 0).all() and moved.max() > 0.001, f"nodes move by {moved.max()} m and pins by {moved[pinned]}")
    lengths = np.linalg.norm(end[trace.springs[:, 1]] - end[trace.springs[:, 0]], axis=1) / trace.spring["rest_length"]
    require(lengths.min() < 0.995 and lengths.max() > 1.001, f"springs have {lengths.min()} to {lengths.max()} of their rest lengths")
    return end


for number, scene_name in enumerate(["damped", "undamped"]):
    with open(scene_name + ".json") as file:
        scene = json.load(file)
    end = None
    for argument in sys.argv[1:]:
        integrator, order = argument.split(":")[0], int(argument.split(":")[1 + number])
        errors = {}
        for name in glob.glob(f"{scene_name}-{integrator}-*.h5"):
            trace = Trace(name[:-3])
            require(trace.position.dtype == np.float64, f"{name} holds {trace.position.dtype}")
            if end is None:
                end = exact(trace, scene)
                time = trace.time[-1]
            require(abs(trace.time[-1] - time) < 1e-12, f"{name} ends at {trace.time[-1]} s, others at {time} s")
            errors[time / trace.step[-1]] = np.abs(trace.position[-1] - end).max()
        require(len(errors) == 2, f"{integrator} has {len(errors)} traces of {scene_name}")
        (fine, little), (coarse, much) = sorted(errors.items())
        measured = math.log(much / little) / math.log(coarse / fine)
        print(f"{scene_name} {integrator}: {much:.2e} m at {coarse:.1e} s, {little:.2e} m at {fine:.1e} s, order {measured:.3f}")
        require(abs(measured - order) < 0.15, f"{integrator} has order {measured} on {scene_name} instead of {order}")
        require(little < 1e-4, f"{integrator} is {little} m away from SciPy")
