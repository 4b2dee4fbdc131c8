#include "ingest/vtk/vtk_legacy_source.h"

#include <utility>

#include "format/base/text.h"
#include "format/io/file_system.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/named_choice.h"
#include "ingest/streams/file_stream.h"
#include "ingest/streams/spool_file.h"
#include "ingest/values/raw_values.h"
#include "ingest/vtk/text_values.h"
#include "ingest/vtk/vtk_legacy_header.h"
#include "ingest/vtk/vtk_marks.h"

namespace weir {
namespace {

VtkLegacyHeader read_legacy_header(InputFile& file) {
  FileStream stream(file);
  return parse_vtk_legacy_header(stream, file.size(), file.path());
}

// `bytes` is the size of all values.
std::unique_ptr<InputFile> spool_text(InputFile& file, const VtkLegacyArray& array, std::uint64_t bytes,
                                      const SourceOptions& options, const std::string& where) {
  const auto files = make_posix_file_system();
  SpoolFile spool(*files, options, file.path(), bytes);
  FileText text(file, array.offset, file.size());
  if (array.fractions) {
    spool_text_fractions(text, bytes, spool, where);
  } else {
    spool_text_values(text, bytes / scalar_bytes(array.type), array.type, false, spool, where);
  }
  return spool.finish();
}

}  // namespace

bool recognises_vtk_legacy(std::string_view path, std::span<const std::byte> head) {
  const std::string_view begin(reinterpret_cast<const char*>(head.data()), head.size());
  return lower_case(begin).starts_with("# vtk datafile") || ends_with_one_of(path, kVtkLegacyEndings);
}

std::unique_ptr<VolumeSource> open_vtk_legacy(const std::string& path, const SourceOptions& options) {
  refuse_index(path, options);
  auto file = std::make_unique<InputFile>(path, options.direct_io);
  const VtkLegacyHeader header = read_legacy_header(*file);
  const std::vector<NamedVolume> volumes = vtk_volumes(header.arrays, options);
  const VtkLegacyArray& array = header.arrays[choose_volume(path, "array", volumes, options.dataset)];
  say_vtk_left_out(path, header.arrays, array, options);
  VtkVolume volume = vtk_volume(*file, "vtk-legacy", header.image, array, options);
  if (header.time) volume.info.details.time = TimePoint{*header.time, {}, {}};
  volume.info.details.values_note = marks_note_of(array, header.arrays);
  RawLayout layout{header.binary ? array.offset : 0, array.type, header.binary, {}, volume.components};
  options.complete(layout.mapping);
  if (!header.binary) file = spool_text(*file, array, volume.bytes, options, volume.where);
  return make_raw_values(std::move(file), layout, std::move(volume.info));
}

std::vector<DatasetInfo> list_vtk_legacy(const std::string& path, const SourceOptions&) {
  InputFile file(path, DirectIo::off);
  const VtkLegacyHeader header = read_legacy_header(file);
  std::vector<DatasetInfo> list;
  for (const VtkLegacyArray& array : header.arrays) {
    DatasetInfo info;
    info.name = array.name;
    info.type = array.type_name;
    info.layout = header.binary ? "contiguous" : "text";
    info.components = array.components;
    info.obstacle = array.obstacle;
    info.by_name_only = marks_places(array);
    if (info.obstacle.empty()) {
      info.type = cat(header.binary && scalar_bytes(array.type) > 1 ? "big-endian " : "", scalar_name(array.type));
    }
    describe_vtk_image(header.image, array.cells, path, info);
    list.push_back(std::move(info));
  }
  return list;
}

}  // namespace weir
