#include "ingest/hdf5/meaning/dataset_choice.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_walk.h"
#include "ingest/hdf5/meaning/dataset_facts.h"
#include "ingest/hdf5/meaning/dimension_scales.h"
#include "ingest/hdf5/meaning/hdf5_lookup.h"
#include "ingest/hdf5/meaning/volume_slice.h"
#include "ingest/headers/named_choice.h"
#include "ingest/source/convert_command.h"
#include "ingest/source/left_out.h"
#include "ingest/vtk/vtk_marks.h"

namespace weir {
namespace {

struct DatasetCandidate {
  DatasetInfo info;
  std::string axes;
};

Error several(const std::string& path, const std::vector<DatasetCandidate>& candidates) {
  std::vector<Message> commands;
  for (const auto& [info, axes] : candidates) {
    commands.push_back(compose(CommandLineText{convert_command(path, true, info), volume_keys(info)}, " (", axes, ")"));
  }
  return several_volumes(path, "volumes", candidates.size(), commands);
}

// Returns whether the candidate takes the given --component and, if any are given, the positions of --index.
bool takes(const DatasetCandidate& candidate, const SourceOptions& options) {
  if (options.component && candidate.info.components == 1) return false;
  const std::size_t positions = options.index.size();
  const bool components_as_x = !options.component && candidate.info.components > 1;
  return positions == 0 || positions == candidate.info.leading_axes ||
         (components_as_x && positions == candidate.info.extents.size() - kVolumeRank);
}

// Returns the number of axes, three at most, and the number of values.
std::pair<std::size_t, double> size_of(std::span<const AxisPlace> axes) {
  double values = 1;
  for (const AxisPlace& axis : axes) values *= static_cast<double>(axis.extent);
  return {std::min(axes.size(), kVolumeRank), values};
}

// Returns why a dataset that otherwise is a volume cannot be converted; empty if it can, or if it is no volume.
std::string volume_obstacle(const DatasetFacts& facts) {
  return facts.axes.size() < kVolumeRank || facts.over_time || facts.marks ? std::string() : facts.obstacle;
}

}  // namespace

Hdf5Object only_volume(hid_t file, const std::string& path, const SourceOptions& options) {
  std::vector<DatasetCandidate> candidates;
  std::size_t datasets = 0;
  std::vector<LeftOut> left_out;
  std::string obstacle;  // of the dataset nearest to a volume: most axes, then most values
  std::pair<std::size_t, double> nearest;
  const auto look_at = [&](std::string name, Hdf5Handle handle) {
    if (is_bare_dimension(handle.get())) return;
    ++datasets;
    DatasetFacts facts = dataset_facts(file, {std::move(handle), path, name});
    if (const std::string why = volume_obstacle(facts); !why.empty()) left_out.push_back({name, why});
    if (facts.obstacle.empty() && facts.marks) facts.obstacle = kMarkObstacle;
    if (facts.obstacle.empty()) {
      DatasetCandidate& candidate = candidates.emplace_back();
      candidate.info.name = name;
      for (const AxisPlace& axis : facts.axes) candidate.info.extents.push_back(axis.extent);
      candidate.info.leading_axes = leading_axes(facts.axes);
      candidate.info.components = facts.components.count;
      candidate.axes = axes_text(facts.axes);
    } else if (const auto size = size_of(facts.axes); obstacle.empty() || size > nearest) {
      nearest = size;
      obstacle = cat(name, ": ", facts.obstacle);
    }
  };
  walk_datasets(file, "/", look_at, [&](const UnreadObject& unread) {
    if (unread.elsewhere) return;
    throw input_error(path, compose(unread.name, ": ", unread.why, ", and may hold a volume, too; choose one with ",
                                    option("dataset"), ", or copy the file again"));
  });
  if (datasets == 0) throw Error(ErrorKind::input, cat(path, ": holds no dataset; name a file that has one"));
  if (candidates.empty()) {
    throw Error(ErrorKind::input, datasets == 1
                                      ? cat(path, ": ", obstacle)
                                      : cat(path, ": none of its ", datasets, " datasets is a volume; the nearest is ",
                                            obstacle, "; weir inspect lists them"));
  }
  std::vector<DatasetCandidate> fitting = candidates;
  std::erase_if(fitting, [&](const DatasetCandidate& c) { return !takes(c, options); });
  const std::vector<DatasetCandidate>& left = fitting.empty() ? candidates : fitting;
  if (left.size() > 1) throw several(path, left);
  const std::string& taken = left.front().info.name;
  if (options.notice && !left_out.empty()) options.notice(left_out_notice(path, taken, left_out));
  return find_dataset(file, path, taken);
}

}  // namespace weir
