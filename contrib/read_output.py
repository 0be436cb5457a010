# SPDX-License-Identifier: GPL-3.0-or-later
"""Read what a run wrote: statistics.csv, particles, structures and the octree, as numpy arrays.

    from read_output import Output
    output = Output("output/water_entry")
    output.statistics["wedge.velocity.y [m/s]"]
    water = output.read("water", time=0.01)       # nearest output time
    water.points, water.point_data["pressure"]

Needs python3-vtk9 and python3-h5py.
"""
import csv
import pathlib
import xml.etree.ElementTree as xml

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPUnstructuredGridReader, vtkXMLUnstructuredGridReader


class Frame:
    """One body at one time: points (n, 3), dictionaries of arrays, and the points of each cell."""

    def __init__(self, time, points, point_data, cell_data, cells):
        self.time = time
        self.points = points
        self.point_data = point_data
        self.cell_data = cell_data
        self.cells = cells


def arrays(data):
    names = [data.GetArrayName(i) for i in range(data.GetNumberOfArrays())]
    return {name: vtk_to_numpy(data.GetArray(name)) for name in names}


class VtuSeries:
    """A .pvd file."""

    def __init__(self, file):
        entries = xml.parse(file).getroot().iter("DataSet")
        self.entries = [(float(e.get("timestep")), file.parent / e.get("file")) for e in entries]
        self.times = [time for time, _ in self.entries]

    def read(self, index):
        time, file = self.entries[index]
        parallel = file.suffix == ".pvtu"
        reader = vtkXMLPUnstructuredGridReader() if parallel else vtkXMLUnstructuredGridReader()
        reader.SetFileName(str(file))
        reader.Update()
        grid = reader.GetOutput()
        if reader.GetErrorCode():
            raise OSError(f"{file} can't be read")
        points, cells = np.zeros((0, 3)), np.zeros((0, 1), dtype=int)
        if grid.GetNumberOfPoints():
            points = vtk_to_numpy(grid.GetPoints().GetData())
        if grid.GetNumberOfCells():
            # All cells of one file have as many points.
            connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
            cells = connectivity.reshape(grid.GetNumberOfCells(), -1)
        return Frame(time, points, arrays(grid.GetPointData()), arrays(grid.GetCellData()), cells)


class XdmfSeries:
    """An .xdmf file of particles: each data item refers to a dataset as FILE:/DATASET."""

    def __init__(self, file):
        self.folder = file.parent
        self.grids = xml.parse(file).getroot().findall("./Domain/Grid/Grid")
        self.times = [float(grid.find("Time").get("Value")) for grid in self.grids]

    def load(self, item):
        shape = tuple(int(n) for n in item.get("Dimensions").split())
        file, dataset = item.text.strip().rsplit(":", 1)
        with h5py.File(self.folder / file, "r") as data:
            values = data[dataset]
            if values.dtype.itemsize != int(item.get("Precision")):
                raise ValueError(f"{item.text}: precision differs from the file's")
            return values[...].reshape(shape)

    def read(self, index):
        grid = self.grids[index]
        points = self.load(grid.find("Geometry/DataItem"))
        if len(points) != int(grid.find("Topology").get("NumberOfElements")):
            raise ValueError("numbers of points and of cells differ")
        data = {a.get("Name"): self.load(a.find("DataItem")) for a in grid.findall("Attribute")}
        cells = self.load(grid.find("Topology/DataItem"))
        return Frame(self.times[index], points, data, {}, cells)


class Output:
    """A run's output folder."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        if not self.folder.is_dir():
            raise FileNotFoundError(f"there is no output folder '{folder}'")
        self.series = {}
        for file in sorted(self.folder.glob("*.xdmf")):
            self.series[file.stem] = XdmfSeries(file)
        for file in sorted(self.folder.glob("*.pvd")):
            self.series.setdefault(file.stem, VtuSeries(file))
        self._statistics = None

    @property
    def statistics(self):
        """Columns of statistics.csv by their titles."""
        if self._statistics is None:
            with open(self.folder / "statistics.csv", newline="", encoding="utf-8") as file:
                rows = list(csv.reader(file))
            values = np.array(rows[1:], dtype=float).reshape(len(rows) - 1, len(rows[0]))
            self._statistics = {title: values[:, c] for c, title in enumerate(rows[0])}
        return self._statistics

    def read(self, name, time):
        """The frame of a body (or of "octree") whose time is nearest."""
        series = self.series[name]
        return series.read(int(np.argmin(np.abs(np.array(series.times) - time))))
