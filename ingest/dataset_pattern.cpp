#include "ingest/dataset_pattern.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstddef>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::size_t kMostLeftOut = 8;  // in an error

std::string positions_text(std::size_t count) { return cat(count, count == 1 ? " position" : " positions"); }

// "the leading axes time of 3, member of 10".
std::string leading_text(const DatasetInfo& dataset) {
  std::string text = dataset.index_axes.size() == 1 ? "the leading axis " : "the leading axes ";
  for (std::size_t i = 0; i < dataset.index_axes.size(); ++i) {
    const LeadingAxis& axis = dataset.index_axes[i];
    text += cat(i == 0 ? "" : ", ", axis.name.empty() ? cat(i) : axis.name, " of ", axis.extent);
  }
  return text;
}

// Why `options` make no volume of a dataset that has no obstacle, and which would; empty where they make one.
Message left_out(const DatasetInfo& dataset, const SourceOptions& options) {
  if (!options.component && dataset.components > 1) {
    return compose("each of its voxels has ", dataset.components, " components; give ", option("component"));
  }
  if (options.component && dataset.components == 1) {
    return compose("its voxels have no components; leave ", option("component"), " out");
  }
  const bool by_choices = !options.index_choices.empty();
  const std::size_t given = by_choices ? options.index_choices.size() : options.index.size();
  if (by_choices ? choices_fit(options.index_choices, dataset.index_axes)
                 : given == dataset.leading_axes || given == dataset.index_axes.size()) {
    return {};
  }
  if (dataset.index_axes.empty()) return compose("it has no leading axis; leave ", option("index"), " out");
  return compose("it has ", leading_text(dataset), "; give ", option("index"), " with ",
                 positions_text(dataset.index_axes.size()));
}

}  // namespace

bool names_dataset(const std::string& pattern, const std::string& name) {
  return name == pattern || name == '/' + pattern || ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0 ||
         ::fnmatch(('/' + pattern).c_str(), name.c_str(), 0) == 0;
}

std::vector<std::string> matching_datasets(const std::string& path, std::span<const DatasetInfo> datasets,
                                           const std::string& pattern, const SourceOptions& options,
                                           const Notice& notice) {
  std::vector<std::string> found;
  std::vector<Message> others;        // "/v: its voxels have no components; ..."
  std::vector<Message> by_name_only;  // said only where there is nothing else
  for (const DatasetInfo& dataset : datasets) {
    if (dataset.name == pattern || dataset.name == '/' + pattern) return {dataset.name};
    if (!dataset.obstacle.empty() || !names_dataset(pattern, dataset.name)) continue;
    if (dataset.by_name_only) {
      by_name_only.push_back(compose(dataset.name, ": it is read only where ", option("dataset"), " names it"));
      continue;
    }
    const Message why = left_out(dataset, options);
    if (why.empty()) {
      found.push_back(dataset.name);
    } else {
      others.push_back(compose(dataset.name, ": ", why));
    }
  }
  if (found.empty()) others.insert(others.end(), by_name_only.begin(), by_name_only.end());
  if (found.empty() && others.empty()) {
    throw Error(ErrorKind::input,
                cat(path, ": no dataset's name matches ", pattern, "; weir inspect lists what there is"));
  }
  if (found.empty()) {
    Message text = compose(path, ": ", option("dataset", pattern), " stands for no volume with these options: ");
    for (std::size_t i = 0; i < std::min(others.size(), kMostLeftOut); ++i)
      text += compose(i == 0 ? "" : "; ", others[i]);
    if (others.size() > kMostLeftOut) text += cat("; and ", others.size() - kMostLeftOut, " more");
    throw usage_error(text);
  }
  for (const Message& other : others) {
    if (notice) notice(compose(path, ": left out: ", other));
  }
  return found;
}

}  // namespace weir
