#include "ingest/source/dataset_info.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {

namespace {

// Returns the axes of `dataset` that options.index_choices give positions on.
const std::vector<LeadingAxis>& axes_to_choose_on(const DatasetInfo& dataset, const SourceOptions& options) {
  if (options.component) return dataset.component_index_axes;
  const std::vector<LeadingAxis>& all = dataset.vector_index_axes;
  const bool takes_all = options.index_choices.size() == all.size() && choices_fit(options.index_choices, all);
  return dataset.components > 1 && takes_all ? all : dataset.index_axes;
}

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += cat(text.empty() ? "" : ", ", name);
  return text;
}

// HDF5 and Zarr treat "/run/density" and "run/density" as the same name.
std::string_view without_slash(std::string_view name) { return name.starts_with('/') ? name.substr(1) : name; }

// Returns the error that says why options.index_choices do not fit `dataset`.
Error unfit(const std::string& path, const DatasetInfo& dataset, const SourceOptions& options) {
  const std::vector<AxisChoice>& choices = options.index_choices;
  const std::vector<LeadingAxis>& axes = axes_to_choose_on(dataset, options);
  const std::string name = dataset.name.empty() ? "the array" : dataset.name;
  for (const AxisChoice& choice : choices) {
    const auto is_it = [&](const std::string& axis) { return axis == choice.axis; };
    if (choice.axis.empty() || std::ranges::any_of(axes, is_it, &LeadingAxis::name)) continue;
    if (std::ranges::any_of(dataset.axis_names, is_it)) {
      return usage_error(compose(path, ": ", option("index"), " names ", choice.axis, ", an axis of the volume ", name,
                                 "; ", option("roi"), " cuts along that"));
    }
    const std::string names = listed(dataset.axis_names);
    return usage_error(compose(path, ": ", option("index"), ": no axis ", choice.axis, "; ", name, " has ",
                               names.empty() ? "axes without names" : names));
  }
  std::string text;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    text += cat(i == 0 ? "" : ", ", axis_name(axes[i].name, i), " of ", axes[i].extent);
  }
  return usage_error(compose(path, ": ", option("index"), " has ", choices.size(),
                             choices.size() == 1 ? " position" : " positions", ", and ", name, " has ",
                             axes.empty() ? "no leading axis" : text, "; weir inspect lists what there is"));
}

// Returns the dataset that options.index_choices choose positions in.
const DatasetInfo& dataset_of_choices(const std::string& path, const std::vector<DatasetInfo>& datasets,
                                      const SourceOptions& options) {
  const std::vector<AxisChoice>& choices = options.index_choices;
  const std::string& name = options.dataset;
  std::vector<const DatasetInfo*> volumes;
  std::vector<const DatasetInfo*> fitting;
  for (const DatasetInfo& dataset : datasets) {
    const bool alone = datasets.size() == 1;  // the only dataset is meant even if it has an obstacle
    const bool meant = name.empty() ? alone || (dataset.obstacle.empty() && !dataset.by_name_only)
                                    : without_slash(dataset.name) == without_slash(name);
    if (!meant) continue;
    volumes.push_back(&dataset);
    if (choices_fit(choices, axes_to_choose_on(dataset, options))) fitting.push_back(&dataset);
  }
  const auto is_scalar = [](const DatasetInfo* dataset) { return dataset->components == 1; };
  if (options.component && !std::ranges::all_of(fitting, is_scalar)) std::erase_if(fitting, is_scalar);
  if (fitting.size() == 1) return *fitting.front();
  if (fitting.size() > 1) {
    throw usage_error(compose(path, ": ", option("index"), " fits the axes of several datasets; choose one with ",
                              option("dataset")));
  }
  if (volumes.size() == 1) {
    const DatasetInfo& only = *volumes.front();
    if (!only.obstacle.empty()) throw input_error(only.name.empty() ? path : cat(path, ": ", only.name), only.obstacle);
    throw unfit(path, only, options);
  }
  throw usage_error(compose(path, ": ", option("index"), " has ", choices.size(),
                            choices.size() == 1 ? " position" : " positions",
                            ", and no dataset has such axes; weir inspect lists what there is"));
}

}  // namespace

IndexPositions index_positions(const std::string& path, const std::vector<DatasetInfo>& datasets,
                               const SourceOptions& options) {
  const DatasetInfo& dataset = dataset_of_choices(path, datasets, options);
  const std::vector<LeadingAxis>& axes = axes_to_choose_on(dataset, options);
  const std::string where = dataset.name.empty() ? path : cat(path, ": ", dataset.name);
  return {axes, chosen_positions(where, axes, options.index_choices)};
}

std::vector<DatasetInfo> list_single(const SourceInfo& info, std::string layout) {
  DatasetInfo only;
  only.extents = {info.extent.x, info.extent.y, info.extent.z};
  only.type = scalar_name(info.type);
  only.layout = std::move(layout);
  return {only};
}

}  // namespace weir
