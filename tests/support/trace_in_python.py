"""What the tests in Python share: modules that may be missing, requirements, and a trace as h5py reads it."""
import importlib
import sys

missing = []


def module(name):
    try:
        return importlib.import_module(name)
    except ImportError:
        missing.append(f"module {name}")
        return None


def skip():
    print(f"SKIPPED: {sys.executable} has no " + " and no ".join(missing) + "; .ci/run installs scripts/readers.txt into build/readers")
    sys.exit(77)


h5py = module("h5py")
np = module("numpy")
if not h5py or not np:
    skip()


def require(good, what):
    if not good:
        sys.exit(f"FAILED: {what}")


def require_refused(read, error, what):
    """docs/traces.md says that `what` is not possible."""
    try:
        read()
    except error:
        return
    sys.exit(f"FAILED: docs/traces.md says that {what}, but it can")


class Trace:
    """All that h5py reads."""

    def __init__(self, name):
        self.name = name
        with h5py.File(name + ".h5") as file:
            (self.particles,) = file["particles"]
            group = file["particles"][self.particles]
            self.position, self.velocity = group["position/value"][:], group["velocity/value"][:]
            self.time, self.step, self.mass = group["position/time"][:], group["position/step"][:], group["mass"][:]
            self.springs = file["connectivity/springs"][:]
            self.tetrahedra = file["connectivity/tetrahedra"][:] if "tetrahedra" in file["connectivity"] else None
            self.spring = {key: values[:] for key, values in file["parameters/springs"].items()}
            self.grids = []  # first node, rows, columns
            if self.particles == "cloth":
                parameters = file["parameters"].attrs
                self.grids = [(0, parameters["rows"], parameters["columns"])]
            elif self.particles == "garment":
                self.grids = list(zip(*(file["parameters/panels/" + key][:].tolist() for key in ("first_node", "rows", "columns"))))
                self.body = file["body/points"][:], file["body/triangles"][:]

    def nodes(self):
        return self.position.shape[1]


def check_all(checks, subjects):
    """Runs each check(module, subject) whose module is there. Ends with 77, and says why, if something is missing."""
    for reader, check in checks:
        if not reader:
            continue
        for subject in subjects:
            check(reader, subject)
        print(reader.__name__, getattr(reader, "VTK_VERSION", None) or reader.__version__, "agrees")
    if missing:
        skip()
