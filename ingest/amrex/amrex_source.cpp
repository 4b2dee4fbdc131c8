#include "ingest/amrex/amrex_source.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/amrex/composite.h"
#include "ingest/amrex/plotfile.h"
#include "ingest/amrex/plotfile_text.h"
#include "ingest/files/input_directory.h"
#include "ingest/headers/header_text.h"
#include "ingest/headers/named_choice.h"
#include "ingest/source/convert_command.h"
#include "ingest/source/extent.h"
#include "ingest/values/axis_placement.h"

namespace weir {
namespace {

constexpr std::size_t kMostComponentsShown = 8;  // names of components in a message
constexpr std::uint64_t kMemoryShare = 4;        // of --memory, for the boxes

class AmrexSource final : public VolumeSource {
 public:
  AmrexSource(Plotfile plotfile, std::size_t component, SourceInfo info, const SourceOptions& options)
      : plotfile_(std::move(plotfile)),
        info_(std::move(info)),
        composite_(
            info_.details.level
                ? Composite(plotfile_, component, info_.mapping, static_cast<std::size_t>(info_.details.level->number),
                            options.direct_io, options.notice)
                : Composite(plotfile_, component, info_.mapping, options.upsampling.value_or(Upsampling::constant),
                            options.direct_io, options.notice)) {}

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {scalar_bytes(info_.type), {}, {}}; }
  std::vector<Box> voxels_with_values(const Box& box) const override { return composite_.voxels_with_values(box); }
  std::vector<RepeatedPart> repeated_parts(const Box& box) const override { return composite_.repeated_parts(box); }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    return composite_.read_repeated(part, values);
  }
  std::uint64_t working_bytes() const override { return composite_.working_bytes(); }
  std::uint64_t bytes_read() const override { return composite_.bytes_read(); }

  ConversionLoss read(const Box& box, std::span<float> values) override {
    if (box.empty() || !info_.domain().contains(box) || std::cmp_not_equal(values.size(), box.voxels())) {
      throw Error(ErrorKind::internal, cat(info_.path, ": read of box ", box_text(box), " into ", values.size(),
                                           " values does not fit ", box_text(info_.domain())));
    }
    return composite_.read(box, values);
  }

 private:
  Plotfile plotfile_;
  SourceInfo info_;
  Composite composite_;
};

// Returns, for each component, why it cannot be converted; empty if it can. --dataset can only name a component, so
// that a component needs a name of its own.
std::vector<std::string> component_obstacles(const std::vector<std::string>& names) {
  std::map<std::string_view, std::size_t> counts;
  for (const std::string& name : names) ++counts[name];
  std::vector<std::string> obstacles;
  for (const std::string& name : names) {
    obstacles.emplace_back(name.empty()        ? "it has no name"
                           : counts[name] == 1 ? ""
                                               : "another component has the same name");
  }
  return obstacles;
}

void refuse_second(const std::string& path, const std::vector<std::string>& names, std::size_t first) {
  const auto after = names.begin() + static_cast<std::ptrdiff_t>(first) + 1;
  const auto second = std::find(after, names.end(), names[first]);
  if (second == names.end()) return;
  throw input_error(
      path, cat("its components ", first + 1, " and ", second - names.begin() + 1, " of ", names.size(),
                " both have the name ", in_quotes(names[first]),
                ", which does not say which of them is meant; give one of them another name in its ", kDirectoryHead));
}

Error several_components(const std::string& path, const std::vector<std::string>& names) {
  const std::vector<std::string> obstacles = component_obstacles(names);
  std::vector<Message> commands;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!obstacles[i].empty()) continue;
    DatasetInfo info;
    info.name = names[i];
    commands.emplace_back(CommandLineText{convert_command(path, true, info), volume_keys(info)});
  }
  if (commands.empty()) {
    return usage_error(compose(path, ": holds ", names.size(), " components; choose one with ", option("dataset"),
                               ": none has a name of its own (weir inspect lists them)"));
  }
  return several_volumes(path, "components", names.size(), commands);
}

std::size_t chosen_component(const std::string& path, const std::vector<std::string>& names,
                             const std::string& wanted) {
  if (wanted.empty()) {
    if (names.size() == 1) return 0;
    throw several_components(path, names);
  }
  const auto found = std::find(names.begin(), names.end(), wanted);
  if (found != names.end()) {
    const auto position = static_cast<std::size_t>(found - names.begin());
    refuse_second(path, names, position);
    return position;
  }
  std::string there;
  for (std::size_t i = 0; i < std::min(names.size(), kMostComponentsShown); ++i)
    there += cat(i == 0 ? "" : ", ", in_quotes(names[i]));
  if (names.size() > kMostComponentsShown) there += cat(" and ", names.size() - kMostComponentsShown, " more");
  throw input_error(path, cat("has no component ", in_quotes(wanted), "; it has ", there));
}

std::size_t chosen_level(const std::string& path, const AmrexHeader& header, const SourceOptions& options) {
  const std::size_t finest = header.levels.size() - 1;
  if (!options.level) return finest;
  if (*options.level >= 0 && std::cmp_less_equal(*options.level, finest))
    return static_cast<std::size_t>(*options.level);
  throw usage_error(compose(path, ": ", option("level", *options.level), " is none of its levels; give ",
                            finest == 0 ? "0" : cat("0, the coarsest, to ", finest)));
}

// Returns the level that is this volume, with Levels::separate.
std::size_t own_level(const std::string& path, std::size_t finest, const SourceOptions& options) {
  if (finest == 0) return 0;
  if (options.own_level && *options.own_level >= 0 && std::cmp_less_equal(*options.own_level, finest))
    return static_cast<std::size_t>(*options.own_level);
  throw usage_error(compose(path, ": ", option("levels", "separate"), " stands for ", finest + 1,
                            " volumes, and one is read here; leave it out"));
}

void refuse_upsampling(const std::string& path, const SourceOptions& options) {
  if (!options.upsampling) return;
  throw usage_error(compose(path, ": ", option("upsample"), " is for ", option("levels", "composite"),
                            "; with separate levels leave it out"));
}

Box bounds_of(const std::vector<CellBox>& boxes) {
  Box bounds = boxes.front().box();
  for (const CellBox& box : boxes) bounds = {min(bounds.lo, box.box().lo), max(bounds.hi, box.box().hi)};
  return bounds;
}

std::array<double, 3> first_centre(const AmrexHeader& header, std::size_t level) {
  std::array<double, 3> centre{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    centre.at(axis) = header.corner.at(axis) + 0.5 * header.levels[level].spacing.at(axis);
  }
  return centre;
}

// Returns text such as "3 levels of 8, 20 and 64 boxes, refined by 2 and 4".
std::string levels_text(const AmrexHeader& header) {
  std::string boxes;
  std::string ratios;
  const std::size_t levels = header.levels.size();
  for (std::size_t i = 0; i < levels; ++i) {
    const AmrexLevelHeader& level = header.levels[i];
    const char* const comma = i + 1 == levels ? " and " : ", ";
    boxes += cat(i == 0 ? "" : comma, level.boxes);
    const Index3& r = level.ratio;
    if (i > 0) ratios += cat(i == 1 ? "" : comma, r.x == r.y && r.y == r.z ? cat(r.x) : cat(r.x, 'x', r.y, 'x', r.z));
  }
  const char* const plural = levels == 1 && header.levels.front().boxes == 1 ? " box" : " boxes";
  return cat(levels, levels == 1 ? " level of " : " levels of ", boxes, plural, ratios.empty() ? "" : ", refined by ",
             ratios);
}

std::string component_range_text(const Plotfile& plotfile, std::size_t component) {
  ComponentRange all{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const PlotfileLevel& level : plotfile.levels) {
    if (level.ranges.empty()) return {};
    all.min = std::min(all.min, level.ranges[component].min);
    all.max = std::max(all.max, level.ranges[component].max);
  }
  return all.min <= all.max ? cat(all.min, " .. ", all.max) : "none";
}

}  // namespace

bool recognises_amrex(std::string_view path, std::span<const std::byte> head) {
  const std::string name(path);
  if (!is_input_directory(name) && std::filesystem::path(name).filename() != kDirectoryHead) return false;
  return begins_as_amrex_header({reinterpret_cast<const char*>(head.data()), head.size()});
}

std::unique_ptr<VolumeSource> open_amrex(const std::string& path, const SourceOptions& options) {
  refuse_index(path, options);
  const AmrexHeader header = read_amrex_header(path, options.cancel);
  const std::size_t component = chosen_component(path, header.components, options.dataset);
  const std::size_t finest = chosen_level(path, header, options);
  const bool separate = options.levels == Levels::separate;
  if (separate) refuse_upsampling(path, options);
  const std::size_t level = separate ? own_level(path, finest, options) : finest;
  Plotfile plotfile = open_plotfile(
      path,
      {finest + 1, options.memory / kMemoryShare, {.of_components = false, .of_boxes = component}, options.cancel});
  SourceInfo info;
  info.path = path;
  info.format = "amrex";
  info.dataset = header.components[component];
  info.extent = plotfile.levels[level].extent;
  info.type = plotfile.layout.type;
  options.complete(info.mapping);
  info.spacing = header.levels[level].spacing;
  info.origin = first_centre(header, level);
  if (std::isfinite(header.time)) info.details.time = TimePoint{header.time, {}, {}};
  if (separate) {
    const Box bounds = bounds_of(plotfile.levels[level].boxes);
    info.extent = bounds.extent();
    info.index_origin = bounds.lo;
    info.mapping.gaps = true;
    info.details.level = RefinementLevel{static_cast<std::int64_t>(level), static_cast<std::int64_t>(finest + 1)};
    info.details.levels = cat(level, " of up to ", finest, ", separate");
  } else {
    info.details.levels =
        cat("up to ", level, ", ", upsampling_name(options.upsampling.value_or(Upsampling::constant)));
  }
  info.file_bytes = plotfile.bytes;
  info.mtime_ns = plotfile.mtime_ns;
  info.files_digest = plotfile.files.digest();
  info.files = plotfile.files.files();
  checked_volume_bytes(info.extent, scalar_bytes(info.type), path);
  return std::make_unique<AmrexSource>(std::move(plotfile), component, std::move(info), options);
}

std::vector<DatasetInfo> list_amrex(const std::string& path, const SourceOptions& options) {
  refuse_index(path, options);
  const Plotfile plotfile = open_plotfile(
      path, {SIZE_MAX, options.memory / kMemoryShare, {.of_components = true, .of_boxes = {}}, options.cancel});
  const AmrexHeader& header = plotfile.header;
  const std::size_t level = chosen_level(path, header, options);
  const Index3& extent = plotfile.levels[level].extent;
  const std::vector<std::string> obstacles = component_obstacles(header.components);
  std::vector<DatasetInfo> list;
  for (std::size_t i = 0; i < header.components.size(); ++i) {
    DatasetInfo info;
    info.name = header.components[i];
    info.extents = {extent.x, extent.y, extent.z};
    info.type = real_layout_text(plotfile.layout);
    info.layout = levels_text(header);
    info.obstacle = obstacles[i];
    if (info.obstacle.empty() && options.levels == Levels::composite)
      info.obstacle = extent_obstacle(extent, scalar_bytes(plotfile.layout.type));
    if (const std::string range = component_range_text(plotfile, i); !range.empty())
      info.attributes.emplace_back("range", range);
    info.attributes.emplace_back("spacing", vector_text(header.levels[level].spacing));
    info.attributes.emplace_back("origin", vector_text(first_centre(header, level)));
    info.attributes.emplace_back("time", cat(header.time));
    list.push_back(std::move(info));
  }
  return list;
}

std::int64_t count_amrex_levels(const std::string& path, const SourceOptions& options) {
  return static_cast<std::int64_t>(chosen_level(path, read_amrex_header(path, options.cancel), options)) + 1;
}

std::string unwritten_part(const std::string& header_path) {
  try {
    open_plotfile(header_path, {});
    return {};
  } catch (const UnsupportedPlotfile&) {
    return {};
  } catch (const Error& error) {
    return error.what();
  }
}

}  // namespace weir
