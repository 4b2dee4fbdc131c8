#include "ingest/vtk/vtk_xml_source.h"

#include <algorithm>
#include <utility>

#include "format/base/text.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/named_choice.h"
#include "ingest/values/raw_values.h"
#include "ingest/vtk/file_text.h"
#include "ingest/vtk/vtk_marks.h"
#include "ingest/vtk/vtk_xml_data.h"
#include "ingest/vtk/vtk_xml_header.h"
#include "ingest/vtk/vtk_xml_skeleton.h"
#include "ingest/vtk/vtk_xml_time.h"

namespace weir {
namespace {

VtkXmlHeader read_xml_header(InputFile& file) {
  VtkXmlSkeleton skeleton(file.path());
  FileText text(file, 0, file.size());
  for (auto piece = text.next_piece(); !piece.empty() && skeleton.push(piece); piece = text.next_piece()) continue;
  return parse_vtk_xml_header(skeleton, file.path());
}

const VtkXmlArray& choose_array(const VtkXmlHeader& header, const std::string& path, const SourceOptions& options) {
  const std::string& wanted = options.dataset;
  const std::vector<NamedVolume> volumes = vtk_volumes(header.arrays, options);
  const auto usable = [](const NamedVolume& array) { return array.obstacle.empty(); };
  const bool marked = std::any_of(volumes.begin(), volumes.end(), [&](const NamedVolume& array) {
    return usable(array) && array.name == header.scalars;
  });
  const bool several = std::count_if(volumes.begin(), volumes.end(), usable) > 1;
  const std::string& name = wanted.empty() && several && marked ? header.scalars : wanted;
  return header.arrays[choose_volume(path, "array", volumes, name)];
}

std::string layout_text(const VtkXmlHeader& header, const VtkXmlArray& array) {
  switch (array.format) {
    case VtkXmlArray::Format::ascii:
      return "text";
    case VtkXmlArray::Format::binary:
      return header.zlib ? "base64, zlib blocks" : "base64";
    case VtkXmlArray::Format::appended:
      break;
  }
  return cat(header.appended_base64 ? "appended base64" : "appended", header.zlib ? ", zlib blocks" : "");
}

}  // namespace

bool recognises_vtk_xml(std::string_view path, std::span<const std::byte> head) {
  const std::string_view begin(reinterpret_cast<const char*>(head.data()), head.size());
  return begin.starts_with("<VTKFile") || ends_with_one_of(path, kVtkXmlEndings);
}

std::unique_ptr<VolumeSource> open_vtk_xml(const std::string& path, const SourceOptions& options) {
  refuse_index(path, options);
  auto file = std::make_unique<InputFile>(path, options.direct_io);
  const VtkXmlHeader header = read_xml_header(*file);
  const VtkXmlArray& array = choose_array(header, path, options);
  say_vtk_left_out(path, header.arrays, array, options);
  VtkVolume volume = vtk_volume(*file, "vtk-xml", header.image, array, options);
  volume.info.details.time = vtk_xml_time(*file, header, options);
  volume.info.details.values_note = marks_note_of(array, header.arrays);
  PlainValues plain = plain_vtk_values(std::move(file), header, array, volume.bytes, options, volume.where);
  RawLayout layout{plain.offset, array.type, plain.big_endian, {}, volume.components};
  options.complete(layout.mapping);
  return make_raw_values(std::move(plain.file), layout, std::move(volume.info));
}

std::vector<DatasetInfo> list_vtk_xml(const std::string& path, const SourceOptions&) {
  InputFile file(path, DirectIo::off);
  const VtkXmlHeader header = read_xml_header(file);
  std::vector<DatasetInfo> list;
  for (const VtkXmlArray& array : header.arrays) {
    DatasetInfo info;
    info.name = array.name;
    info.type = array.type_name;
    info.layout = layout_text(header, array);
    info.components = array.components;
    info.obstacle = array.obstacle;
    info.by_name_only = marks_places(array);
    if (info.obstacle.empty()) {
      const bool swapped =
          header.big_endian && scalar_bytes(array.type) > 1 && array.format != VtkXmlArray::Format::ascii;
      info.type = cat(swapped ? "big-endian " : "", scalar_name(array.type));
    }
    describe_vtk_image(header.image, array.cells, path, info);
    if (array.name == header.scalars) info.attributes.emplace_back("marked as", "scalars");
    list.push_back(std::move(info));
  }
  return list;
}

}  // namespace weir
