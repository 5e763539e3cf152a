"""A backend of mssim in Python.

    import mssim_backend

    def prepare(system, method):          # called once
        def step(x, v, count):            # positions and velocities, [nodes, 3]
            for _ in range(count):
                x, v = method.step(x, v, system.dt, acceleration)
            return x, v
        return step

    mssim_backend.serve(prepare)

`mssim new-backend NAME --language python` writes a complete one; mssim runs it with
`mssim bench --scene cloth2500 --backend serial,openmp,./NAME.py`.

Needs Python 3.9, NumPy and h5py. mssim puts this file's folder into PYTHONPATH. All quantities are in SI units.
"""

import os
import socket
import sys
import traceback
from types import SimpleNamespace

try:
    import numpy as np
except ModuleNotFoundError:
    if "MSSIM_SOCKET" not in os.environ:
        raise
    np = None  # the end of this file tells mssim

__all__ = ["Method", "System", "Unavailable", "Unsupported", "say", "serve"]

PROTOCOL = "1"
_longest_text = 4000  # bytes; a line of the protocol has at most 4,096
_no_reason = "no reason given"


class Unsupported(Exception):
    """Raised by `prepare`: the program does not support this scene or integrator. Its text is the reason."""


class Unavailable(Exception):
    """Raised by `prepare`: the program cannot run here. Its text is the reason."""


class System:
    """The simulated system. Names are those of the datasets of system.h5; nodes are in the scene's order.

    position, velocity   [nodes, 3]    start state, m and m/s
    mass                 [nodes]       kg
    pins                 [pinned]      nodes that keep their start position, at rest
    springs              [springs, 2]  the two nodes of each spring
    rest_length          [springs]     m
    stiffness, damping   [springs]     N/m; N s/m, along the spring
    kind                 [springs]     springs of one kind have the same constants
    gravity              [3]           m/s^2
    viscous_damping                    1/s
    floor                              height (m), restitution, friction
    grid                               of a cloth: rows, columns, spacing (m); else None;
                                       node = row * columns + column
    tetrahedra           [n, 4]        of bodies: the nodes of each; else None

    Other datasets of system.h5 are there, too: further constants of the law of a spring, [springs].
    Also: scene (its name), dt (s, time step), threads (maximum number to use), nodes (number of nodes).
    Numbers are double precision, indices 64-bit integers.
    """

    def __init__(self, data, scene="", dt=0.0, threads=1):
        """`data`: system.h5, or a dict of the same shape."""
        self.scene, self.dt, self.threads = scene, dt, threads
        indices = {"pins", "springs", "kind"}
        required = {"position", "velocity", "mass", "rest_length", "stiffness", "damping", "gravity"}
        further = data.keys() - indices - {"viscous_damping", "floor", "grid", "tetrahedra", "scene", "dt", "threads"}
        for name in required | further:
            setattr(self, name, np.array(data[name], dtype=np.float64))
        for name in indices:
            # Column-major, which is faster to index with than pairs.
            setattr(self, name, np.array(data[name], dtype=np.int64, order="F"))
        self.viscous_damping = float(data["viscous_damping"][()])
        self.floor = _numbers(data["floor"])
        self.grid = _numbers(data["grid"]) if "grid" in data else None
        self.tetrahedra = np.array(data["tetrahedra"], dtype=np.int64) if "tetrahedra" in data else None
        self.nodes = len(self.mass)
        self._free = np.ones(self.nodes, dtype=bool)
        self._free[self.pins] = False

    def land(self, x, v):
        """Puts nodes below the floor back on its surface and changes their velocities, in place.

        The falling speed is multiplied by the restitution and reversed; the sliding speed loses at most friction
        times the change of the vertical speed. `method.step` calls this itself.
        """
        below = np.flatnonzero((x[:, 1] < self.floor.height) & self._free)
        if below.size == 0:
            return
        vx, vy, vz = v[below].T
        rebound = np.where(vy < 0, -self.floor.restitution * vy, vy)
        # 1e-30 keeps the quotient finite for a node that does not slide.
        grip = 1 - self.floor.friction * (rebound - vy) / np.sqrt(vx * vx + vz * vz + 1e-30)
        grip = np.maximum(grip, 0)
        x[below, 1] = self.floor.height
        v[below] = np.stack([grip * vx, rebound, grip * vz], axis=1)


class Method:
    """An integrator, as a table.

    name     for example "rk4"
    stages   list of (x slot, v slot, assignments): the acceleration is evaluated at these two slots, then the
             assignments are executed in order: list of (out, terms), terms: list of (coefficient, power, slot);
             out = sum of coefficient * dt^power * slot

    Slots are names. "x" and "v" are the state before the step, "a" the acceleration, "x_next" and "v_next" the
    state after the last stage.
    """

    def __init__(self, name, stages, system):
        self.name, self.stages, self._system = name, stages, system

    def step(self, x, v, dt, acceleration):
        """Takes one step of dt seconds; returns the new x and v in new arrays.

        acceleration(x, v) returns the acceleration of all nodes, [nodes, 3] m/s^2. It may ignore
        pinned nodes, whose acceleration is set to zero here, and the floor.
        """
        slots = {"x": x, "v": v}
        for x_slot, v_slot, assignments in self.stages:
            slots["a"] = acceleration(slots[x_slot], slots[v_slot])
            slots["a"][self._system.pins] = 0  # every slot of a pinned node stays at its start
            for out, terms in assignments:
                slots[out] = _sum_of(terms, dt, slots)
        self._system.land(slots["x_next"], slots["v_next"])
        return slots["x_next"], slots["v_next"]


def say(*, device=None, threads=None, precision=None, note=None):
    """Tells mssim more about the program. `prepare` may call it; the last value counts.

    device      device it runs on (default: cpu; others than "cpu" and "cpu ..." disable the roofline comparison)
    threads     CPUs that it uses (default: the number requested)
    precision   "single" (default), or "double" and others, which disable the roofline comparison
    note        for readers of its times: version, settings
    """
    given = {"device": device, "threads": threads, "precision": precision, "note": note}
    _said.update((field, value) for field, value in given.items() if value is not None and _one_line(value))


def serve(prepare, *, device=None, threads=None, precision=None, note=None):
    """Answers mssim until it ends. The other arguments are those of `say`.

    prepare(system, method) is called once. It returns either a function step(x, v, count) that takes `count`
    steps and returns the new x and v, or, for programs that keep their own state, an object with
        set(x, v)      sets the state; called with the start state before anything else
        step(count)    takes `count` steps; they must be finished on return
        get()          returns x and v
    It may raise Unsupported or Unavailable. Any other exception, in any of these calls, is a failure: its last
    line is sent to mssim, its traceback goes to stderr.
    """
    path = os.environ.get("MSSIM_SOCKET")
    if path is None:
        program = os.path.basename(sys.argv[0])
        sys.exit(f"{program} is a backend of mssim: mssim bench --scene cloth2500 --backend serial,openmp,./{program}")
    if hasattr(sys.stdout, "reconfigure"):
        sys.stdout.reconfigure(line_buffering=True)  # so that no output is lost when mssim ends the program
    _said.clear()
    say(device=device, threads=threads, precision=precision, note=note)
    try:
        _Conversation(path).hold(prepare)
    except _MssimHasEnded:
        pass


_said = {}


class _MssimHasEnded(Exception):
    """The other end of the socket is closed."""


class _Conversation:
    """The program's side of protocol 1: lines on a socket, states in a file."""

    def __init__(self, path):
        self._socket = socket.socket(socket.AF_UNIX)
        self._socket.connect(path)
        self._lines = self._socket.makefile("rb")

    def hold(self, prepare):
        backend = self._guarded(lambda: self._prepared(prepare))
        if backend is None:
            return
        for field, value in _said.items():
            self._tell(f"{field} {_one_line(value)}")
        self._tell(f"ready {PROTOCOL}")
        while True:
            request = self._hear()
            if request[0] == "end":
                return
            answer = self._guarded(lambda: self._done(backend, request))
            if answer is not None:
                self._tell(answer)

    def _prepared(self, prepare):
        system, method = self._introduction()
        backend = prepare(system, method)
        if callable(backend) and not hasattr(backend, "step"):
            backend = _StepFunction(backend)
        for name in ("set", "step", "get"):
            if not callable(getattr(backend, name, None)):
                raise TypeError("prepare returned neither a function step(x, v, count) nor an object with set, step, get")
        backend.set(system.position.copy(), system.velocity.copy())
        return backend

    def _introduction(self):
        """Reads what mssim sends before `prepare`: the scene, the integrator and the paths of files."""
        said, stages = {}, []
        while True:
            word, *words = self._hear()
            if word == "prepare":
                break
            if word == "stage":
                stages.append((words[0], words[1], []))
            elif word == "assign":
                stages[-1][2].append((words[0], _terms(words[1:])))
            else:
                said[word] = " ".join(words)
        if said.get("mssim-backend") != PROTOCOL:
            raise RuntimeError(f"mssim speaks protocol {said.get('mssim-backend')}, mssim_backend.py {PROTOCOL}")
        self._state_file = said["state"]
        system = _read_system(said["system"], said["scene"], float(said["dt"]), int(said["threads"]))
        self._shape = (system.nodes, 3)
        return system, Method(said["integrator"], stages, system)

    def _done(self, backend, request):
        if request[0] == "step":
            backend.step(int(request[1]))
        elif request[0] == "set":
            x, v = np.fromfile(self._state_file).reshape((2,) + self._shape)
            backend.set(x, v)
        elif request[0] == "get":
            x, v = (self._checked(array) for array in backend.get())
            with open(self._state_file, "r+b") as file:
                x.tofile(file)
                v.tofile(file)
        else:
            raise RuntimeError(f"mssim requested {request[0]}, which this mssim_backend.py does not support")
        return "done"

    def _checked(self, array):
        array = np.ascontiguousarray(array, dtype=np.float64)
        if array.shape != self._shape:
            raise ValueError(f"the state is an array {list(array.shape)} instead of {list(self._shape)}")
        return array

    def _guarded(self, call):
        """The result of `call`; None after an exception, which is reported to mssim."""
        try:
            return call()
        except _MssimHasEnded:
            raise
        except Unsupported as reason:
            self._tell(f"unsupported {_one_line(reason) or _no_reason}")
        except Unavailable as reason:
            self._tell(f"unavailable {_one_line(reason) or _no_reason}")
        except Exception as error:
            traceback.print_exc()
            sys.stderr.flush()
            self._tell(f"failed {_one_line(_described(error))}")
        return None

    def _hear(self):
        """The words of the next line."""
        try:
            line = self._lines.readline()
        except OSError:
            line = b""
        if not line:
            raise _MssimHasEnded
        return os.fsdecode(line).rstrip("\n").split(" ")

    def _tell(self, line):
        try:
            self._socket.sendall(line.encode(errors="replace") + b"\n")
        except OSError:
            raise _MssimHasEnded from None


class _StepFunction:
    """Keeps the state for a function step(x, v, count)."""

    def __init__(self, function):
        self._function = function

    def set(self, x, v):
        self._state = x, v

    def step(self, count):
        state = self._function(*self._state, count)
        if not isinstance(state, (tuple, list)) or len(state) != 2:
            raise TypeError("step(x, v, count) did not return the new x and v")
        self._state = state

    def get(self):
        return self._state


def _read_system(path, scene, dt, threads):
    try:
        import numpy  # noqa: F401  h5py would fail without a name
        import h5py
    except ModuleNotFoundError as missing:
        raise Unavailable(
            f"{sys.executable} has no module {missing.name}: install python3-{missing.name}, or {missing.name} with pip"
        ) from None
    with h5py.File(path, "r") as file:
        return System(file, scene, dt, threads)


def _numbers(group):
    """The scalars of a group, as attributes; whole ones stay whole."""
    return SimpleNamespace(**{name: np.asarray(group[name][()]).item() for name in group})


def _terms(words):
    """The terms of an assignment: coefficient, power of dt and slot of each."""
    return [(float(words[i]), int(words[i + 1]), words[i + 2]) for i in range(0, len(words), 3)]


def _sum_of(terms, dt, slots):
    """A new array. The first term is the large one: it is added last, so it is rounded once."""
    total = None
    for coefficient, power, slot in reversed(terms):
        factor = coefficient * dt**power
        if total is None:
            total = factor * slots[slot]
        else:
            total += slots[slot] if factor == 1 else factor * slots[slot]
    return total


def _one_line(text):
    """The text without line ends, cut to the maximum length of a line."""
    return " ".join(str(text).split()).encode(errors="replace")[:_longest_text].decode(errors="ignore")


def _described(error):
    """The error, and its line in the program's own file."""
    text = "".join(traceback.format_exception_only(type(error), error))
    program = getattr(sys.modules.get("__main__"), "__file__", None)
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == program]
    return f"line {lines[-1]}: {text}" if lines else text


if np is None:  # the program itself would fail at its import
    serve(None)
    sys.exit()
