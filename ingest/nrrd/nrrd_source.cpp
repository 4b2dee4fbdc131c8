#include "ingest/nrrd/nrrd_source.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/axes/axis_details.h"
#include "ingest/axes/axis_place.h"
#include "ingest/files/input_file.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/header_volume.h"
#include "ingest/nrrd/nrrd_header.h"
#include "ingest/values/axis_placement.h"

namespace weir {
namespace {

/// The role of an axis: domain is an axis of space; range is an axis of vectors, colours or time; unknown if the
/// header does not say.
enum class AxisRole { domain, range, unknown };

std::string_view nrrd_kind_of(const NrrdHeader& header, std::size_t axis) {
  return header.kinds.empty() ? std::string_view("???") : header.kinds[axis];
}

AxisRole role_of(const NrrdHeader& header, std::size_t axis) {
  const std::string_view kind = nrrd_kind_of(header, axis);
  if (kind == "time") return AxisRole::range;
  if (!header.directions.empty() && header.directions[axis]) return AxisRole::domain;
  if (kind == "domain" || kind == "space") return AxisRole::domain;
  if (kind != "???" && kind != "none") return AxisRole::range;
  return header.directions.empty() ? AxisRole::unknown : AxisRole::range;
}

/// Returns a command that removes the axis `axis`, which is not of space, from x, y and z. x is the axis `first`.
std::string nrrd_axis_remedy(const NrrdHeader& header, std::size_t first, std::size_t axis) {
  const std::string slice = cat(" with `unu slice -a ", axis, " -p 0`");
  if (nrrd_kind_of(header, axis) != "time") return cat("take one component", slice);
  std::string remedy = cat("take one time step", slice);
  if (header.sizes.size() - first <= 3) return remedy;
  remedy += ", or make it the last axis with `unu permute -p";
  for (std::size_t a = 0; a < header.sizes.size(); ++a) remedy += a == axis ? "" : cat(' ', a);
  return cat(remedy, ' ', axis, '`');
}

/// Returns the axis that is x: the first, or the second if the first holds a single value and is not an axis of
/// space.
std::size_t first_axis(const NrrdHeader& header, const std::string& path) {
  const AxisRole role = role_of(header, 0);
  const bool scalar = header.sizes[0] == 1 && header.sizes.size() > 1;
  const std::size_t first =
      scalar && (role == AxisRole::range || (role == AxisRole::unknown && header.sizes.size() > 3)) ? 1 : 0;
  for (std::size_t a = first; a < std::min(first + 3, header.sizes.size()); ++a) {
    if (role_of(header, a) != AxisRole::range) continue;
    throw Error(ErrorKind::input, cat(path, ": axis ", a, " of ", header.sizes[a], " values",
                                      header.kinds.empty() ? "" : cat(" and kind ", in_quotes(header.kinds[a])),
                                      " is no axis of space; ", nrrd_axis_remedy(header, first, a)));
  }
  return first;
}

Vector3 padded(const std::vector<double>& components) {
  Vector3 v{};
  std::copy_n(components.begin(), std::min<std::size_t>(3, components.size()), v.begin());
  return v;
}

/// Returns the space direction of `axis`; nullptr if the header has none for it.
const std::vector<double>* direction_of(const NrrdHeader& header, std::size_t axis) {
  return header.directions.empty() || !header.directions[axis] ? nullptr : &*header.directions[axis];
}

struct AxisSteps {
  double step = 1;   ///< from sample to sample; below 0 if positions fall
  double first = 0;  ///< position of the first sample
};

/// Returns the steps along an axis without a space direction. Samples of unknown centering lie in the middle of their
/// cells, as in Teem (nrrdDefaultCenter). If axis max is below axis min, positions fall (nrrdAxisInfoPos).
AxisSteps steps_along(const NrrdHeader& header, std::size_t axis) {
  const double begin = header.axis_mins.empty() ? std::nan("") : header.axis_mins[axis];
  const double end = header.axis_maxs.empty() ? std::nan("") : header.axis_maxs[axis];
  const bool node = !header.centerings.empty() && header.centerings[axis] == "node";
  const auto cells = static_cast<double>(header.sizes[axis] - (node ? 1 : 0));
  const bool has_range = !std::isnan(end - begin) && end != begin;
  double step = header.spacings.empty() ? std::nan("") : header.spacings[axis];
  if (has_range && !std::isnan(step)) step = std::copysign(step, end - begin);
  if (has_range && std::isnan(step) && cells > 0) step = (end - begin) / cells;
  if (std::isnan(step)) step = 1;
  return {step, std::isnan(begin) ? 0.0 : begin + (node ? 0.0 : step / 2)};
}

/// Returns the position of the first sample, and the steps along `axes` axes from `first` on.
std::pair<Vector3, std::vector<Vector3>> first_and_steps(const NrrdHeader& header, std::size_t first,
                                                         std::size_t axes) {
  Vector3 corner{};
  std::vector<Vector3> steps(axes, Vector3{});
  for (std::size_t a = 0; a < axes; ++a) {
    if (const auto* const direction = direction_of(header, first + a)) {
      steps[a] = padded(*direction);
      continue;
    }
    const AxisSteps along = steps_along(header, first + a);
    steps[a][a] = along.step;
    corner[a] = along.first;
  }
  if (!header.directions.empty() || !header.space_origin.empty()) corner = padded(header.space_origin);
  return {corner, steps};
}

/// Returns the unit along `direction`, from the units of the world's axes; empty if it runs along axes with different
/// units.
std::string units_along(const std::vector<double>& direction, const std::vector<std::string>& units) {
  constexpr double kRounding = 1e-6;  // relative to the largest component, as in place_axes
  double largest = 0;
  for (const double part : direction) largest = std::max(largest, std::fabs(part));
  std::optional<std::string> found;
  for (std::size_t c = 0; c < std::min(direction.size(), units.size()); ++c) {
    if (std::fabs(direction[c]) <= kRounding * largest) continue;
    if (found && *found != units[c]) return "";
    found = units[c];
  }
  return found.value_or("");
}

std::string units_of_axis(const NrrdHeader& header, std::size_t first, std::size_t a) {
  if (const auto* const direction = direction_of(header, first + a)) return units_along(*direction, header.space_units);
  if (!header.units.empty()) return header.units[first + a];
  return a < header.space_units.size() ? header.space_units[a] : "";
}

/// Sets the axis units of `volume`. Its labels and spacings must be set before.
void describe_units(const NrrdHeader& header, std::size_t first, std::size_t axes, HeaderVolume& volume) {
  std::array<AxisPlace, 3> places;
  std::string listed;
  for (std::size_t a = 0; a < axes; ++a) {
    places.at(a).label = volume.info.axis_labels.at(a);
    places.at(a).spacing = volume.info.spacing.at(a);
    places.at(a).units = units_of_axis(header, first, a);
    volume.info.details.axes.at(a).units = places.at(a).units;
    listed += cat(a == 0 ? "" : ",", places.at(a).units);
  }
  volume.info.details.units_note = units_note({places.data(), &places[1], &places[2]});
  if (listed.find_first_not_of(',') != std::string::npos) volume.attributes.emplace_back("axis units", listed);
}

void place(const NrrdHeader& header, std::size_t first, HeaderVolume& volume) {
  const std::size_t axes = std::min<std::size_t>(3, header.sizes.size() - first);
  const auto [corner, steps] = first_and_steps(header, first, axes);
  const AxisPlacement placement = place_axes(steps, corner);
  volume.info.spacing = placement.spacing;
  volume.info.origin = placement.origin;
  describe_units(header, first, axes, volume);
  volume.info.details.orientation = placement.orientation;
  if (!placement.orientation.empty()) volume.attributes.emplace_back("orientation", placement.orientation);
}

/// Returns the offset of the byte after `count` lines from `offset` on.
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
  return begin.starts_with(kNrrdMagic) || ends_with_one_of(path, kNrrdEndings);
}

std::unique_ptr<VolumeSource> open_nrrd(const std::string& path, const SourceOptions& options) {
  return open_header_volume(describe_nrrd(path), options);
}

std::vector<DatasetInfo> list_nrrd(const std::string& path, const SourceOptions&) {
  return list_header_volume(describe_nrrd(path));
}

}  // namespace weir
