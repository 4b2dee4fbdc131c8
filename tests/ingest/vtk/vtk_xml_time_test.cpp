#include "ingest/vtk/vtk_xml_time.h"

#include "ingest/source_registry.h"
#include "tests/ingest/vtk/vtk_xml_file.h"

namespace weir::vtk_xml_time_test {
namespace {

const std::string kValues =
    "<PointData><DataArray type=\"UInt8\" Name=\"a\">0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 "
    "17 18 19 20 21 22 23</DataArray></PointData>";

/// Returns a file of text values with `array` in its field data.
std::string with_field(const VtiStorage& storage, const std::string& array, const std::string& appended = "") {
  std::string text = vti(storage, kValues, appended);
  return text.insert(text.find("<Piece"), "<FieldData>\n" + array + "</FieldData>\n");
}

std::string time_array(const std::string& attributes, const std::string& text = "") {
  return "<DataArray Name=\"TimeValue\" NumberOfTuples=\"1\" " + attributes + ">" + text + "</DataArray>\n";
}

std::optional<TimePoint> time_of(const std::string& content, std::string* notice = nullptr) {
  const Scratch scratch;
  SourceOptions options;
  options.notice = [&](const Message& line) {
    if (notice != nullptr) *notice = line.text().substr(scratch.path("").size());
  };
  return open_source(write_headed(scratch, "a.vti", content), options)->info().details.time;
}

TEST(VtkXmlTime, TimeValue_InEveryForm_IsTheTimeOfTheVolume) {
  for (const bool big : {false, true}) {
    for (const bool wide : {false, true}) {
      for (const std::size_t block : {std::size_t{0}, std::size_t{4}, std::size_t{4096}}) {
        SCOPED_TRACE(testing::Message() << big << wide << block);
        const VtiStorage storage{big, wide, block};
        const VtiData data = vti_data(stored(std::vector<double>{0.1}, big), storage);
        const std::string type = "type=\"Float64\" ";
        const std::string offset = "format=\"appended\" offset=\"3\"";
        for (const std::string& file :
             {with_field(storage, time_array(type + "format=\"binary\"", "\n  " + data.text(storage) + "\n")),
              with_field(storage, time_array(type + offset),
                         "<AppendedData encoding=\"raw\">_<\"_" + chars(data.raw()) + "</AppendedData>\n"),
              with_field(storage, time_array(type + "format=\"appended\" offset=\"4\""),
                         "<AppendedData encoding=\"base64\">_AAAA" + data.text(storage) + "</AppendedData>\n")}) {
          const auto time = time_of(file);
          ASSERT_TRUE(time) << file;
          EXPECT_EQ(time->value, 0.1);
          EXPECT_EQ(time->units, "") << "VTK says none";
        }
      }
    }
  }
  EXPECT_EQ(time_of(with_field({}, time_array("type=\"Float64\" format=\"ascii\"", "\n  1.5 \n")))->value, 1.5);
  EXPECT_EQ(time_of(with_field({}, time_array("type=\"Int32\"", "-7")))->value, -7);
}

TEST(VtkXmlTime, OtherFieldData_AreNoTime) {
  EXPECT_FALSE(time_of(vti({}, kValues)));
  const std::string cycle = "<DataArray type=\"Int32\" Name=\"CYCLE\" NumberOfTuples=\"1\">4</DataArray>";
  EXPECT_FALSE(time_of(with_field({}, cycle)));
  EXPECT_EQ(time_of(with_field({}, cycle + time_array("type=\"Float32\"", "0.5")))->value, 0.5);
  EXPECT_FALSE(
      time_of(with_field({}, "<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"2\">1 2</DataArray>")));
  EXPECT_FALSE(time_of(with_field({}, time_array("type=\"Float64\"", "nan"))));
}

// The volume stays readable if its time is damaged.
TEST(VtkXmlTime, TimeThatCannotBeRead_IsLeftOut_AndSaid) {
  const auto said = [](const std::string& content) {
    std::string notice;
    EXPECT_FALSE(time_of(content, &notice));
    return notice;
  };
  const std::string where = "a.vti: array 'TimeValue' of its field data: ";
  const std::string rest = ": the volume's time is left out";
  EXPECT_EQ(said(with_field({}, time_array("type=\"Float64\"", "soon"))),
            where + "its text is 'soon', not one number" + rest);
  EXPECT_EQ(said(with_field({}, time_array("type=\"Float64\"", "1" + std::string(4096, ' ')))),
            where + "its text has 4097 characters, and at most 4096 are read for one number" + rest);
  EXPECT_EQ(said(with_field({}, time_array("type=\"String\"", "49 0"))),
            where + "its type is 'String', and Int8 to Float64 can be read" + rest);
  EXPECT_EQ(said(with_field({}, time_array("type=\"Float64\" format=\"zipped\"", "1"))),
            "a.vti: format of DataArray is 'zipped'; ascii, binary or appended" + rest);
  const VtiStorage storage;
  const auto binary = [&](const VtiData& data) {
    return with_field(storage, time_array("type=\"Float64\" format=\"binary\"", data.text(storage)));
  };
  EXPECT_EQ(said(binary(vti_data(stored(std::vector<float>{1}), storage))),
            where + "holds 4 bytes, and its header asks for 8; one of the two is damaged" + rest);
  EXPECT_EQ(said(binary({storage.words({8}), {}})),
            where + "its base64 text ends too early; the file is cut or damaged" + rest);
}

}  // namespace
}  // namespace weir::vtk_xml_time_test
