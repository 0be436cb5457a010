# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of particles and structures at some times, as told by plot.json."""
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.figure import Figure

TETRAHEDRA = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))
FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))


def values_of(data, name, scale):
    """A scalar, the length of a vector ("speed" is that of the velocity) or a component "NAME.x"."""
    name = "velocity" if name == "speed" else name
    name, _, component = name.partition(".")
    if name not in data:
        raise KeyError(f"there is no field '{name}'; there are {', '.join(sorted(data))}")
    values = np.asarray(data[name], dtype=float) * scale
    if values.ndim == 1:
        return values
    return values[:, "xyz".index(component)] if component else np.linalg.norm(values, axis=1)


class View:
    """Projects to the plane of the picture: x and y, or in 3-D the view from a direction."""

    def __init__(self, snapshot):
        azimuth, elevation = np.radians(snapshot.get("direction", (30, 20)))
        self.flat = "direction" not in snapshot
        self.right = np.array([np.cos(azimuth), 0, -np.sin(azimuth)])
        self.towards = np.array(
            [
                np.sin(azimuth) * np.cos(elevation),
                np.sin(elevation),
                np.cos(azimuth) * np.cos(elevation),
            ]
        )
        self.up = np.cross(self.towards, self.right)

    def project(self, points):
        if self.flat:
            return points[..., :2], points[..., 2]
        return np.stack([points @ self.right, points @ self.up], axis=-1), points @ self.towards


def point_size(axes, spacing):
    """Area of a marker, in points squared, that fills the spacing of the particles."""
    box = axes.get_window_extent()
    points = box.width / axes.figure.dpi * 72 / np.ptp(axes.get_xlim())
    return max(0.3, (1.3 * spacing * points) ** 2)


def edges(corners):
    """The edges that only one cell has: a structure's outline."""
    n = corners.shape[1]
    pairs = np.concatenate([corners[:, [i, (i + 1) % n]] for i in range(n)])
    return pairs[met_once(pairs)]


def met_once(polygons):
    """Those that no second one has the same points as: the outside of a body."""
    _, index, count = np.unique(
        np.sort(polygons, axis=1), axis=0, return_index=True, return_counts=True
    )
    return index[count == 1]


def shaded(corners, view):
    """Grey, darker the more a face is turned away."""
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    light = 0.62 + 0.28 * np.abs(normals @ (view.towards + 0.6 * view.up)) / 1.17
    return np.stack([light, light, light + 0.02], axis=1)


def draw_structure(axes, frame, view, snapshot, colours):
    # Nodes that ranks share are there once for each; joined, or outlines would show the partition.
    _, first, joined = np.unique(frame.points, axis=0, return_index=True, return_inverse=True)
    cells = first[joined][frame.cells] if len(frame.cells) else frame.cells
    if cells.shape[1] == 8:
        cells = np.concatenate([cells[:, list(face)] for face in FACES])
        cells = cells[met_once(cells)]
    points, depth = view.project(frame.points)
    order = np.argsort(depth[cells].mean(axis=1))
    polygons = PolyCollection(points[cells[order]], zorder=3)
    if "structure colour" in snapshot:
        name = snapshot["structure colour"]
        scale = snapshot.get("structure scale", 1)
        if name in frame.cell_data and len(cells) == len(frame.cells):
            values = values_of(frame.cell_data, name, scale)
        else:
            values = values_of(frame.point_data, name, scale)[cells].mean(axis=1)
        polygons.set_array(values[order])
        polygons.set(cmap=snapshot.get("structure map", "magma"), edgecolor="face", linewidth=0.2, **colours)
    elif view.flat:
        line = "0.35" if snapshot.get("mesh") else "#c9cdd2"
        polygons.set(facecolor="#c9cdd2", edgecolor=line, linewidth=0.3)
    else:
        polygons.set(facecolor=shaded(frame.points[cells[order]], view), edgecolor="0.4", linewidth=0.3)
    axes.add_collection(polygons)
    # Where nodes hang, edges of elements would be taken for the outside.
    if view.flat and not snapshot.get("mesh"):
        outline = LineCollection(points[edges(cells)], colors="0.15", linewidths=0.9, zorder=4)
        axes.add_collection(outline)
    return polygons


def cut(frame, place):
    """Where the plane z = place cuts tetrahedra or hexahedra: polygons, and the cell of each."""
    cells, owner = frame.cells, np.arange(len(frame.cells))
    if cells.shape[1] == 8:
        cells = np.concatenate([cells[:, list(corners)] for corners in TETRAHEDRA])
        owner = np.tile(owner, len(TETRAHEDRA))
    height = frame.points[:, 2] - place
    above = height[cells] > 0
    polygons, cut_cells = [], []
    for c in np.flatnonzero(above.any(axis=1) & ~above.all(axis=1)):
        high, low = cells[c][above[c]], cells[c][~above[c]]
        # In this order the four crossings of two against two go around.
        pairs = [(a, b) for k, a in enumerate(high) for b in (low if k % 2 == 0 else low[::-1])]
        ends = np.array(pairs)
        share = height[ends[:, 0]] / (height[ends[:, 0]] - height[ends[:, 1]])
        crossings = frame.points[ends[:, 0]] + share[:, None] * (
            frame.points[ends[:, 1]] - frame.points[ends[:, 0]]
        )
        polygons.append(crossings[:, :2])
        cut_cells.append(owner[c])
    return polygons, np.array(cut_cells, dtype=int)


def draw_regions(axes, frame, cut_elements):
    """Rims of a fluid's regions; where a plane cuts them they are as structures."""
    regions = frame.cell_data.get("region", np.zeros(0))
    for region in np.unique(regions[regions > 0]):
        if cut_elements is None:
            rim = frame.points[edges(frame.cells[regions == region])][..., :2]
            axes.add_collection(LineCollection(rim, colors="0.9", linewidths=1.1, zorder=4))
        else:
            inside = [polygon for polygon, cell in zip(*cut_elements) if regions[cell] == region]
            axes.add_collection(PolyCollection(inside, facecolor="#c9cdd2", edgecolor="none", antialiaseds=False, zorder=3))


def draw_elements(axes, frame, snapshot):
    """Elements of a meshless fluid, or where a plane cuts them: what lies between points and what does not."""
    values = values_of(frame.point_data, snapshot["colour"], snapshot.get("scale", 1))
    if "cut" in snapshot:
        polygons, cells = cut(frame, snapshot["cut"])
    else:
        polygons, cells = frame.points[frame.cells][..., :2], slice(None)
    collection = PolyCollection(polygons, edgecolor="none", antialiaseds=False, zorder=2)
    collection.set_array(values[frame.cells].mean(axis=1)[cells])
    collection.set(cmap=snapshot.get("map", "viridis"), clim=snapshot.get("limits", (None, None)))
    draw_regions(axes, frame, (polygons, cells) if "cut" in snapshot else None)
    return axes.add_collection(collection)


def draw_cut_structure(axes, frame, snapshot):
    polygons, _ = cut(frame, snapshot["cut"])
    axes.add_collection(PolyCollection(polygons, facecolor="#c9cdd2", edgecolor="none", antialiaseds=False, zorder=3))


def draw_particles(axes, frame, view, snapshot):
    points, depth = view.project(frame.points)
    values = values_of(frame.point_data, snapshot["colour"], snapshot.get("scale", 1))
    order = np.argsort(depth, kind="stable")
    low, high = snapshot.get("limits", (None, None))
    return axes.scatter(
        points[order, 0],
        points[order, 1],
        c=values[order],
        cmap=snapshot.get("map", "viridis"),
        vmin=low,
        vmax=high,
        linewidths=0,
        antialiaseds=False,
        snap=False,
        zorder=2,
    )


def extent_of(frames, view):
    points = [view.project(frame.points)[0] for frame in frames if len(frame.points)]
    if not points:
        return [0.0, 1.0, 0.0, 1.0]
    points = np.concatenate(points)
    (x0, y0), (x1, y1) = points.min(axis=0), points.max(axis=0)
    margin = 0.03 * max(x1 - x0, y1 - y0)
    return [x0 - margin, x1 + margin, y0 - margin, y1 + margin]


def spacing_of(frame, dim):
    """Typical distance of particles, from the room they fill if they were evenly spread."""
    if "size" in frame.point_data and len(frame.points):
        return float(np.median(frame.point_data["size"]))
    size = np.ptp(frame.points, axis=0)[:dim] if len(frame.points) else np.ones(dim)
    return float((np.prod(size) / max(len(frame.points), 1)) ** (1 / dim))


def time_text(time):
    return f"{1000 * time:.4g} ms" if time < 1 else f"{time:.4g} s"


def picture(n_times, snapshot, box):
    """A figure with an axis for each time, as high as the box asks for."""
    n_columns = min(snapshot.get("columns", 2), n_times)
    n_rows = -(-n_times // n_columns)
    aspect = (box[3] - box[2]) / (box[1] - box[0])
    height = n_rows * (6.4 / n_columns * aspect + 0.45) + (0.3 if "title" in snapshot else 0)
    figure = Figure(figsize=(7.8, min(max(height, 2.2), 10)), layout="constrained")
    grid = figure.subplots(n_rows, n_columns, squeeze=False, sharex=True, sharey=True)
    for axes in grid.flat[n_times:]:
        axes.axis("off")
    return figure, grid


def label_axes(figure, grid, snapshot, view):
    if view.flat:
        for axes in grid[-1]:
            axes.set_xlabel("x [m]")
        for axes in grid[:, 0]:
            axes.set_ylabel("y [m]")
    else:
        for axes in grid.flat:
            axes.axis("off")
    if "title" in snapshot:
        figure.suptitle(snapshot["title"], fontsize=11)


def draw(snapshot, run):
    """One picture with an axis for each time, all with the same colours and view."""
    view = View(snapshot)
    particles, structures = snapshot.get("particles", []), snapshot.get("structures", [])
    fluids = [name + ".elements" for name in snapshot.get("elements", [])]
    frames = [
        {name: run.read(name, time) for name in particles + fluids + structures}
        for time in snapshot["times"]
    ]
    box = snapshot.get("view") or extent_of([f for frame in frames for f in frame.values()], view)
    figure, grid = picture(len(frames), snapshot, box)
    clim = snapshot.get("structure limits", (None, None))
    scatters, polygons = [], []
    for axes, frame in zip(grid.flat, frames):
        axes.set(xlim=box[:2], ylim=box[2:], aspect="equal")
        axes.set_title(f"t = {time_text(next(iter(frame.values())).time)}")
        axes.grid(False)
        for name in particles:
            scatter = draw_particles(axes, frame[name], view, snapshot)
            scatters.append((axes, scatter, spacing_of(frame[name], 2 if view.flat else 3)))
        meshes = [draw_elements(axes, frame[name], snapshot) for name in fluids]
        for name in structures if "cut" in snapshot else []:
            draw_cut_structure(axes, frame[name], snapshot)
        for name in structures if "cut" not in snapshot else []:
            polygons.append(draw_structure(axes, frame[name], view, snapshot, {"clim": clim}))

    bar = {"ax": grid, "shrink": 0.85, "aspect": 30}
    if scatters or meshes:
        figure.colorbar(scatters[0][1] if scatters else meshes[0], label=snapshot.get("label", snapshot["colour"]), **bar)
    if polygons and "structure colour" in snapshot:
        figure.colorbar(polygons[0], label=snapshot.get("structure label", ""), **bar)
    label_axes(figure, grid, snapshot, view)
    # Markers have a size on paper, known once everything has its place.
    figure.draw_without_rendering()
    for axes, scatter, spacing in scatters:
        scatter.set_sizes([point_size(axes, spacing)])
    return figure
