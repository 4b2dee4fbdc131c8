#include "ingest/meta_image/meta_image_source.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "format/base/text.h"
#include "ingest/files/input_file.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/header_volume.h"
#include "ingest/meta_image/meta_image_header.h"
#include "ingest/values/axis_placement.h"

namespace weir {
namespace {

void place(const MetaImageHeader& header, HeaderVolume& volume) {
  const std::size_t axes = header.dim_size.size();
  const std::size_t shown = std::min<std::size_t>(3, axes);
  std::vector<Vector3> steps(shown, Vector3{});
  Vector3 first{};
  for (std::size_t a = 0; a < shown; ++a) {
    const double length = header.spacing.empty() ? 1.0 : header.spacing[a];
    for (std::size_t c = 0; c < shown; ++c) {
      const double direction = header.transform.empty() ? (a == c ? 1.0 : 0.0) : header.transform[a * axes + c];
      steps[a][c] = direction * length;
    }
    first[a] = header.origin.empty() ? 0.0 : header.origin[a];
  }
  const AxisPlacement placement = place_axes(steps, first);
  // The spacing is the header's own, not the steps' length, because directions are written with rounding.
  for (std::size_t a = 0; a < std::min(shown, header.spacing.size()); ++a) {
    volume.info.spacing[a] = std::fabs(header.spacing[a]);
  }
  volume.info.origin = placement.origin;
  for (std::size_t a = 0; a < shown; ++a) volume.info.details.axes.at(a).units = header.distance_units;
  if (!header.distance_units.empty()) volume.attributes.emplace_back("length unit", header.distance_units);
  volume.info.details.orientation = placement.orientation;
  if (!placement.orientation.empty()) volume.attributes.emplace_back("orientation", placement.orientation);
}

/// The longest header of a sequence, which has some twenty lines for each frame.
constexpr std::size_t kSequenceHeaderLimit = std::size_t{64} << 20U;

/// Returns whether `head` describes frames and more lines of them may follow after its end.
bool ends_among_frames(std::string_view head) {
  if (head.find(cat('\n', kFrameKey)) == std::string_view::npos) return false;
  const std::size_t last = head.find("\nElementDataFile");
  return last == std::string_view::npos || head.find('\n', last + 1) == std::string_view::npos;
}

/// Returns the first bytes of a file, enough to contain its header.
std::string read_meta_image_head(InputFile& file) {
  std::string head = read_head(file);
  while (head.size() < std::min<std::uint64_t>(file.size(), kSequenceHeaderLimit) && ends_among_frames(head)) {
    const std::size_t more = std::min(8 * head.size(), kSequenceHeaderLimit);
    head = {};  // so that memory never holds both
    head = read_head(file, more);
  }
  return head;
}

HeaderVolume describe_meta_image(const std::string& path) {
  InputFile file(path, DirectIo::off);
  const std::string head = read_meta_image_head(file);
  const MetaImageHeader header = parse_meta_image_header(head, head.size() == file.size(), path);
  HeaderVolume volume;
  volume.info.path = path;
  volume.info.format = "meta-image";
  volume.info.file_bytes = file.size();
  volume.info.mtime_ns = file.mtime_ns();
  volume.info.files = {file.state()};
  volume.info.mapping.scale = header.slope;
  volume.info.mapping.offset = header.offset;
  volume.extents = header.dim_size;
  volume.type = header.type;
  volume.big_endian = header.big_endian;
  const bool local = header.data_file.empty();
  volume.data_path = local ? path : path_beside(path, header.data_file);
  volume.data_offset = local && header.header_size == 0 ? header.header_bytes : header.header_size;
  volume.offset_key = "HeaderSize";
  volume.at_end = header.at_end;
  volume.packed = header.compressed;
  volume.packed_bytes = header.compressed_bytes;
  place(header, volume);
  return volume;
}

}  // namespace

bool recognises_meta_image(std::string_view path, std::span<const std::byte>) {
  return ends_with_one_of(path, kMetaImageEndings);
}

std::unique_ptr<VolumeSource> open_meta_image(const std::string& path, const SourceOptions& options) {
  return open_header_volume(describe_meta_image(path), options);
}

std::vector<DatasetInfo> list_meta_image(const std::string& path, const SourceOptions&) {
  return list_header_volume(describe_meta_image(path));
}

}  // namespace weir
