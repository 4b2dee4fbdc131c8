// Checks that SourceInfo::origin is the world position of the centre of voxel 0,0,0, however a format states the place
// of its volume. Each test quotes the format's specification. The tests in hdf5/meaning check HDF5, NetCDF, openPMD and
// VTKHDF; those in vdb check OpenVDB.
#include "ingest/source_registry.h"
#include "tests/ingest/support/header_file.h"
#include "tests/ingest/support/nifti_file.h"
#include "tests/ingest/vtk/vtk_xml_file.h"

namespace weir::voxel_centre_test {
namespace {

using Place = std::array<double, 3>;

std::vector<std::uint8_t> values(std::size_t count) { return std::vector<std::uint8_t>(count, 1); }

/// Returns the world position of the centre of the first voxel in the file.
Place first_centre(const std::string& path, const SourceOptions& options = {}) {
  const SourceInfo info = open_source(path, options)->info();
  const Index3 first = info.index_origin;
  return {info.origin[0] + info.spacing[0] * static_cast<double>(first.x),
          info.origin[1] + info.spacing[1] * static_cast<double>(first.y),
          info.origin[2] + info.spacing[2] * static_cast<double>(first.z)};
}

Place nrrd_centre(const std::string& fields) {
  const Scratch scratch;
  return first_centre(write_headed(scratch, "a.nrrd",
                                   "NRRD0005\ntype: uchar\ndimension: 3\nsizes: 4 3 2\nencoding: raw\n" + fields + "\n",
                                   stored(values(24))));
}

Place meta_image_centre(const std::string& fields) {
  const Scratch scratch;
  return first_centre(write_headed(
      scratch, "a.mha", "NDims = 3\nDimSize = 4 3 2\nElementType = MET_UCHAR\n" + fields + "ElementDataFile = LOCAL\n",
      stored(values(24))));
}

Place nifti_centre(const NiftiBytes& header) {
  const Scratch scratch;
  return first_centre(write_headed(scratch, "a.nii", header.bytes(), stored(values(24))));
}

Place legacy_vtk_centre(const std::string& data) {
  const Scratch scratch;
  return first_centre(write_headed(scratch, "a.vtk",
                                   "# vtk DataFile Version 3.0\nby hand\nASCII\nDATASET STRUCTURED_POINTS\n"
                                   "DIMENSIONS 3 3 2\nSPACING 2 4 8\nORIGIN 10 20 30\n" +
                                       data));
}

// weir's own rule: --origin is the position of the centre of voxel 0,0,0, and --roi moves no voxel.
TEST(VoxelCentre, RawOriginOption_IsTheCentreOfVoxel0) {
  const Scratch scratch;
  const std::string path = scratch.write("a_4x3x2_uint8.raw", stored(values(24)));
  EXPECT_EQ(first_centre(path), (Place{0, 0, 0}));
  SourceOptions options;
  options.origin = Place{10, 20, 30};
  options.spacing = Place{2, 4, 8};
  EXPECT_EQ(first_centre(path, options), (Place{10, 20, 30}));
  options.roi = Box{{1, 1, 1}, {4, 3, 2}};
  EXPECT_EQ(first_centre(path, options), (Place{12, 24, 38}));
}

// teem.sourceforge.net/nrrd/format.html, "space origin": "the location of the center of the first (lowest memory
// address) sample". This holds for every centering.
TEST(VoxelCentre, NrrdSpaceOrigin_IsTheCentreOfTheFirstSample) {
  const std::string place = "space dimension: 3\nspace directions: (2,0,0) (0,4,0) (0,0,8)\nspace origin: (10,20,30)\n";
  EXPECT_EQ(nrrd_centre(place), (Place{10, 20, 30}));
  EXPECT_EQ(nrrd_centre(place + "centers: cell cell cell\n"), (Place{10, 20, 30}));
}

// teem.sourceforge.net/nrrd/format.html, "axis mins": with node centering, the position of the first sample. With cell
// centering, it is the lower border of the first sample's cell, half a spacing before the centre.
TEST(VoxelCentre, NrrdAxisMins_AreTheFirstSampleOfNodesAndTheBorderOfCells) {
  const std::string place = "spacings: 2 4 8\naxis mins: 10 20 30\n";
  EXPECT_EQ(nrrd_centre(place + "centers: node node node\n"), (Place{10, 20, 30}));
  EXPECT_EQ(nrrd_centre(place + "centers: cell cell cell\n"), (Place{11, 22, 34}));
}

// itk.org/Wiki/MetaIO/Documentation: Offset, Position and Origin are names of the same field. ITK, which defines the
// format: "the origin is the physical coordinates of the center of the first pixel".
TEST(VoxelCentre, MetaImageOffset_IsTheCentreOfTheFirstElement) {
  for (const std::string field : {"Offset", "Position", "Origin"}) {
    EXPECT_EQ(meta_image_centre("ElementSpacing = 2 4 8\n" + field + " = 10 20 30\n"), (Place{10, 20, 30})) << field;
  }
  EXPECT_EQ(meta_image_centre("ElementSpacing = 2 4 8\n"), (Place{0, 0, 0}));
}

// nifti1.h, "3D IMAGE (VOLUME) ORIENTATION AND LOCATION IN SPACE": "the (x,y,z) coordinates refer to the CENTER of a
// voxel". This holds for all three methods.
TEST(VoxelCentre, Nifti_PlacesCentresByEveryMethod) {
  NiftiBytes none(1);
  none.set_all<float>(76, {1, 2, 4, 8});
  EXPECT_EQ(nifti_centre(none), (Place{0, 0, 0}));
  NiftiBytes qform = none;
  qform.set<std::int16_t>(252, 1).set_all<float>(268, {10, 20, 30});
  EXPECT_EQ(nifti_centre(qform), (Place{10, 20, 30}));
  NiftiBytes sform = none;
  sform.set<std::int16_t>(254, 1).set_all<float>(280, {2, 0, 0, 10, 0, 4, 0, 20, 0, 0, 8, 30});
  EXPECT_EQ(nifti_centre(sform), (Place{10, 20, 30}));
}

// "VTK File Formats": ORIGIN is the position of the first point. CELL_DATA belongs to the cells between points; the
// centre of a cell lies half a spacing further.
TEST(VoxelCentre, VtkLegacy_PointsLieAtTheOriginAndCellsHalfASpacingOn) {
  const std::string scalars = "SCALARS a unsigned_char\nLOOKUP_TABLE default\n";
  EXPECT_EQ(legacy_vtk_centre("POINT_DATA 18\n" + scalars + "1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9\n"),
            (Place{10, 20, 30}));
  EXPECT_EQ(legacy_vtk_centre("CELL_DATA 4\n" + scalars + "1 2 3 4\n"), (Place{11, 22, 34}));
}

// "VTK File Formats": ImageData places points and cells as legacy files do.
// vtkImageData::TransformContinuousIndexToPhysicalPoint: Origin is the position of index 0,0,0, but an extent may begin
// at any index. Direction also turns the half spacing of cells.
TEST(VoxelCentre, VtkXml_PointsAndCellsOfExtentsThatBeginElsewhere) {
  const Scratch scratch;
  const auto centre = [&](const std::string& extent, const std::string& placement, const std::string& arrays) {
    return first_centre(write_headed(
        scratch, "a.vti",
        "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"" + extent +
            "\" Origin=\"10 20 30\" Spacing=\"2 4 8\"" + placement + "><Piece Extent=\"" + extent + "\">" + arrays +
            "</Piece></ImageData></VTKFile>\n"));
  };
  const std::string array = "<DataArray type=\"UInt8\" Name=\"a\" format=\"ascii\">";
  const std::string points = "<PointData>" + array + "1 2 3 4 5 6 7 8</DataArray></PointData>";
  const std::string cells = "<CellData>" + array + "1</DataArray></CellData>";
  EXPECT_EQ(centre("0 1 0 1 0 1", "", points), (Place{10, 20, 30}));
  EXPECT_EQ(centre("0 1 0 1 0 1", "", cells), (Place{11, 22, 34}));
  EXPECT_EQ(centre("5 6 0 1 -1 0", "", points), (Place{20, 20, 22}));
  EXPECT_EQ(centre("5 6 0 1 -1 0", "", cells), (Place{21, 22, 26}));
  // x runs along +y of the world, y along -x. The cell's centre is at (10 - 2, 20 + 1, 30 + 4) in the world. The result
  // has these numbers in the order of the volume's axes.
  EXPECT_EQ(centre("0 1 0 1 0 1", " Direction=\"0 -1 0 1 0 0 0 0 1\"", cells), (Place{21, 8, 34}));
}

}  // namespace
}  // namespace weir::voxel_centre_test
