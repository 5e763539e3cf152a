"""Opens traces NAME.h5, with NAME.xdmf and the energy curve NAME.csv beside them, as readers_test.sh wrote them, with each reader that
this Python has. What h5py reads is compared with the energy curve, and what the others read with that. Ends with 77 if one is missing.

Arguments: the names."""
import csv
import importlib
import sys

from trace_in_python import Trace, check_all, h5py, missing, module, np, require, require_refused


def check_h5py(_, trace):
    """Energies of the positions, velocities and springs, and times, are those of the energy curve."""
    with open(trace.name + ".csv") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    require(len(rows) == len(trace.time) >= 3, f"{trace.name}: {len(trace.time)} frames, and {len(rows)} in the curve")
    for time, row in zip(trace.time, rows):
        require(abs(time - float(row["time_s"])) < 1e-9, f"{trace.name}: a time is {time} instead of {row['time_s']}")
    for frame, row in enumerate(rows):
        position, velocity = (vectors[frame].astype(float) for vectors in (trace.position, trace.velocity))
        ends = position[trace.springs]
        strain = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) - trace.spring["rest_length"]
        kinetic = 0.5 * np.sum(trace.mass * np.sum(velocity**2, axis=1))
        elastic = 0.5 * np.sum(trace.spring["stiffness"] * strain**2)
        for value, column in ((kinetic, "kinetic_j"), (elastic, "elastic_j")):
            require(abs(value - float(row[column])) < 1e-5 * float(row["total_j"]),
                    f"{trace.name}, frame {frame}: {column} is {value} instead of {row[column]}")
    if trace.tetrahedra is not None:
        edges = {tuple(sorted((t[a], t[b]))) for t in trace.tetrahedra.tolist() for a in range(4) for b in range(a)}
        require(edges == {tuple(sorted(spring)) for spring in trace.springs.tolist()}, "the springs are not the edges of the tetrahedra")


def check_mdanalysis(mda, trace):
    def universe(**options):
        return mda.Universe.empty(trace.nodes(), trajectory=True).load_new(trace.name + ".h5", format="H5MD", **options)

    frames = universe(convert_units=False).trajectory
    require(len(frames) == len(trace.time), f"MDAnalysis sees {len(frames)} frames of {trace.name}")
    for frame in frames:
        i = frame.frame
        require(np.array_equal(frame.positions, trace.position[i].astype(np.float32)), f"MDAnalysis: positions of {trace.name}, {i}")
        require(np.array_equal(frame.velocities, trace.velocity[i].astype(np.float32)), f"MDAnalysis: velocities of {trace.name}, {i}")
        require(frame.time == trace.time[i] and frame.data["step"] == trace.step[i], f"MDAnalysis: time of {trace.name}, {i}")
    require_refused(universe, ValueError, "MDAnalysis cannot read a trace with units")
    require_refused(lambda: mda.Universe(trace.name + ".h5"), ValueError, "MDAnalysis reads no topology")


def check_vtk(vtk, trace):
    require(not hasattr(vtk, "vtkXdmf3Reader"), "docs/traces.md says that VTK has no vtkXdmf3Reader, but it has")
    arrays = importlib.import_module(vtk.__name__ + ".util.numpy_support").vtk_to_numpy
    reader = vtk.vtkXdmfReader()
    reader.SetFileName(trace.name + ".xdmf")
    reader.UpdateInformation()
    times = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
    require(list(times) == list(trace.time), f"VTK: times of {trace.name}")
    for i, time in enumerate(times):
        reader.UpdateTimeStep(time)
        shown = reader.GetOutputDataObject(0)
        blocks = [shown.GetBlock(b) for b in range(shown.GetNumberOfBlocks())] if shown.IsA("vtkMultiBlockDataSet") else [shown]
        whole = f"VTK: {trace.name}, frame {i}"
        parts = [(first, first + rows * columns) for first, rows, columns in trace.grids] or [(0, trace.nodes())]
        for block, (first, end) in zip(blocks, parts):
            points = arrays(block.GetPoints().GetData())
            require(points.dtype == trace.position.dtype and np.array_equal(points, trace.position[i, first:end]), f"{whole}: positions")
            velocity = arrays(block.GetPointData().GetArray("velocity"))
            require(np.array_equal(velocity, trace.velocity[i, first:end]), f"{whole}: velocities")
        for block, (_, rows, columns) in zip(blocks, trace.grids):
            extent = (0, columns - 1, 0, rows - 1, 0, 0)
            require(block.IsA("vtkStructuredGrid") and tuple(block.GetExtent()) == extent, f"{whole}: rows and columns")
        if trace.particles == "bodies":
            cells = blocks[0].GetCells()
            kinds = {blocks[0].GetCellType(cell) for cell in range(blocks[0].GetNumberOfCells())}
            require(kinds == {vtk.VTK_TETRA}, f"{whole}: kinds of cells")
            require(np.array_equal(arrays(cells.GetConnectivityArray()).reshape(-1, 4), trace.tetrahedra), f"{whole}: tetrahedra")
        if trace.particles == "garment":
            require(len(blocks) == len(parts) + 1, f"{whole}: {len(blocks)} blocks")
            points, triangles = trace.body
            require(np.array_equal(arrays(blocks[-1].GetPoints().GetData()), points), f"{whole}: points of the body")
            seen = arrays(blocks[-1].GetCells().GetConnectivityArray()).reshape(-1, 3)
            require(np.array_equal(seen, triangles), f"{whole}: triangles of the body")
            require([arrays(block.GetPointData().GetArray("panel"))[0] for block in blocks] == [*range(len(parts)), -1], f"{whole}: panels")


def check_meshio(meshio, trace):
    require_refused(lambda: meshio.xdmf.read(trace.name + ".xdmf"), meshio.ReadError, "meshio.read() reads no series")

    def series():
        with meshio.xdmf.TimeSeriesReader(trace.name + ".xdmf") as reader:
            points, cells = reader.read_points_cells()
            return points, cells, [reader.read_data(frame) for frame in range(reader.num_steps)]

    if trace.particles != "bodies":
        return require_refused(series, meshio.ReadError, "meshio reads no structured grids")
    points, cells, data = series()
    require(np.array_equal(points, trace.position[0]), f"meshio: positions of {trace.name}")
    require(len(cells) == 1 and cells[0].type == "tetra" and np.array_equal(cells[0].data, trace.tetrahedra), "meshio: tetrahedra")
    require([time for time, *_ in data] == list(trace.time), f"meshio: times of {trace.name}")
    for frame, (_, of_points, _) in enumerate(data):
        require(list(of_points) == ["velocity"] and np.array_equal(of_points["velocity"], trace.velocity[frame]), "meshio: velocities")


vtk = module("vtk")
if vtk and not hasattr(vtk, "vtkXdmfReader"):
    missing.append(f"vtkXdmfReader in its VTK {vtk.VTK_VERSION}")
    vtk = None
checks = ((h5py, check_h5py), (module("MDAnalysis"), check_mdanalysis), (vtk, check_vtk), (module("meshio"), check_meshio))
check_all(checks, [Trace(name) for name in sys.argv[1:]])
