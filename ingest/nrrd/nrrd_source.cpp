#include "ingest/nrrd/nrrd_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/files/input_file.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/header_volume.h"
#include "ingest/nrrd/nrrd_header.h"
#include "ingest/values/axis_placement.h"

namespace weir {
namespace {

/// Whether an axis is one of space or time rather than one of vectors or colours; unknown where the header says
/// nothing.
enum class AxisRole { domain, range, unknown };

AxisRole role_of(const NrrdHeader& header, std::size_t axis) {
  if (!header.directions.empty() && header.directions[axis]) return AxisRole::domain;
  const std::string kind = header.kinds.empty() ? "???" : header.kinds[axis];
  if (kind == "domain" || kind == "space" || kind == "time") return AxisRole::domain;
  if (kind != "???" && kind != "none") return AxisRole::range;
  return header.directions.empty() ? AxisRole::unknown : AxisRole::range;
}

/// The axis that is x: the first, or the second where the first holds one value of no axis of space.
std::size_t first_axis(const NrrdHeader& header, const std::string& path) {
  const AxisRole role = role_of(header, 0);
  const bool scalar = header.sizes[0] == 1 && header.sizes.size() > 1;
  const std::size_t first =
      scalar && (role == AxisRole::range || (role == AxisRole::unknown && header.sizes.size() > 3)) ? 1 : 0;
  for (std::size_t a = first; a < std::min(first + 3, header.sizes.size()); ++a) {
    if (role_of(header, a) != AxisRole::range) continue;
    throw Error(ErrorKind::input, cat(path, ": axis ", a, " of ", header.sizes[a], " values",
                                      header.kinds.empty() ? "" : cat(" and kind ", in_quotes(header.kinds[a])),
                                      " is no axis of space; take one component with `unu slice -a ", a, " -p 0`"));
  }
  return first;
}

double length_or_1(double spacing) { return std::isnan(spacing) ? 1.0 : std::fabs(spacing); }

/// Spacing and origin of headers without space directions. Samples of unknown centering lie in their cells' middle,
/// as Teem takes them (nrrdDefaultCenter).
void place_by_axes(const NrrdHeader& header, std::size_t axis, double& spacing, double& origin) {
  const double low = header.axis_mins.empty() ? std::nan("") : header.axis_mins[axis];
  const double high = header.axis_maxs.empty() ? std::nan("") : header.axis_maxs[axis];
  const bool node = !header.centerings.empty() && header.centerings[axis] == "node";
  const auto steps = static_cast<double>(header.sizes[axis] - (node ? 1 : 0));
  if (!header.spacings.empty()) {
    spacing = length_or_1(header.spacings[axis]);
  } else if (high > low && steps > 0) {
    spacing = (high - low) / steps;
  }
  if (!std::isnan(low)) origin = low + (node ? 0.0 : spacing / 2);
}

void place(const NrrdHeader& header, std::size_t first, HeaderVolume& volume) {
  const std::size_t axes = std::min<std::size_t>(3, header.sizes.size() - first);
  SourceInfo& info = volume.info;
  const auto padded = [](const std::vector<double>& components) {
    Vector3 v{};
    std::copy_n(components.begin(), std::min<std::size_t>(3, components.size()), v.begin());
    return v;
  };
  if (header.directions.empty()) {
    for (std::size_t a = 0; a < axes; ++a) place_by_axes(header, first + a, info.spacing[a], info.origin[a]);
    if (!header.space_origin.empty()) info.origin = padded(header.space_origin);
    return;
  }
  std::vector<Vector3> steps;
  for (std::size_t a = first; a < first + axes; ++a) steps.push_back(padded(*header.directions[a]));
  const AxisPlacement placement = place_axes(steps, padded(header.space_origin));
  info.spacing = placement.spacing;
  info.origin = placement.origin;
  info.details.orientation = placement.orientation;
  if (!placement.orientation.empty()) volume.attributes.emplace_back("orientation", placement.orientation);
}

/// Bytes before the line after the `count` next ones from `offset` on.
std::uint64_t skip_lines(InputFile& file, std::uint64_t offset, std::uint64_t count) {
  std::array<std::byte, 65536> piece;
  while (count > 0 && offset < file.size()) {
    const auto part = std::span(piece).first(std::min<std::uint64_t>(piece.size(), file.size() - offset));
    file.read_buffered(offset, part, ReadPath::through);
    for (std::size_t i = 0; i < part.size() && count > 0; ++i, ++offset) count -= part[i] == std::byte{'\n'} ? 1 : 0;
  }
  if (count > 0) {
    throw Error(ErrorKind::input,
                cat(file.path(), ": ends ", count, " lines before its values begin; check line skip"));
  }
  return offset;
}

void locate(const NrrdHeader& header, HeaderVolume& volume) {
  const std::string& path = volume.info.path;
  volume.data_path = header.data_file.empty() ? path : path_beside(path, header.data_file);
  volume.data_offset = header.data_file.empty() ? header.header_bytes : 0;
  if (header.line_skip > 0) {
    const auto data = open_data_file(volume, DirectIo::off);
    volume.data_offset = skip_lines(*data, volume.data_offset, header.line_skip);
  }
  volume.offset_key = "byte skip";
  volume.packed = header.gzip;
  volume.at_end = header.at_end;
  (header.gzip ? volume.packed_offset : volume.data_offset) += header.byte_skip;
}

HeaderVolume describe_nrrd(const std::string& path) {
  InputFile file(path, DirectIo::off);
  const std::string head = read_head(file);
  const NrrdHeader header = parse_nrrd_header(head, head.size() == file.size(), path);
  const std::size_t first = first_axis(header, path);
  HeaderVolume volume;
  volume.info.path = path;
  volume.info.format = "nrrd";
  volume.info.file_bytes = file.size();
  volume.info.mtime_ns = file.mtime_ns();
  volume.info.files = {file.state()};
  volume.info.units = header.sample_units;
  for (std::size_t a = 0; a < 3 && first + a < header.labels.size(); ++a) {
    volume.info.axis_labels[a] = header.labels[first + a];
  }
  volume.extents.assign(header.sizes.begin() + static_cast<std::ptrdiff_t>(first), header.sizes.end());
  volume.type = header.type;
  volume.big_endian = header.big_endian;
  place(header, first, volume);
  locate(header, volume);
  return volume;
}

}  // namespace

bool recognises_nrrd(std::string_view path, std::span<const std::byte> head) {
  const std::string_view begin(reinterpret_cast<const char*>(head.data()), head.size());
  const std::string name = lower_case(path);
  return begin.starts_with(kNrrdMagic) || name.ends_with(".nrrd") || name.ends_with(".nhdr");
}

std::unique_ptr<VolumeSource> open_nrrd(const std::string& path, const SourceOptions& options) {
  return open_header_volume(describe_nrrd(path), options);
}

std::vector<DatasetInfo> list_nrrd(const std::string& path, const SourceOptions&) {
  return list_header_volume(describe_nrrd(path));
}

}  // namespace weir
