"""Reads NanoVDB files as images: a reader for ParaView (Tools > Manage Plugins > Load New...) and a source for VTK.

    from weir_reader import WeirReader        # without ParaView, like any vtkAlgorithm
    reader = WeirReader()
    reader.SetFileName("density.nvdb")
    reader.SetLevel(2)
    reader.Update()
    image = reader.GetOutputDataObject(0)     # vtkImageData

The point data has the grid's values, float32, under the grid's name. Each voxel is a point. The voxel that has the
index (i, j, k) in the file lies at the file's origin + spacing * (i, j, k). The image's extent counts from 0, the
lowest voxel. At level n a point is the mean of a cube of 2^n voxels along an edge and lies in the cube's middle; the
spacing is 2^n times the file's. At the upper ends of the axes the mean is over the voxels that exist. Only the
requested extent is decoded. At a level, only some rows of finer voxels are held at a time, so that a level of a file
larger than memory can be opened. If the file has a sidecar, the field data has the sidecar's certificate: "weir_rmse"
and "weir_max_abs" in the values' own unit and, if anything was lost, "weir_psnr_db".

Several files of one extent are the steps of a series, at the times 0, 1, 2, ...

If a file was replaced or written to since it was read, the next update opens it again. reader.Modified() makes an
update due.
"""

import os

import weir
from vtkmodules.util.numpy_support import numpy_to_vtk
from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
from vtkmodules.vtkCommonCore import VTK_FLOAT, vtkDoubleArray, vtkOutputWindow
from vtkmodules.vtkCommonDataModel import vtkDataObject, vtkImageData
from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline as Pipeline

try:
    from paraview.util.vtkAlgorithm import smdomain, smhint, smproperty, smproxy
except ImportError:

    class _NoProxies:
        """Replaces ParaView's decorators. Leaves the decorated class or function as it is."""

        def __getattr__(self, name):
            return lambda *arguments, **keywords: lambda decorated: decorated

    smdomain = smhint = smproperty = smproxy = _NoProxies()


def _version(path):
    """Returns what distinguishes the file at `path` from a later file there. None for a URL or a missing file."""
    try:
        status = os.stat(path)
    except (OSError, ValueError):  # ValueError is raised for a null byte
        return None
    return status.st_dev, status.st_ino, status.st_size, status.st_mtime_ns


@smproxy.reader(
    name="WeirReader", label="Weir Reader", extensions="nvdb", file_description="NanoVDB volumes"
)
class WeirReader(VTKPythonAlgorithmBase):
    """Reads one .nvdb file or a series of .nvdb files. Reads the first grid of each file."""

    def __init__(self):
        super().__init__(nInputPorts=0, nOutputPorts=1, outputType="vtkImageData")
        self._paths = []
        self._level = 0
        self._step = 0
        self._grid = None  # the Grid of self._step
        self._version = None  # the _version() of that grid's file

    @smproperty.stringvector(
        name="FileNames",
        command="AddFileName",
        clean_command="ClearFileNames",
        repeat_command="1",
        number_of_elements="1",
        panel_visibility="never",
    )
    @smdomain.filelist()
    @smhint.filechooser(extensions="nvdb", file_description="NanoVDB volumes")
    def AddFileName(self, path):
        """Adds the file of the next step. The file is mapped when it is first needed."""
        if path not in (None, "None"):  # ParaView passes the text "None" for no file
            self._paths.append(path)
            self._grid = None
            self.Modified()

    def ClearFileNames(self):
        self._paths = []
        self._grid = None
        self.Modified()

    def SetFileName(self, path):
        """Sets the only file to read."""
        if [path] != self._paths:
            self.ClearFileNames()
            self.AddFileName(path)

    def GetFileNames(self):
        return list(self._paths)

    @smproperty.doublevector(name="TimestepValues", information_only="1", si_class="vtkSITimeStepsProperty")
    def GetTimestepValues(self):
        """Returns the times of a series, or None for a single file."""
        return [float(step) for step in range(len(self._paths))] if len(self._paths) > 1 else None

    @smproperty.intvector(name="Level", default_values=0)
    @smdomain.intrange(min=0, max=12)
    def SetLevel(self, level):
        """Sets the level of detail. 0 is every voxel. Each further level halves the voxels along each axis, down to a
        single point."""
        if level < 0:
            raise ValueError(f"level is {level}, it must be 0 or more")
        if level != self._level:
            self._level = level
            self.Modified()

    def GetLevel(self):
        return self._level

    def RequestInformation(self, request, inputs, outputs):
        return self._answer(self._describe, outputs.GetInformationObject(0))

    def RequestData(self, request, inputs, outputs):
        return self._answer(self._read, outputs.GetInformationObject(0))

    def _answer(self, work, information):
        """Opens the file and does `work`. Returns 1, or 0 after showing an error message of one line."""
        try:
            if not self._paths:
                raise weir.UsageError("no file is named; call SetFileName")
            self._open(information)
            work(information)
        except weir.Error as error:
            vtkOutputWindow.GetInstance().DisplayErrorText(f"WeirReader: {error}\n")
            return 0
        return 1

    def _open(self, information):
        """Opens the grid of the requested time, which is the last step at or before that time."""
        time = information.Get(Pipeline.UPDATE_TIME_STEP()) if information.Has(Pipeline.UPDATE_TIME_STEP()) else 0
        step = min(max(int(time), 0), len(self._paths) - 1)
        version = _version(self._paths[step])
        if self._grid is None or step != self._step or version != self._version:
            self._grid = weir.open(self._paths[step])
            self._step = step
            self._version = version

    def _level_there_is(self):
        return min(self._level, self._grid.levels - 1)

    def _placement(self):
        """Returns the spacing of the level's points and the position of the point with index (0, 0, 0)."""
        edge = 2 ** self._level_there_is()
        grid = self._grid
        origin = [
            origin + spacing * (index + (edge - 1) / 2)
            for origin, spacing, index in zip(grid.origin, grid.spacing, grid.index_origin)
        ]
        return [spacing * edge for spacing in grid.spacing], origin

    def _describe(self, information):
        z, y, x = self._grid.level_shape(self._level_there_is())
        spacing, origin = self._placement()
        information.Set(Pipeline.WHOLE_EXTENT(), (0, x - 1, 0, y - 1, 0, z - 1), 6)
        information.Set(vtkDataObject.SPACING(), spacing, 3)
        information.Set(vtkDataObject.ORIGIN(), origin, 3)
        information.Set(self.CAN_PRODUCE_SUB_EXTENT(), 1)
        vtkDataObject.SetPointDataActiveScalarInfo(information, VTK_FLOAT, 1)
        times = self.GetTimestepValues()
        if times:
            information.Set(Pipeline.TIME_STEPS(), times, len(times))
            information.Set(Pipeline.TIME_RANGE(), [times[0], times[-1]], 2)

    def _certificate(self):
        try:
            return self._grid.certificate or {}
        except weir.InputError as error:  # the values can be read without the certificate
            vtkOutputWindow.GetInstance().DisplayWarningText(f"{error}\n")
            return {}

    def _read(self, information):
        whole = information.Get(Pipeline.WHOLE_EXTENT())[1::2]
        there = [points - 1 for points in self._grid.level_shape(self._level_there_is())[::-1]]
        if there != list(whole):  # VTK fixes the extent before it asks for a time, so the steps must have one extent
            raise weir.InputError(f"{self._grid.path}: is not of the extent that the series began with; read it alone")
        x0, x1, y0, y1, z0, z1 = extent = information.Get(Pipeline.UPDATE_EXTENT())
        image = vtkImageData.GetData(information)
        spacing, origin = self._placement()
        image.SetExtent(extent)
        image.SetSpacing(spacing)
        image.SetOrigin(origin)
        if len(self._paths) > 1:
            image.GetInformation().Set(vtkDataObject.DATA_TIME_STEP(), float(self._step))
        if x1 >= x0 and y1 >= y0 and z1 >= z0:
            box = (x0, y0, z0), (x1 + 1, y1 + 1, z1 + 1)
            values = numpy_to_vtk(self._grid.to_numpy(box, self._level_there_is()).reshape(-1))
            values.SetName(self._grid.name or "values")
            image.GetPointData().SetScalars(values)
        for name, value in self._certificate().items():
            if name in ("rmse", "max_abs", "psnr_db") and value is not None:
                figure = vtkDoubleArray()
                figure.SetName(f"weir_{name}")
                figure.InsertNextValue(value)
                image.GetFieldData().AddArray(figure)
