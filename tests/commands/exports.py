"""Opens exports of traces NAME.h5 with VTK and meshio, as export_test.sh wrote them, and compares points, cells, values and times with
what h5py reads of the trace. Ends with 77 if a module is missing.

Arguments: the names."""
import importlib
import sys

from trace_in_python import Trace, check_all, missing, module, np, require


def outer_faces(tetrahedra):
    """[faces][3] nodes of the faces of one tetrahedron alone, in ascending order."""
    faces = np.sort(np.concatenate([tetrahedra[:, list(corners)] for corners in ((0, 1, 2), (0, 1, 3), (0, 2, 3), (1, 2, 3))]))
    faces, count = np.unique(faces, axis=0, return_counts=True)
    return faces[count == 1]


class Expected:
    """Points and triangles of a trace's surface; the body that does not move comes last."""

    def __init__(self, trace):
        self.trace = trace
        self.body = trace.body if trace.particles == "garment" else (np.zeros((0, 3)), np.zeros((0, 3), int))
        if trace.tetrahedra is not None:
            faces = outer_faces(trace.tetrahedra)
            self.node = np.unique(faces)
            self.triangles = np.searchsorted(self.node, faces)
            return
        self.node = np.arange(trace.nodes())
        triangles = []
        for first, rows, columns in trace.grids:
            a = first + (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
            triangles += [np.stack((a, a + 1, a + columns + 1), 1), np.stack((a, a + columns + 1, a + columns), 1)]
        self.triangles = np.concatenate([*triangles, trace.nodes() + self.body[1]])

    def points(self, frame, node=None):
        return np.concatenate((self.trace.position[frame, self.node if node is None else node], self.body[0]))

    def velocity(self, frame, node=None):
        return np.concatenate((self.trace.velocity[frame, self.node if node is None else node], 0 * self.body[0]))

    def strain(self, frame, node=None):
        trace, total, count = self.trace, np.zeros(self.trace.nodes()), np.zeros(self.trace.nodes())
        ends = trace.position[frame].astype(float)[trace.springs]
        strain = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / trace.spring["rest_length"] - 1
        for end in (0, 1):
            np.add.at(total, trace.springs[:, end], strain)
            np.add.at(count, trace.springs[:, end], 1)
        return np.concatenate(((total / count)[self.node if node is None else node], np.zeros(len(self.body[0]))))

    def part(self, node):
        parts = [part for part, (_, rows, columns) in enumerate(self.trace.grids) for _ in range(rows * columns)] or [0] * self.trace.nodes()
        return [*np.array(parts)[node], *[-1] * len(self.body[0])]

    def require_triangles(self, triangles, points, what):
        """The same, whatever corner each begins with; those of bodies point outwards."""
        ordered = lambda list: np.array(sorted(map(tuple, np.sort(list, axis=1).tolist())))
        require(np.array_equal(ordered(triangles), ordered(self.triangles)), f"{what}: triangles")
        if self.trace.tetrahedra is not None:
            a, b, c = (points[triangles[:, corner]].astype(float) for corner in range(3))
            whole = self.trace.position[0].astype(float)[self.trace.tetrahedra]
            volume = np.sum(np.linalg.det(whole[:, 1:] - whole[:, :1])) / 6
            require(abs(np.sum(a * np.cross(b, c)) / 6 - volume) < 0.05 * volume, f"{what}: the triangles do not point outwards")


def check_meshio(meshio, expected):
    trace = expected.trace
    for frame in range(len(trace.time)):
        name = f"{trace.name}-{frame:06}"
        obj, ply = meshio.read(name + ".obj"), meshio.read(name + ".ply")
        for mesh, what in ((obj, name + ".obj"), (ply, name + ".ply")):
            require(np.array_equal(mesh.points.astype(trace.position.dtype), expected.points(frame)), f"meshio: {what}: points")
            triangles = np.concatenate([block.data for block in mesh.cells if block.type == "triangle"])
            require({block.type for block in mesh.cells} == {"triangle"}, f"meshio: {what}: kinds of cells")
            expected.require_triangles(triangles, mesh.points, f"meshio: {what}")
        velocity = np.stack([ply.point_data[key] for key in ("vx", "vy", "vz")], 1)
        require(np.array_equal(velocity, expected.velocity(frame)), f"meshio: {name}.ply: velocity")
        require(np.allclose(ply.point_data["strain"], expected.strain(frame), rtol=1e-5, atol=1e-9), f"meshio: {name}.ply: strain")
        require(np.array_equal(ply.point_data["node"], [*expected.node, *[-1] * len(expected.body[0])]), f"meshio: {name}.ply: node")
        require(np.array_equal(ply.point_data["part"], expected.part(expected.node)), f"meshio: {name}.ply: part")


def check_vtk(vtk, expected):
    arrays = importlib.import_module("vtkmodules.util.numpy_support").vtk_to_numpy
    trace, solid = expected.trace, expected.trace.tetrahedra
    node = None if solid is None else np.arange(trace.nodes())
    for file, frames in ((trace.name + ".vtkhdf", range(len(trace.time))), (trace.name + "-last.vtkhdf", [len(trace.time) - 1])):
        reader = vtk.vtkHDFReader()
        reader.SetFileName(file)
        reader.UpdateInformation()
        times = reader.GetOutputInformation(0).Get(vtk.vtkStreamingDemandDrivenPipeline.TIME_STEPS())
        if len(frames) == 1:
            require(times is None, "docs/traces.md says that VTK tells no time of a single frame, but it does")
            times = [trace.time[frames[0]]]
        require(list(times) == [trace.time[frame] for frame in frames], f"VTK: {file}: times")
        for frame, time in zip(frames, times):
            reader.UpdateTimeStep(time)
            grid, what = reader.GetOutputDataObject(0), f"VTK: {file}, frame {frame}"
            points = arrays(grid.GetPoints().GetData())
            require(points.dtype == trace.position.dtype, f"{what}: precision")
            require(np.array_equal(points, expected.points(frame, node)), f"{what}: points")
            values = {key: arrays(grid.GetPointData().GetArray(key)) for key in ("velocity", "strain", "node", "part")}
            require(np.array_equal(values["velocity"], expected.velocity(frame, node)), f"{what}: velocity")
            require(np.allclose(values["strain"], expected.strain(frame, node), rtol=1e-5, atol=1e-9), f"{what}: strain")
            require(np.array_equal(values["node"][:trace.nodes()], np.arange(trace.nodes())), f"{what}: node")
            require(np.array_equal(values["part"], expected.part(np.arange(trace.nodes()))), f"{what}: part")
            kinds = {grid.GetCellType(cell) for cell in range(grid.GetNumberOfCells())}
            require(kinds == {vtk.VTK_TRIANGLE if solid is None else vtk.VTK_TETRA}, f"{what}: kinds of cells")
            cells = arrays(grid.GetCells().GetConnectivityArray())
            if solid is None:
                expected.require_triangles(cells.reshape(-1, 3), points, what)
            else:
                require(np.array_equal(cells.reshape(-1, 4), solid), f"{what}: tetrahedra")
    for reader, ending in ((vtk.vtkPLYReader(), ".ply"), (vtk.vtkOBJReader(), ".obj")):
        reader.SetFileName(f"{trace.name}-000001{ending}")
        reader.Update()
        points = arrays(reader.GetOutput().GetPoints().GetData())
        require(np.array_equal(points.astype(np.float32), expected.points(1).astype(np.float32)), f"VTK: {trace.name}{ending}: points")
        triangles = arrays(reader.GetOutput().GetPolys().GetConnectivityArray()).reshape(-1, 3)
        expected.require_triangles(triangles, points, f"VTK: {trace.name}{ending}")


vtk = module("vtk")
if vtk and vtk.vtkVersion().GetVTKMajorVersion() * 100 + vtk.vtkVersion().GetVTKMinorVersion() < 903:
    missing.append(f"times of VTKHDF in its VTK {vtk.VTK_VERSION}")
    vtk = None
check_all(((vtk, check_vtk), (module("meshio"), check_meshio)), [Expected(Trace(name)) for name in sys.argv[1:]])
