#include "ingest/dataset_pattern.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstddef>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/left_out.h"

namespace weir {
namespace {

constexpr std::size_t kMostLeftOut = 8;  // how many datasets an error message lists

std::string positions_text(std::size_t count) { return cat(count, count == 1 ? " position" : " positions"); }

// "the leading axes time of 3, member of 10", or "the leading axis 0 of 3".
std::string leading_text(const DatasetInfo& dataset) {
  std::string text = dataset.index_axes.size() == 1 ? "the leading axis " : "the leading axes ";
  for (std::size_t i = 0; i < dataset.index_axes.size(); ++i) {
    const LeadingAxis& axis = dataset.index_axes[i];
    text += cat(i == 0 ? "" : ", ", axis.name.empty() ? cat(i) : axis.name, " of ", axis.extent);
  }
  return text;
}

// Returns why `options` make no volume of a dataset without an obstacle, and which options do. Returns an empty
// message if they make one.
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

// "/a: WHY; /b: WHY; and 3 more".
Message several_text(std::span<const Message> datasets) {
  Message text;
  for (std::size_t i = 0; i < std::min(datasets.size(), kMostLeftOut); ++i) {
    text += compose(i == 0 ? "" : "; ", datasets[i]);
  }
  if (datasets.size() > kMostLeftOut) text += cat("; and ", datasets.size() - kMostLeftOut, " more");
  return text;
}

/// The datasets that a pattern matches: the names of volumes, and "/v: WHY" for all others.
struct Matches {
  std::vector<std::string> volumes;
  std::vector<Message> others;        ///< other options make volumes of these
  std::vector<Message> by_name_only;  ///< mentioned only if nothing else matches
  std::vector<Message> unread;        ///< only their obstacle keeps these from being volumes
  std::vector<Message> no_volumes;    ///< of other shapes, with an obstacle; mentioned only if nothing else matches

  void add(const DatasetInfo& dataset, const SourceOptions& options) {
    if (!dataset.obstacle.empty()) {
      (is_unread_volume(dataset) ? unread : no_volumes).push_back(compose(dataset.name, ": ", dataset.obstacle));
    } else if (dataset.by_name_only) {
      by_name_only.push_back(compose(dataset.name, ": it is read only where ", option("dataset"), " names it"));
    } else if (const Message why = left_out(dataset, options); !why.empty()) {
      others.push_back(compose(dataset.name, ": ", why));
    } else {
      volumes.push_back(dataset.name);
    }
  }

  /// Returns the error that says why the pattern stands for no volume.
  Error none(const std::string& path, const std::string& pattern) const {
    const Message begin = compose(path, ": ", option("dataset", pattern), " stands for no volume");
    std::vector<Message> said = others;
    said.insert(said.end(), by_name_only.begin(), by_name_only.end());
    const bool by_options = !said.empty();
    said.insert(said.end(), unread.begin(), unread.end());
    if (by_options) return usage_error(compose(begin, " with these options: ", several_text(said)));
    said.insert(said.end(), no_volumes.begin(), no_volumes.end());
    if (!said.empty()) return {ErrorKind::input, compose(begin, ": ", several_text(said))};
    return {ErrorKind::input, cat(path, ": no dataset's name matches ", pattern, "; weir inspect lists what there is")};
  }
};

}  // namespace

bool names_dataset(const std::string& pattern, const std::string& name) {
  return name == pattern || name == '/' + pattern || ::fnmatch(pattern.c_str(), name.c_str(), 0) == 0 ||
         ::fnmatch(('/' + pattern).c_str(), name.c_str(), 0) == 0;
}

std::vector<std::string> matching_datasets(const std::string& path, std::span<const DatasetInfo> datasets,
                                           const std::string& pattern, const SourceOptions& options,
                                           const Notice& notice) {
  Matches matches;
  for (const DatasetInfo& dataset : datasets) {
    if (dataset.name == pattern || dataset.name == '/' + pattern) return {dataset.name};
    if (names_dataset(pattern, dataset.name)) matches.add(dataset, options);
  }
  if (matches.volumes.empty()) throw matches.none(path, pattern);
  for (const std::vector<Message>& of_kind : {matches.others, matches.unread}) {
    for (const Message& other : of_kind) {
      if (notice) notice(compose(path, ": left out: ", other));
    }
  }
  return matches.volumes;
}

}  // namespace weir
