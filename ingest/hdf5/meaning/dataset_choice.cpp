#include "ingest/hdf5/meaning/dataset_choice.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_walk.h"
#include "ingest/hdf5/meaning/dataset_facts.h"
#include "ingest/hdf5/meaning/hdf5_lookup.h"
#include "ingest/hdf5/meaning/volume_slice.h"

namespace weir {
namespace {

constexpr std::size_t kMostCandidates = 8;  // in a message

struct DatasetCandidate {
  std::string name;
  std::string axes;
  std::size_t positions = 0;
};

Error several(const std::string& path, const std::vector<DatasetCandidate>& candidates) {
  std::string names;
  for (std::size_t i = 0; i < std::min(candidates.size(), kMostCandidates); ++i) {
    names += cat(i == 0 ? "" : ", ", candidates[i].name, " (", candidates[i].axes, ")");
  }
  if (candidates.size() > kMostCandidates) {
    names += cat(" and ", candidates.size() - kMostCandidates, " more (weir inspect lists them)");
  }
  return {ErrorKind::usage,
          compose(path, ": holds ", candidates.size(), " volumes; choose one with ", option("dataset"), ": ", names)};
}

}  // namespace

Hdf5Object only_volume(hid_t file, const std::string& path, std::size_t positions) {
  std::vector<DatasetCandidate> candidates;
  std::size_t datasets = 0;
  std::string obstacle;
  walk_datasets(file, "/", [&](std::string name, Hdf5Handle handle) {
    ++datasets;
    const DatasetFacts facts = dataset_facts(file, {std::move(handle), path, name});
    if (facts.obstacle.empty()) {
      candidates.push_back({name, axes_text(facts.axes), leading_axes(facts.axes)});
    } else if (obstacle.empty()) {
      obstacle = cat(name, ": ", facts.obstacle);
    }
  });
  if (datasets == 0) throw Error(ErrorKind::input, cat(path, ": holds no dataset"));
  if (candidates.empty()) {
    throw Error(ErrorKind::input, datasets == 1 ? cat(path, ": ", obstacle)
                                                : cat(path, ": none of its ", datasets, " datasets is a volume (",
                                                      obstacle, "); weir inspect lists them"));
  }
  std::vector<DatasetCandidate> fitting = candidates;
  std::erase_if(fitting, [&](const DatasetCandidate& c) { return c.positions != positions; });
  const std::vector<DatasetCandidate>& left = fitting.empty() ? candidates : fitting;
  if (left.size() > 1) throw several(path, left);
  return find_dataset(file, path, left.front().name);
}

}  // namespace weir
