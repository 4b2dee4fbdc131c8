#include "ingest/vtk/vtk_marks.h"

#include "ingest/source_registry.h"
#include "ingest/vtk/vtk_legacy_source.h"
#include "ingest/vtk/vtk_xml_source.h"
#include "tests/ingest/vtk/vtk_xml_file.h"

namespace weir::vtk_marks_test {
namespace {

std::string numbers(std::size_t count, const std::string& value) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i) text += value + " ";
  return text;
}

std::string array(const std::string& name, const std::string& value, const std::string& more = "",
                  std::size_t count = 24) {
  return "<DataArray type=\"UInt8\" Name=\"" + name + "\" " + more + ">" + numbers(count, value) + "</DataArray>\n";
}

std::string points(const std::string& arrays) { return "<PointData>\n" + arrays + "</PointData>\n"; }

std::string range(const std::string& least, const std::string& most) {
  return "RangeMin=\"" + least + "\" RangeMax=\"" + most + "\"";
}

const std::string kNotApplied =
    ", which weir does not apply: their values count as data; write NaN there where they are none";

SourceOptions naming(const std::string& dataset) {
  SourceOptions options;
  options.dataset = dataset;
  return options;
}

class VtkMarks : public testing::Test {
 protected:
  std::string write(const std::string& arrays) const { return write_headed(scratch_, "a.vti", vti({}, arrays)); }
  SourceInfo info(const std::string& arrays, const SourceOptions& options = {}) const {
    return open_source(write(arrays), options)->info();
  }

  Scratch scratch_;
};

TEST_F(VtkMarks, GhostTypes_NeedNoChoice) {
  for (const std::string name : {"vtkGhostType", "vtkGhostLevels", "vtkValidPointMask"}) {
    const std::string arrays = points(array("a", "7") + array(name, "1"));
    EXPECT_EQ(info(arrays).dataset, "a");
    const auto marks = open_source(write(arrays), naming(name));
    EXPECT_EQ(marks->info().dataset, name);
    EXPECT_EQ(marks->info().details.values_note, "") << "they are what was asked for";
    EXPECT_EQ(read_volume(*marks), std::vector<float>(24, 1.0F));
    const auto listed = list_vtk_xml(write(arrays), {});
    EXPECT_FALSE(listed.at(0).by_name_only);
    EXPECT_TRUE(listed.at(1).by_name_only);
    EXPECT_EQ(listed.at(1).obstacle, "");
  }
}

TEST_F(VtkMarks, GhostTypesOfPointsAndCells_NeedNoChoice) {
  const std::string arrays = points(array("a", "7") + array("vtkGhostType", "1")) + "<CellData>" +
                             array("vtkGhostType", "32", "", 6) + "</CellData>";
  EXPECT_EQ(info(arrays).dataset, "a");
  EXPECT_EQ(info(arrays).details.values_note,
            "array 'PointData/vtkGhostType' may mark points as hidden or duplicate" + kNotApplied);
  EXPECT_EQ(info(arrays, naming("CellData/vtkGhostType")).extent, (Index3{3, 2, 1}));
}

TEST_F(VtkMarks, GhostTypesAlone_AreNotTaken) {
  const std::string path = write(points(array("vtkGhostType", "0")));
  EXPECT_EQ(message_of_error(ErrorKind::input, [&] { open_source(path, {}); }),
            path +
                ": holds no array that can be converted; 'vtkGhostType': it marks points or cells, and is converted "
                "only where it is named");
  // Ghost types do not take the place of vectors either: the error asks for a component of the vectors.
  const std::string vectors = write(points("<DataArray type=\"UInt8\" Name=\"v\" NumberOfComponents=\"3\">" +
                                           numbers(72, "2") + "</DataArray>" + array("vtkGhostType", "0")));
  EXPECT_EQ(message_of_error(ErrorKind::usage, [&] { open_source(vectors, {}); }),
            vectors + ": array 'v': has 3 components a voxel; give --component: 0 to 2, x, y, z or magnitude");
}

TEST_F(VtkMarks, MarksThatAreNotApplied_AreSaid) {
  const auto note = [&](const std::string& arrays) { return info(arrays, naming("a")).details.values_note; };
  EXPECT_EQ(note(points(array("a", "7"))), "");
  EXPECT_EQ(note(points(array("a", "7") + array("vtkGhostType", "0"))),
            "array 'vtkGhostType' may mark points as hidden or duplicate" + kNotApplied);
  EXPECT_EQ(note(points(array("a", "7") + array("vtkGhostType", "2", range("0", "2")))),
            "array 'vtkGhostType' marks points as hidden or duplicate" + kNotApplied);
  EXPECT_EQ(note(points(array("a", "7") + array("vtkGhostType", "0", range("0", "0")))), "") << "it marks none";
  EXPECT_EQ(note(points(array("a", "7") + array("vtkValidPointMask", "0", range("0", "1")))),
            "array 'vtkValidPointMask' marks points as without data" + kNotApplied);
  EXPECT_EQ(note(points(array("a", "7") + array("vtkValidPointMask", "1", range("1", "1")))), "") << "all are valid";
  EXPECT_EQ(
      note("<CellData>" + array("a", "7", "", 6) + array("vtkGhostType", "32", range("0", "32"), 6) + "</CellData>"),
      "array 'vtkGhostType' marks cells as hidden or duplicate" + kNotApplied);
  EXPECT_EQ(note(points(array("a", "7")) + "<CellData>" + array("vtkGhostType", "32", "", 6) + "</CellData>"), "")
      << "points of a hidden cell have values";
}

TEST_F(VtkMarks, GhostTypesOfLegacyFiles_NeedNoChoice_AndAreSaid) {
  const std::string text =
      "# vtk DataFile Version 3.0\na title\nASCII\nDATASET STRUCTURED_POINTS\n"
      "FIELD FieldData 1\nTimeValue 1 1 double\n1.5\nDIMENSIONS 4 3 2\nPOINT_DATA 24\n"
      "SCALARS vtkGhostType unsigned_char\nLOOKUP_TABLE default\n" +
      numbers(24, "2") + "\nSCALARS a float\nLOOKUP_TABLE default\n" + numbers(24, "7") + "\n";
  const std::string path = write_headed(scratch_, "a.vtk", text);
  const auto source = open_source(path, {});
  EXPECT_EQ(source->info().dataset, "a");
  EXPECT_EQ(source->info().details.values_note,
            "array 'vtkGhostType' may mark points as hidden or duplicate" + kNotApplied);
  ASSERT_TRUE(source->info().details.time);
  EXPECT_EQ(source->info().details.time->value, 1.5);
  EXPECT_EQ(source->info().details.time->units, "");
  EXPECT_EQ(read_volume(*source), std::vector<float>(24, 7.0F));
  EXPECT_EQ(read_volume(*open_source(path, naming("vtkGhostType"))), std::vector<float>(24, 2.0F));
  EXPECT_TRUE(list_vtk_legacy(path, {}).at(0).by_name_only);
}

}  // namespace
}  // namespace weir::vtk_marks_test
