"""Compares pictures NAME-AZIMUTH,ELEVATION.png of `mssim render` and the depths .depths beside them, as vtk_test.sh wrote them, with what
VTK sees of NAME.obj: its camera looks as docs/pictures.md says, and it casts a ray at each point. Rays need no graphics driver, and tell
what is at the very points that mssim draws at. Ends with 77 if a module is missing.

Arguments: NAME-AZIMUTH,ELEVATION of each picture."""
import sys

from trace_in_python import missing, module, np, require, skip

vtk = module("vtk")
if not vtk:
    skip()
arrays = module("vtkmodules.util.numpy_support").vtk_to_numpy

SAMPLES, MARGIN = 4, 0.06  # points of a pixel in each direction; how much of the picture is free on each side
BACKGROUND = np.array((0.91, 0.92, 0.94))  # its light
# mssim rounds corners to 1/16384 of the distance of two points: an edge may pass a point on its other side.
MOST_PIXELS, MOST_RAYS = 3, 5  # of a picture that may differ
MOST_DEPTH = 2e-5              # that depths may differ by, of the extent of what is seen


def read_picture(name):
    """[rows][columns][3] light of the channels, 0 to 1, the lowest row first."""
    reader = vtk.vtkPNGReader()
    reader.SetFileName(name)
    reader.Update()
    columns, rows, _ = reader.GetOutput().GetDimensions()
    code = arrays(reader.GetOutput().GetPointData().GetScalars()).reshape(rows, columns, 3) / 255
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)


def shown_in(light, elevation):
    """[rows][columns] whether a pixel shows the subject, and from which part of a pixel on that can be told for sure."""
    if elevation <= 0:  # from there no ground is drawn
        return np.any(light != light[0, 0], axis=2), 1 / SAMPLES**2
    # Ground, lines and shadows are darker than the background, but of its hue; what is drawn here is blue or skin.
    ratio = light / BACKGROUND
    return np.ptp(ratio, axis=2) > 0.01 * ratio.mean(axis=2), 1 / 2


class Rays:
    """What VTK sees at the points of a picture, which shows the subject only, or where there is ground has the edges and steps of `grid`,
    with more room: for the shadow."""

    def __init__(self, name, azimuth, elevation, columns, rows, grid):
        reader = vtk.vtkOBJReader()
        reader.SetFileName(name)
        camera = vtk.vtkCamera()  # it looks from +z at the origin, 1 m away
        camera.Azimuth(azimuth)
        camera.Elevation(elevation)
        seen = vtk.vtkTransformPolyDataFilter()
        seen.SetTransform(camera.GetViewTransformObject())
        seen.SetOutputPointsPrecision(vtk.vtkAlgorithm.DOUBLE_PRECISION)
        seen.SetInputConnection(reader.GetOutputPort())
        seen.Update()
        self.distance = camera.GetDistance()
        self.locator = vtk.vtkStaticCellLocator()
        self.locator.SetDataSet(seen.GetOutput())
        self.locator.BuildLocator()
        left, right, bottom, top, self.far, self.near = seen.GetOutput().GetBounds()
        self.extent = max(right - left, top - bottom, self.near - self.far)
        self.step = max((right - left) / columns, (top - bottom) / rows) / (1 - 2 * MARGIN) / SAMPLES
        self.left = (left + right - SAMPLES * columns * self.step) / 2
        self.bottom = (bottom + top - SAMPLES * rows * self.step) / 2
        if elevation > 0:
            self.left, self.bottom, step = grid
            require(step >= self.step * (1 - 1e-9), f"{name}: a picture with ground has no room for the subject")
            self.step = step
            width, height = SAMPLES * columns * step, SAMPLES * rows * step
            into = max(self.left + MARGIN * width - left, right - self.left - (1 - MARGIN) * width,
                       self.bottom + MARGIN * height - bottom, top - self.bottom - (1 - MARGIN) * height)
            # The reader's points are in single precision.
            require(into <= 1e-6 * self.extent, f"{name}: the subject reaches {into / self.extent:.2g} of its extent into the margin")
        self.hit = vtk.reference(0.0), [0.0] * 3, [0.0] * 3, vtk.reference(0), vtk.reference(0)

    def depth(self, column, row):
        """m towards the camera from the origin, of what a ray through a point of the picture meets first; NaN where it meets nothing."""
        x, y = self.left + (column + 0.5) * self.step, self.bottom + (row + 0.5) * self.step
        fraction, point, *others = self.hit
        start, end = self.near + self.extent, self.far - self.extent
        if not self.locator.IntersectWithLine((x, y, start), (x, y, end), 0.0, fraction, point, *others):
            return np.nan
        return point[2] + self.distance

    def depths(self, shown):
        """depth() at the points of a picture, by row and column, and where a ray was cast: one for each pixel, and one for each point of
        those near the outline, also that of the picture. Elsewhere it is NaN."""
        rows, columns = shown.shape
        depths = np.full((SAMPLES * rows, SAMPLES * columns), np.nan)
        cast = np.zeros(depths.shape, bool)
        cast[1::SAMPLES, 1::SAMPLES] = True
        for row, column in zip(*np.nonzero(cast)):
            depths[row, column] = self.depth(column, row)
        outline = near_outline(~np.isnan(depths[1::SAMPLES, 1::SAMPLES])) | near_outline(shown)
        refined = np.kron(outline, np.ones((SAMPLES, SAMPLES), bool)) & ~cast
        for row, column in zip(*np.nonzero(refined)):
            depths[row, column] = self.depth(column, row)
        return depths, cast | refined


def near_outline(seen):
    """Which pixels differ from one of their eight neighbours."""
    padded = np.pad(seen, 1, mode="edge")
    rows, columns = seen.shape
    near = [padded[1 + j : 1 + j + rows, 1 + i : 1 + i + columns] for i in (-1, 0, 1) for j in (-1, 0, 1)]
    return np.any([shifted != seen for shifted in near], axis=0)


def pixels_off(covered, shown, least):
    """How many pixels show the subject and are covered by nothing of it, or do not and are covered by `least` (a part) of it, and how many
    of them do not lie at the outline."""
    off = np.where(shown, covered == 0, covered >= least)
    return np.count_nonzero(off), np.count_nonzero(off & ~near_outline(covered > 0))


def rays_off(cast, depths, drawn, most):
    """How many of the rays that were cast have another depth."""
    same = (np.isnan(depths) & np.isnan(drawn)) | (np.abs(drawn - depths) <= most)
    return np.count_nonzero(cast & ~same)


def check(name):
    azimuth, elevation = map(float, name.split("-", 1)[1].split(","))
    shown, least = shown_in(read_picture(name + ".png"), elevation)
    rows, columns = shown.shape
    grid, drawn = np.split(np.fromfile(name + ".depths"), [3])
    rays = Rays(name.split("-", 1)[0] + ".obj", azimuth, elevation, columns, rows, grid)
    depths, cast = rays.depths(shown)
    hits, tried = (np.count_nonzero(points.reshape(rows, SAMPLES, columns, SAMPLES), axis=(1, 3)) for points in (~np.isnan(depths), cast))
    covered = hits / tried
    drawn = drawn.reshape(depths.shape)
    most = MOST_DEPTH * rays.extent

    wrong, far = pixels_off(covered, shown, least)
    wrong_rays = rays_off(cast, depths, drawn, most)
    largest = np.nanmax(np.abs(drawn - depths)[cast]) / rays.extent
    print(f"{name}: {np.count_nonzero(covered)} pixels, {np.count_nonzero(near_outline(covered > 0))} at the outline: {wrong} differ; "
          f"{np.count_nonzero(cast)} rays: {wrong_rays} differ, the depths by {largest:.1e} of the extent or less")
    require(wrong <= MOST_PIXELS and far == 0, f"{name}: {wrong} pixels of the silhouette differ, {far} of them off the outline")
    require(wrong_rays <= MOST_RAYS, f"{name}: {wrong_rays} depths differ")
    # A picture a pixel beside its place, or depths a point beside theirs, would not pass.
    for axis in (0, 1):
        require(pixels_off(covered, np.roll(shown, 1, axis), least)[0] > 10 * MOST_PIXELS, f"{name}: the silhouette may lie anywhere")
        require(rays_off(cast, depths, np.roll(drawn, 1, axis), most) > 100 * MOST_RAYS, f"{name}: depths may lie anywhere")


for argument in sys.argv[1:]:
    check(argument)
