#include "ingest/series.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "ingest/headers/number_pattern.h"
#include "ingest/source_registry.h"

namespace weir {
namespace {

std::string padded(std::int64_t number, std::int64_t largest) {
  const std::size_t width = std::to_string(largest).size();
  std::string digits = std::to_string(number);
  return std::string(width - std::min(width, digits.size()), '0') + digits;
}

std::string joined(const std::string& a, const std::string& b) { return a.empty() || b.empty() ? a + b : a + '_' + b; }

std::string stem_of(const std::string& path) {
  const std::filesystem::path stem = std::filesystem::path(path).stem();
  return stem.extension() == ".nii" || stem.extension() == ".raw" ? stem.stem().string() : stem.string();
}

std::vector<SeriesStep> files_of(const std::string& input, bool stack) {
  const auto pattern = NumberPattern::parse(std::filesystem::path(input).filename().string());
  if (!pattern || is_there(input)) return {{input, {}, {}, stem_of(input), {}}};
  if (stack) return {{input, {}, {}, pattern->stem().empty() ? "stack" : pattern->stem(), {}}};
  const std::vector<NumberedFile> files = numbered_files(input);
  std::vector<SeriesStep> steps;
  for (const NumberedFile& file : files) {
    steps.push_back({file.path, {}, {}, stem_of(file.path), padded(file.number, files.back().number)});
  }
  return steps;
}

std::vector<DatasetInfo> datasets_of(const std::string& path, const SourceOptions& options, const Message& asked) {
  const SourceFormat& format = format_of(path);
  if (!format.container) {
    throw Error(ErrorKind::usage, compose(path, ": ", asked, " is for files that hold several volumes, and this is ",
                                          format.name, "; leave it out"));
  }
  return format.list(path, options);
}

// The steps of `file` for a dataset with a running number.
std::vector<SeriesStep> with_datasets(const SeriesStep& file, const SourceOptions& options) {
  const auto pattern = options.stack ? std::nullopt : NumberPattern::parse(options.dataset);
  SeriesStep named = file;
  named.dataset = options.dataset;
  if (!pattern) return {named};
  std::map<std::int64_t, std::string> found;
  for (const DatasetInfo& dataset : datasets_of(file.path, options, compose(option("dataset"), " with a pattern"))) {
    if (dataset.name == options.dataset) return {named};
    if (const auto number = pattern->match(dataset.name)) found[*number] = dataset.name;
  }
  if (found.empty()) {
    throw Error(ErrorKind::input,
                cat(file.path, ": no dataset's name matches ", options.dataset, "; weir inspect lists what there is"));
  }
  std::vector<SeriesStep> steps;
  for (const auto& [number, name] : found) {
    SeriesStep step = file;
    step.dataset = name;
    step.step = joined(file.step, padded(number, found.rbegin()->first));
    steps.push_back(step);
  }
  return steps;
}

const DatasetInfo& chosen(const std::vector<DatasetInfo>& datasets, const SeriesStep& step, std::size_t axes) {
  const DatasetInfo* only = nullptr;
  for (const DatasetInfo& dataset : datasets) {
    const bool fits = step.dataset.empty() ? dataset.obstacle.empty() && dataset.leading_axes == axes
                                           : dataset.name == step.dataset || dataset.name == '/' + step.dataset;
    if (!fits) continue;
    if (only != nullptr) {
      throw Error(ErrorKind::usage, compose(step.path, ": ", option("index"), " has a *, and several datasets have ",
                                            axes, " leading axes; choose one with ", option("dataset")));
    }
    only = &dataset;
  }
  if (only == nullptr || only->leading_axes != axes || only->extents.size() < axes) {
    throw Error(ErrorKind::usage, compose(step.path, ": ", option("index"), " has ", axes, " positions, and ",
                                          only == nullptr ? std::string("no dataset asks for that many")
                                                          : cat(only->name, " asks for ", only->leading_axes),
                                          "; weir inspect lists what there is"));
  }
  return *only;
}

// The steps of `step` for each position that a * stands for.
std::vector<SeriesStep> with_indices(const SeriesStep& step, const SourceOptions& options) {
  SeriesStep at = step;
  at.index = options.index;
  if (std::find(at.index.begin(), at.index.end(), kEveryIndex) == at.index.end()) return {at};
  const std::vector<DatasetInfo> datasets = datasets_of(step.path, options, option("index"));
  const DatasetInfo& dataset = chosen(datasets, step, at.index.size());
  std::vector<SeriesStep> steps{at};
  for (std::size_t axis = 0; axis < at.index.size(); ++axis) {
    if (at.index[axis] != kEveryIndex) continue;
    std::vector<SeriesStep> expanded;
    for (const SeriesStep& before : steps) {
      for (std::int64_t i = 0; i < dataset.extents[axis]; ++i) {
        expanded.push_back(before);
        expanded.back().index[axis] = i;
        expanded.back().step = joined(before.step, padded(i, dataset.extents[axis] - 1));
      }
    }
    steps = std::move(expanded);
  }
  return steps;
}

}  // namespace

std::vector<SeriesStep> expand_series(std::span<const std::string> inputs, const SourceOptions& options) {
  std::vector<SeriesStep> steps;
  for (const std::string& input : inputs) {
    for (const SeriesStep& file : files_of(input, options.stack)) {
      for (const SeriesStep& dataset : with_datasets(file, options)) {
        const auto positions = with_indices(dataset, options);
        steps.insert(steps.end(), positions.begin(), positions.end());
      }
    }
  }
  return steps;
}

std::string step_name(std::string_view name, const SeriesStep& step) {
  std::string dataset = step.dataset;
  dataset.erase(0, dataset.find_first_not_of('/'));
  std::replace(dataset.begin(), dataset.end(), '/', '.');
  std::string result;
  while (!name.empty()) {
    const std::size_t open = std::min(name.find('{'), name.size());
    result += name.substr(0, open);
    name.remove_prefix(open);
    if (name.empty()) break;
    const std::size_t close = name.find('}');
    const std::string_view word = name.substr(1, close == std::string_view::npos ? close : close - 1);
    if (close == std::string_view::npos || (word != "stem" && word != "dataset" && word != "step")) {
      throw Error(ErrorKind::usage, cat(name.substr(0, close), close == std::string_view::npos ? "" : "}",
                                        " in an output's name is not known; there are {stem}, {dataset} and {step}"));
    }
    result += word == "stem" ? step.stem : word == "dataset" ? dataset : step.step;
    name.remove_prefix(close + 1);
  }
  return result;
}

std::vector<std::string> series_outputs(std::span<const SeriesStep> steps, const std::string& output) {
  const bool directory = output.ends_with('/') || (steps.size() > 1 && std::filesystem::is_directory(output));
  std::map<std::string, const SeriesStep*> taken;
  std::vector<std::string> paths;
  for (const SeriesStep& step : steps) {
    const auto of_this_file =
        std::count_if(steps.begin(), steps.end(), [&](const SeriesStep& other) { return other.path == step.path; });
    const std::string name = step_name(of_this_file > 1 ? "{stem}_{step}.nvdb" : "{stem}.nvdb", step);
    const std::size_t directory_end = output.rfind('/') + 1;  // braces in a directory's name are its own
    std::filesystem::path path = output.substr(0, directory_end) + step_name(output.substr(directory_end), step);
    if (output.empty()) path = std::filesystem::path(step.path).replace_filename(name);
    if (directory) path /= name;
    const auto [other, is_new] = taken.emplace(path.lexically_normal().string(), &step);
    if (!is_new) {
      throw Error(ErrorKind::usage,
                  compose(path.string(), ": ", steps.size(), " volumes, and two of them (", other->second->path,
                          " and ", step.path, ") would have this name; give ", option("output"),
                          " a directory, or a name with {stem}, "
                          "{dataset} or {step}"));
    }
    paths.push_back(path.string());
  }
  return paths;
}

}  // namespace weir
