#include "ingest/headers/header_volume.h"

#include <algorithm>
#include <limits>
#include <span>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/file_states.h"
#include "ingest/headers/header_text.h"
#include "ingest/source/extent.h"
#include "ingest/streams/spool_inflated.h"
#include "ingest/values/axis_placement.h"
#include "ingest/values/raw_values.h"

namespace weir {
namespace {

std::string extents_text(std::span<const std::int64_t> extents) {
  std::string text;
  for (const std::int64_t extent : extents) text += cat(text.empty() ? "" : "x", extent);
  return text;
}

/// Returns the extents of the axes after the third, which choose one of several volumes; slowest first, as in
/// --index.
std::vector<std::int64_t> leading_extents(const HeaderVolume& volume) {
  const auto& extents = volume.extents;
  return {extents.rbegin(), extents.rend() - std::min<std::ptrdiff_t>(3, std::ssize(extents))};
}

bool must_choose(std::span<const std::int64_t> leading) {
  return std::any_of(leading.begin(), leading.end(), [](std::int64_t extent) { return extent > 1; });
}

/// Returns the position of the chosen volume among all, in the file's order.
std::uint64_t chosen_volume(const std::string& path, std::span<const std::int64_t> leading,
                            std::span<const std::int64_t> index) {
  if (index.empty() && !must_choose(leading)) return 0;
  if (index.size() != leading.size()) {
    throw Error(ErrorKind::usage,
                leading.empty() ? compose(path, ": ", option("index"),
                                          " chooses along the axes after the third, and there is none; leave it out")
                                : compose(path, ": axes after the third have the extents ", extents_text(leading),
                                          " (slowest first); give ", option("index"), " with ", leading.size(),
                                          leading.size() == 1 ? " position" : " positions"));
  }
  std::uint64_t position = 0;
  for (std::size_t a = 0; a < leading.size(); ++a) {
    if (index[a] < 0 || index[a] >= leading[a]) {
      throw Error(ErrorKind::usage, compose(path, ": ", option("index", index[a]),
                                            " is outside its axis, which has the positions 0 to ", leading[a] - 1));
    }
    position = position * static_cast<std::uint64_t>(leading[a]) + static_cast<std::uint64_t>(index[a]);
  }
  return position;
}

struct Shape {
  Index3 extent{1, 1, 1};
  std::vector<std::int64_t> leading;
  std::uint64_t volume_bytes = 0;
  std::uint64_t all_bytes = 0;  ///< of all volumes
};

Shape checked_shape(const HeaderVolume& volume) {
  Shape shape;
  const auto extent = [&](std::size_t axis) { return axis < volume.extents.size() ? volume.extents[axis] : 1; };
  shape.extent = {extent(0), extent(1), extent(2)};
  shape.leading = leading_extents(volume);
  shape.volume_bytes = checked_volume_bytes(shape.extent, scalar_bytes(volume.type), volume.info.path);
  auto bytes = static_cast<std::int64_t>(shape.volume_bytes);
  for (const std::int64_t count : shape.leading) {
    if (count < 1 || __builtin_mul_overflow(bytes, count, &bytes)) {
      throw Error(ErrorKind::input,
                  cat(volume.info.path, ": extents ", extents_text(volume.extents), " of ", scalar_name(volume.type),
                      " are impossible: each must be at least 1 and all "
                      "bytes fit 63 bits"));
    }
  }
  shape.all_bytes = static_cast<std::uint64_t>(bytes);
  return shape;
}

// Most bytes after a header's own values that may be padding up to a block.
constexpr std::uint64_t kMostPadding = 4096;

/// Returns the offset of plain values in the data file.
std::uint64_t plain_offset(const HeaderVolume& volume, const Shape& shape, std::uint64_t file_bytes) {
  const bool attached = volume.data_path == volume.info.path;
  const std::uint64_t room = file_bytes - std::min(volume.data_offset, file_bytes);
  // Another data file may serve several headers. After a header's own values, writers leave a line end or fill up a
  // block, which the formats' own readers ignore. More bytes mean that the header describes the volume wrongly.
  const auto plane_bytes = shape.volume_bytes / static_cast<std::uint64_t>(shape.extent.z);
  const std::uint64_t most = volume.ends_file ? 0 : std::min(plane_bytes - 1, kMostPadding);
  const bool fits = room >= shape.all_bytes && (volume.at_end || !attached || room - shape.all_bytes <= most);
  if (!fits) {
    throw Error(ErrorKind::input,
                cat(volume.data_path, ": has ", room, " bytes from offset ", volume.data_offset, " on, and ",
                    attached ? "its header" : volume.info.path, " asks for ", extents_text(volume.extents), ' ',
                    scalar_name(volume.type), ", ", shape.all_bytes, " bytes; ",
                    room < shape.all_bytes ? "the file is cut or the header wrong"
                    : volume.ends_file     ? "something else comes before the values, and the header is wrong"
                                           : "the header is wrong"));
  }
  return volume.at_end ? file_bytes - shape.all_bytes : volume.data_offset;
}

/// Returns a note if the data file has bytes that the header does not describe: the values may lie elsewhere in it.
std::string data_note(const HeaderVolume& volume, const Shape& shape, std::uint64_t file_bytes) {
  if (volume.packed || volume.at_end || file_bytes - volume.data_offset == shape.all_bytes) return "";
  const bool attached = volume.data_path == volume.info.path;
  return cat(attached ? "the file" : cat("its data file ", volume.data_path), " has ", file_bytes, " bytes, and ",
             shape.all_bytes, " of them, from byte ", volume.data_offset,
             " on, are what the header describes; where the values begin ", "elsewhere, correct ", volume.offset_key);
}

/// Returns the place of the compressed stream in the data file.
PackedRange packed_range(const HeaderVolume& volume, std::uint64_t file_bytes) {
  const std::uint64_t room = file_bytes - std::min(volume.data_offset, file_bytes);
  if (room == 0 || volume.packed_bytes > room) {
    throw Error(ErrorKind::input,
                cat(volume.data_path, ": has ", room, " bytes from offset ", volume.data_offset, " on, and ",
                    std::max<std::uint64_t>(volume.packed_bytes, 1), " compressed ones belong there; the file is cut"));
  }
  return {volume.data_offset, volume.packed_bytes == 0 ? room : volume.packed_bytes};
}

UnpackedRange unpacked_range(const HeaderVolume& volume, const Shape& shape, std::uint64_t position) {
  constexpr auto kLargest = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (volume.packed_offset > kLargest - shape.all_bytes) {
    throw Error(ErrorKind::input, cat(volume.info.path, ": values at byte ", volume.packed_offset,
                                      " of the unpacked data are impossible; the header is damaged"));
  }
  return {volume.packed_offset + position * shape.volume_bytes, shape.volume_bytes,
          volume.packed_offset + shape.all_bytes};
}

}  // namespace

std::unique_ptr<InputFile> open_data_file(const HeaderVolume& volume, DirectIo mode) {
  const std::string& name = volume.data_path;
  if (name == volume.info.path) return std::make_unique<InputFile>(name, mode);
  if (std::any_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; })) {
    throw Error(ErrorKind::input,
                cat(volume.info.path, ": its data file ", in_quotes(name), " has control characters in its name"));
  }
  try {
    return std::make_unique<InputFile>(name, mode);
  } catch (const Error& error) {
    throw Error(error.kind(), compose(volume.info.path, ": its data file ", error.message()), error.system_failure());
  }
}

std::unique_ptr<VolumeSource> open_header_volume(const HeaderVolume& volume, const SourceOptions& options) {
  if (!options.dataset.empty()) {
    throw Error(ErrorKind::usage,
                compose(volume.info.path, ": holds one array without a name; leave ", option("dataset"), " out"));
  }
  const Shape shape = checked_shape(volume);
  const std::uint64_t position = chosen_volume(volume.info.path, shape.leading, options.index);
  SourceInfo info = volume.info;
  info.extent = shape.extent;
  info.index = options.index.empty() ? std::vector<std::int64_t>(shape.leading.size(), 0) : options.index;
  auto file = open_data_file(volume, options.direct_io);
  FileStates files;
  files.add(volume.info.files.empty() ? look_at_file(volume.info.path) : volume.info.files.front());
  if (volume.data_path != volume.info.path) files.add(file->state());
  info.files_digest = files.digest();
  info.files = files.files();
  info.mtime_ns = std::max(info.mtime_ns, file->mtime_ns());

  RawLayout layout{0, volume.type, volume.big_endian, volume.info.mapping};
  options.complete(layout.mapping);
  if (volume.packed) {
    file = spool_inflated(*file, packed_range(volume, file->size()), unpacked_range(volume, shape, position), options);
  } else {
    layout.offset = plain_offset(volume, shape, file->size()) + position * shape.volume_bytes;
    info.details.data_note = data_note(volume, shape, file->size());
  }
  return make_raw_values(std::move(file), layout, std::move(info));
}

std::vector<DatasetInfo> list_header_volume(const HeaderVolume& volume) {
  const Shape shape = checked_shape(volume);
  const auto file = open_data_file(volume, DirectIo::off);
  if (volume.packed) {
    packed_range(volume, file->size());
    unpacked_range(volume, shape, 0);
  } else {
    plain_offset(volume, shape, file->size());
  }
  const std::string note = data_note(volume, shape, file->size());
  DatasetInfo only;
  only.extents = volume.extents;
  only.type = cat(volume.big_endian && scalar_bytes(volume.type) > 1 ? "big-endian " : "", scalar_name(volume.type));
  only.layout = volume.packed ? "one compressed stream" : "contiguous";
  only.leading_axes = must_choose(shape.leading) ? shape.leading.size() : 0;
  for (const std::int64_t extent : shape.leading) only.index_axes.push_back({{}, extent});
  only.attributes = {{"spacing", vector_text(volume.info.spacing)}, {"origin", vector_text(volume.info.origin)}};
  if (!volume.info.units.empty()) only.attributes.emplace_back("units", volume.info.units);
  if (volume.info.mapping.scales()) {
    only.attributes.emplace_back("scale", cat(volume.info.mapping.scale));
    only.attributes.emplace_back("offset", cat(volume.info.mapping.offset));
  }
  if (volume.data_path != volume.info.path) only.attributes.emplace_back("data file", volume.data_path);
  if (!note.empty()) only.attributes.emplace_back("note", note);
  only.attributes.insert(only.attributes.end(), volume.attributes.begin(), volume.attributes.end());
  return {only};
}

}  // namespace weir
