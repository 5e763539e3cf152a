"""Times hanging cloths of physics engines, whose models are not mssim's, with as many nodes and at their own time step.

usage: other_models.py --out DIR [--quick]     writes DIR/other_models.csv and DIR/other_models.md
       other_models.py --one ENGINE SIDE       measures one cloth of SIDE x SIDE nodes, and prints a line of JSON

Each cloth is that of the engine's own example, with another number of nodes. Each is measured in a process of its own, which may
take a minute and a half beside its preparation. Where DIR has results of mssim, they stand beside.
"""

import argparse
import csv
import importlib.metadata
import json
import os
import subprocess
import sys
import tempfile
import time

SIDES = (50, 100, 200)
THREADS = 2
LIMIT_S = 240  # of a cloth, with its preparation
SAMPLE_S = 3.0  # of the timed steps, about


def newton(solver, substeps, settings, make_solver):
    """example_cloth_hanging.py of Newton."""

    def make(side):
        import newton
        import warp as wp

        wp.config.log_level = 40
        wp.set_device("cpu")
        builder = newton.ModelBuilder()
        builder.add_ground_plane()
        builder.add_cloth_grid(pos=wp.vec3(0.0, 0.0, 4.0), rot=wp.quat_from_axis_angle(wp.vec3(0.0, 0.0, 1.0), wp.pi * 0.5),
                               vel=wp.vec3(0.0, 0.0, 0.0), dim_x=side - 1, dim_y=side - 1, cell_x=0.1, cell_y=0.1, mass=0.1,
                               fix_left=True, edge_ke=1.0e1, edge_kd=0.0, particle_radius=0.05, **settings)
        if solver == "vbd":
            builder.color(include_bending=True)
        model = builder.finalize()
        model.soft_contact_ke, model.soft_contact_mu = 1.0e2, 1.0
        model.soft_contact_kd = 1.0e2 if solver == "vbd" else 1.0
        stepper = make_solver(newton.solvers)(model)
        state = [model.state(), model.state()]
        control = model.control()
        pipeline = newton.CollisionPipeline(model)
        contacts = pipeline.contacts()
        dt = 1 / 60 / substeps

        def step(count):
            for _ in range(count):
                state[0].clear_forces()
                pipeline.collide(state[0], contacts)
                stepper.step(state[0], state[1], control, contacts, dt)
                state.reverse()
            wp.synchronize()

        return step, lambda: state[0].particle_q.numpy(), dt

    return make


def mujoco(side):
    """The cloth of model/flex/drape.xml of MuJoCo, hung by one edge."""
    import mujoco

    pins = " ".join(str(i) for i in range(side))
    model = mujoco.MjModel.from_xml_string(f"""
      <mujoco>
        <option timestep="0.002" solver="CG" tolerance="1e-6" iterations="400" integrator="discrete"/>
        <size memory="2G"/>
        <worldbody>
          <geom name="floor" type="plane" size="0 0 .1"/>
          <flexcomp name="cloth" type="grid" count="{side} {side} 1" spacing=".055 .055 .055" pos="0 0 {side * 0.06}"
                    radius=".004" mass="{0.25 * side * side / 169}" dim="2">
            <contact selfcollide="auto" passive="true" solref="0.01 1" solimp=".95 .99 .0001"/>
            <elasticity young="2e4" poisson=".2" thickness="1e-3" elastic2d="both" damping="1e-4"/>
            <pin id="{pins}"/>
          </flexcomp>
        </worldbody>
      </mujoco>""")
    data = mujoco.MjData(model)
    return lambda count: mujoco.mj_step(model, data, count), lambda: data.flexvert_xpos, model.opt.timestep


def bullet(side):
    """deformable_anchor.py of PyBullet, its cloth refined and hung by two corners."""
    import pybullet

    pybullet.connect(pybullet.DIRECT)
    pybullet.resetSimulation(pybullet.RESET_USE_DEFORMABLE_WORLD)
    pybullet.setGravity(0, 0, -10)
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "cloth.obj")
        with open(path, "w", encoding="ascii") as file:
            for row in range(side):
                for column in range(side):
                    file.write(f"v {2 * column / (side - 1) - 1} {2 * row / (side - 1) - 1} 0\n")
            for row in range(side - 1):
                for column in range(side - 1):
                    n = row * side + column + 1
                    file.write(f"f {n} {n + 1} {n + side}\nf {n + 1} {n + side + 1} {n + side}\n")
        cloth = pybullet.loadSoftBody(path, basePosition=[0, 0, 2], scale=0.5, mass=1.0, useNeoHookean=0, useBendingSprings=1,
                                      useMassSpring=1, springElasticStiffness=40, springDampingStiffness=0.1,
                                      springDampingAllDirections=1, useSelfCollision=0, frictionCoeff=0.5, useFaceContact=1)
    for corner in (0, side - 1):
        pybullet.createSoftBodyAnchor(cloth, corner, -1, -1)
    pybullet.setPhysicsEngineParameter(sparseSdfVoxelSize=0.25)

    def step(count):
        for _ in range(count):
            pybullet.stepSimulation()

    positions = lambda: pybullet.getMeshData(cloth, -1, flags=pybullet.MESH_DATA_SIMULATION_MESH)[1]
    return step, positions, pybullet.getPhysicsEngineParameters()["fixedTimeStep"]


def position_based(side):
    """cloth_model.py of pyPBD."""
    import pypbd

    simulation = pypbd.Simulation.getCurrent()
    simulation.initDefault()
    model = simulation.getModel()
    cloth = model.addRegularTriangleModel(side, side, [0, 0, 0], [[1, 0, 0], [0, 0, -1], [0, 1, 0]], [10.0, 10.0], testMesh=False)
    particles = model.getParticles()
    for corner in (0, side - 1):
        particles.setMass(corner, 0.0)
    finite_elements, isometric = 2, 2
    model.addClothConstraints(cloth, finite_elements, 1.0, 1.0, 1.0, 1.0, 0.3, 0.3, False, False)
    model.addBendingConstraints(cloth, isometric, 0.01)
    stepper = simulation.getTimeStep()
    stepper.setValueUInt(pypbd.TimeStepController.NUM_SUB_STEPS, 3)

    def step(count):
        for _ in range(count):
            stepper.step(model)

    positions = lambda: [particles.getPosition(i) for i in range(particles.size())]
    return step, positions, pypbd.TimeManager.getCurrent().getTimeStepSize()


triangles = dict(tri_ke=1.0e3, tri_ka=1.0e3)
springs = dict(add_springs=True, spring_ke=1.0e3, spring_kd=1.0e0)
contact = dict(particle_enable_self_contact=True, particle_self_contact_margin=0.02, particle_self_contact_gap=0.01)

# name: package, what makes the cloth, settings, how the model differs from mssim's
ENGINES = {
    "Newton, semi-implicit": (
        "newton", newton("semi_implicit", 32, dict(tri_kd=1.0e1, **triangles), lambda s: lambda model: s.SolverSemiImplicit(model, enable_tri_contact=False)),
        "its example's settings: 32 steps a frame of 1/60 s; without contact between triangles, which compares all nodes with all "
        "triangles",
        "triangles as finite elements and bending at edges; explicit steps; contact of nodes with each other and the ground"),
    "Newton, XPBD": (
        "newton", newton("xpbd", 10, springs, lambda s: lambda model: s.SolverXPBD(model=model, iterations=10)),
        "its example's settings: 10 steps a frame of 1/60 s, 10 iterations each",
        "springs and bending at edges as constraints (extended position-based dynamics), not converged; stable at large steps; "
        "contact with the ground"),
    "Newton, VBD": (
        "newton", newton("vbd", 10, dict(tri_kd=1.0e2, **triangles),
                         lambda s: lambda model: s.SolverVBD(model=model, iterations=10, **contact)),
        "its example's settings: 10 steps a frame of 1/60 s, 10 iterations each, self-contact",
        "implicit Euler solved by vertex block descent, not converged; stable at large steps; the cloth collides with itself"),
    "MuJoCo": (
        "mujoco", mujoco, "the settings of its drape.xml with the integrator that its contacts ask for (discrete), conjugate gradients, self-contact",
        "triangles as finite elements with bending; implicit in velocity; contacts solved; double precision"),
    "Bullet": (
        "pybullet", bullet, "the settings of its example deformable_anchor",
        "springs along the edges of triangles and bending springs; its solver of deformable bodies with contact, implicit damping; "
        "two corners hold the cloth"),
    "PositionBasedDynamics": (
        "pyPBD", position_based, "its example's settings: finite-element constraints, isometric bending, 3 substeps a step",
        "constraints projected once a substep (position-based dynamics): stiffness depends on step and iterations; two nodes hold "
        "the cloth"),
}

COLUMNS = ("model", "version", "nodes", "dt_s", "ms_per_step", "wall_s_per_simulated_s", "processors_used", "steps_timed", "status",
           "settings", "differs")


def measure(name, side):
    """ms a step over some SAMPLE_S seconds. What is compiled or allocated in the first steps is in shorter samples, which do not count."""
    import numpy

    _, make, _, _ = ENGINES[name]
    step, positions, dt = make(side)
    step(2)
    count, wall, busy = 1, 0.0, 0.0
    while wall < SAMPLE_S / 2:
        count = max(count + 1, min(10 * count, int(count * SAMPLE_S / max(wall, 1e-9))))
        start, before = time.perf_counter(), time.process_time()
        step(count)
        wall, busy = time.perf_counter() - start, time.process_time() - before
    after = numpy.asarray(positions(), float)
    good = after.size == 3 * side * side and bool(numpy.all(numpy.isfinite(after)))
    return dict(dt_s=dt, ms_per_step=1e3 * wall / count, wall_s_per_simulated_s=wall / count / dt, processors_used=busy / wall,
                steps_timed=count, status="ok" if good else "failed: positions are missing or not finite")


def row_of(name, side):
    package, _, settings, differs = ENGINES[name]
    row = dict(model=name, nodes=side * side, settings=settings, differs=differs)
    try:
        row["version"] = importlib.metadata.version(package)
        done = subprocess.run([sys.executable, __file__, "--one", name, str(side)], capture_output=True, text=True, timeout=LIMIT_S,
                              check=False)
        if done.returncode == 0:
            return row | json.loads(done.stdout.splitlines()[-1])
        said = done.stderr.strip().splitlines()
        reason = said[-1] if said else f"ended with {done.returncode}"
        row["status"] = "failed: " + reason
    except importlib.metadata.PackageNotFoundError:
        row["status"] = f"unavailable: {package} is not installed"
    except subprocess.TimeoutExpired:
        row["status"] = f"too slow: not measured within {LIMIT_S} s"
    return row


def rows_of_mssim(folder):
    """openmp's cloths of a result folder of mssim bench."""
    path = os.path.join(folder, f"{THREADS}-threads", "timings.csv")
    if not os.path.exists(path):
        return
    with open(path, encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if row["backend"] == "openmp" and row["scene"].startswith("cloth") and row["ms_per_step"]:
                ms, dt = float(row["ms_per_step"]), float(row["dt_s"])
                yield dict(model="mssim, openmp", version="", nodes=int(row["nodes"]), dt_s=dt, ms_per_step=ms,
                           wall_s_per_simulated_s=ms / 1e3 / dt, processors_used=float(row["processors_used"] or "nan"),
                           steps_timed="", status="ok", settings=f"{row['scene']}, {row['integrator']}",
                           differs="springs to twelve neighbours, explicit steps of the scene; floor, no contact with itself")


def page(rows):
    """The rows for people."""

    def number(row, column):
        return f"{row[column]:.3g}" if isinstance(row.get(column), float) else "–"

    versions = {name: importlib.metadata.version(package) for name, (package, *_) in ENGINES.items()}
    lines = ["# Cloths of other models", "",
             "Hanging cloths of physics engines with as many nodes. **Their models differ from mssim's and from each other**, in "
             "forces, stiffness, contacts and accuracy, so that this says what a cloth of so many nodes costs there, not which "
             "program is the better one. Nothing here is verified. Each steps as its own example does; *simulated second* is the "
             f"wall time of one. All may use {THREADS} processors; *processors* is how many they kept busy.", "",
             "| model | nodes | time step, s | ms per step | s per simulated second | processors |", "|---|--:|--:|--:|--:|--:|"]
    for row in rows:
        cells = [number(row, column) for column in ("dt_s", "ms_per_step", "wall_s_per_simulated_s", "processors_used")]
        if row["status"] != "ok":
            cells[1] = row["status"].split(":")[0]
        lines.append(f"| {row['model']} | {row['nodes']:,} | " + " | ".join(cells) + " |")
    lines += ["", "## What they are", ""]
    lines += [f"- {name} {versions[name]}: {settings}. {differs[0].upper() + differs[1:]}."
              for name, (_, _, settings, differs) in ENGINES.items()]
    failed = [row for row in rows if row["status"] != "ok"]
    if failed:
        lines += ["", "## Without a time", ""]
        lines += [f"- {row['model']}, {row['nodes']:,} nodes: {row['status']}" for row in failed]
    return "\n".join(lines) + "\n"


def write(folder, rows):
    with open(os.path.join(folder, "other_models.csv"), "w", encoding="utf-8", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    with open(os.path.join(folder, "other_models.md"), "w", encoding="utf-8") as file:
        file.write(page(rows))


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("--out")
    arguments.add_argument("--quick", action="store_true")
    arguments.add_argument("--one", nargs=2)
    given = arguments.parse_args()
    if given.one:
        print(json.dumps(measure(given.one[0], int(given.one[1]))))
        return 0
    os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[:THREADS])
    rows = list(rows_of_mssim(given.out))
    for name in ENGINES:
        for side in SIDES[:1] if given.quick else SIDES:
            print(f"peers: {name}, {side * side} nodes", file=sys.stderr)
            rows.append(row_of(name, side))
            # A larger one would take longer still.
            if rows[-1]["status"].startswith(("too slow", "unavailable")):
                break
    try:
        write(given.out, rows)
    except OSError as error:
        print(f"peers: {error}", file=sys.stderr)
        return 4
    return 0 if all(row["status"].startswith(("ok", "too slow")) for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
