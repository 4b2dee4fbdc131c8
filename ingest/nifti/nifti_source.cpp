#include "ingest/nifti/nifti_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/input_file.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/header_volume.h"
#include "ingest/nifti/nifti_header.h"
#include "ingest/streams/stream_inflater.h"

namespace weir {
namespace {

// Returns the file of a header's values. Its ending is in capitals if the header's is and such a file exists.
std::string image_of(const std::string& header) {
  std::filesystem::path image = header;
  std::error_code ignored;
  if (image.extension() == ".HDR" && std::filesystem::exists(image.replace_extension(".IMG"), ignored)) return image;
  return image.replace_extension(".img");
}

bool is_gzip(std::span<const std::byte> head) {
  return head.size() >= 2 && head[0] == std::byte{0x1F} && head[1] == std::byte{0x8B};
}

std::vector<std::byte> read_bytes(InputFile& file, std::uint64_t offset, std::size_t count) {
  std::vector<std::byte> bytes(static_cast<std::size_t>(std::min<std::uint64_t>(count, file.size() - offset)));
  file.read_buffered(offset, bytes, ReadPath::through);
  return bytes;
}

/// Returns the first kMaxNiftiHeader bytes that a gzip file unpacks to, or all if there are fewer.
std::vector<std::byte> unpacked_head(InputFile& file) {
  constexpr std::size_t kPiece = 4096;
  std::vector<std::byte> head;
  StreamInflater inflater(file.path());
  // gzip's own header may hold a name or comment. The bound stops reading if they are absurdly long.
  const std::uint64_t end = std::min<std::uint64_t>(file.size(), kHeaderLimit);
  for (std::uint64_t offset = 0; offset < end && head.size() < kMaxNiftiHeader; offset += kPiece) {
    inflater.push(read_bytes(file, offset, kPiece), [&](std::span<const std::byte> bytes) {
      const auto wanted = bytes.first(std::min(bytes.size(), kMaxNiftiHeader - head.size()));
      head.insert(head.end(), wanted.begin(), wanted.end());
    });
  }
  return head;
}

void place(const NiftiHeader& header, HeaderVolume& volume) {
  const std::size_t axes = std::min<std::size_t>(3, header.extents.size());
  const AxisPlacement placement = place_axes(std::span(header.steps).first(axes), header.first);
  volume.info.spacing = placement.spacing;
  // The spacing is pixdim, not the steps' length, because quaternions are written with rounding.
  for (std::size_t a = 0; a < axes && !header.steps_rule; ++a) volume.info.spacing[a] = header.spacing[a];
  volume.info.origin = placement.origin;
  volume.info.details.orientation = placement.orientation;
  for (std::size_t a = 0; a < axes; ++a) volume.info.details.axes.at(a).units = header.length_unit;
  if (!header.length_unit.empty()) volume.attributes.emplace_back("length unit", header.length_unit);
  if (!placement.orientation.empty()) volume.attributes.emplace_back("orientation", placement.orientation);
  volume.info.details.values_note = header.placement_note;
  if (!header.placement_note.empty()) volume.attributes.emplace_back("placement", header.placement_note);
}

// Returns the time of the volume at `index` on the axes after the third, slowest first; the fourth axis is the time.
// Returns nullopt if the time, or a time step that is needed, is unknown.
std::optional<TimePoint> nifti_time(const NiftiHeader& header, std::span<const std::int64_t> index) {
  const std::int64_t position = index.empty() ? 0 : index.back();
  if (header.time_unit.empty() || !std::isfinite(header.time_offset)) return std::nullopt;
  if (position == 0) return TimePoint{header.time_offset, std::string(header.time_unit), {}};
  if (!std::isfinite(header.time_step) || header.time_step <= 0) return std::nullopt;
  const double value = header.time_offset + static_cast<double>(position) * header.time_step;
  return TimePoint{value, std::string(header.time_unit), {}};
}

/// `index` is the position of the volume to open; it is checked later.
HeaderVolume describe_nifti(const std::string& path, std::span<const std::int64_t> index) {
  InputFile file(path, DirectIo::off);
  std::vector<std::byte> head = read_bytes(file, 0, kMaxNiftiHeader);
  HeaderVolume volume;
  volume.packed = is_gzip(head);
  if (volume.packed) head = unpacked_head(file);
  const NiftiHeader header = parse_nifti_header(head, path);
  if (header.pair && volume.packed) {
    throw Error(ErrorKind::input, cat(path, ": is the packed header of a .hdr and .img pair; unpack both with gunzip"));
  }
  volume.info.path = path;
  volume.info.format = "nifti";
  volume.info.file_bytes = file.size();
  volume.info.mtime_ns = file.mtime_ns();
  volume.info.files = {file.state()};
  volume.info.mapping.scale = header.slope;
  volume.info.mapping.offset = header.intercept;
  volume.extents = header.extents;
  volume.type = header.type;
  volume.big_endian = header.big_endian;
  volume.data_path = header.pair ? image_of(path) : path;
  (volume.packed ? volume.packed_offset : volume.data_offset) = header.values_offset;
  volume.offset_key = "vox_offset";
  volume.ends_file = header.has_hidden_extensions;  // otherwise the extensions' bytes would count as values
  place(header, volume);
  volume.info.details.time = nifti_time(header, index);
  return volume;
}

}  // namespace

bool recognises_nifti(std::string_view path, std::span<const std::byte> head) {
  return ends_with_one_of(path, kNiftiEndings) || (lower_case(path).ends_with(".hdr") && begins_like_nifti(head));
}

std::unique_ptr<VolumeSource> open_nifti(const std::string& path, const SourceOptions& options) {
  return open_header_volume(describe_nifti(path, options.index), options);
}

std::vector<DatasetInfo> list_nifti(const std::string& path, const SourceOptions&) {
  return list_header_volume(describe_nifti(path, {}));
}

}  // namespace weir
