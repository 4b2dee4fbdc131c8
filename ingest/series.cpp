#include "ingest/series.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>

#include "format/base/ascii.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "ingest/dataset_pattern.h"
#include "ingest/files/file_pattern.h"
#include "ingest/files/input_directory.h"
#include "ingest/headers/number_pattern.h"
#include "ingest/source_registry.h"

namespace weir {
namespace {

std::string extension_of(const std::filesystem::path& name) { return lower_case(name.extension().string()); }

// Returns "run" for "run.zarr" and "run.ome.zarr". A zip file "run.zarr.zip" has the stem "run.zarr", so it gives
// "run", too.
std::string without_zarr(const std::filesystem::path& name) {
  if (extension_of(name) != ".zarr") return name.string();
  const std::filesystem::path stem = name.stem();
  return extension_of(stem) == ".ome" ? stem.stem().string() : stem.string();
}

// Returns the {stem} of `path`. Of a directory's name only Zarr's suffixes are removed. A path that names the head
// file of a directory (a plotfile's Header) stands for the whole directory.
std::string stem_of(const std::string& path) {
  const std::filesystem::path whole(path);
  if (is_input_directory(path)) return without_zarr(whole.filename());
  if (named_by_head(path).size() != path.size()) return without_zarr(whole.parent_path().filename());
  const std::filesystem::path stem = std::filesystem::path(path).stem();
  return extension_of(stem) == ".nii" || extension_of(stem) == ".raw" ? stem.stem().string() : without_zarr(stem);
}

std::vector<SeriesStep> files_of(const std::string& named, bool stack) {
  const std::string input = without_last_slash(named);
  const auto pattern = NumberPattern::parse(std::filesystem::path(input).filename().string());
  if (pattern && stack && !is_there(input)) {
    return {{input, {}, {}, pattern->stem().empty() ? "stack" : pattern->stem(), {}, {}}};
  }
  std::vector<SeriesStep> steps;
  if (is_file_pattern(input)) {
    for (const std::string& match : matching_files(input)) {
      const std::string path = without_last_slash(match);
      steps.push_back({path, {}, {}, stem_of(path), {}, {}});
    }
  } else if (pattern && !is_there(input)) {
    const std::vector<NumberedFile> files = numbered_files(input);
    for (const NumberedFile& file : files) {
      steps.push_back({file.path, {}, {}, stem_of(file.path), padded_number(file.number, files.back().number), {}});
    }
  } else {
    steps.push_back({input, {}, {}, stem_of(input), {}, {}});
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

Error no_match(const SeriesStep& file, const std::string& name) {
  return Error(ErrorKind::input,
               cat(file.path, ": no dataset's name matches ", name, "; weir inspect lists what there is"));
}

// Returns the steps of `file` for one line of --dataset.
std::vector<SeriesStep> with_dataset(const SeriesStep& file, const std::string& dataset_name,
                                     const SourceOptions& options, const Notice& notice) {
  const bool shell_pattern = !options.stack && dataset_name.find_first_of("*?[") != std::string::npos;
  const auto pattern = options.stack || shell_pattern ? std::nullopt : NumberPattern::parse(dataset_name);
  SeriesStep named = file;
  named.dataset = dataset_name;
  named.series = dataset_name;
  if (!pattern && !shell_pattern) return {named};
  const auto datasets = datasets_of(file.path, options, compose(option("dataset"), " with a pattern"));
  std::vector<SeriesStep> steps;
  if (shell_pattern) {
    for (const std::string& name : matching_datasets(file.path, datasets, dataset_name, options, notice)) {
      named.dataset = name;
      named.series = name;
      steps.push_back(named);
    }
    return steps;
  }
  std::map<std::int64_t, std::string> found;
  for (const DatasetInfo& dataset : datasets) {
    if (dataset.name == dataset_name) return {named};
    if (const auto number = pattern->match(dataset.name)) found[*number] = dataset.name;
  }
  if (found.empty()) throw no_match(file, dataset_name);
  for (const auto& [number, name] : found) {
    SeriesStep step = named;
    step.dataset = name;
    step.step = joined_name(file.step, padded_number(number, found.rbegin()->first));
    steps.push_back(step);
  }
  return steps;
}

std::vector<SeriesStep> with_datasets(const SeriesStep& file, const SourceOptions& options, const Notice& notice) {
  std::vector<SeriesStep> steps;
  for (const std::string& name : split(options.dataset, '\n')) {
    const std::vector<SeriesStep> of_line = with_dataset(file, name, options, notice);
    steps.insert(steps.end(), of_line.begin(), of_line.end());
  }
  return steps;
}

// Returns the steps of `step`, one for each position that options.index_choices stand for.
std::vector<SeriesStep> with_indices(const SeriesStep& step, const SourceOptions& options) {
  SeriesStep at = step;
  at.index = options.index;
  if (!at.index.empty() || options.index_choices.empty()) return {at};
  SourceOptions of_step = options;
  of_step.dataset = options.magnitude.empty() ? step.dataset : options.magnitude.front();
  const auto [axes, positions] = index_positions(step.path, datasets_of(step.path, options, option("index")), of_step);
  std::vector<SeriesStep> steps;
  for (const std::vector<std::int64_t>& position : positions) {
    steps.push_back(at);
    steps.back().index = position;
    // An axis on which all steps have the same position is left out of the name.
    for (std::size_t axis = 0; axis < position.size(); ++axis) {
      if (positions.front()[axis] == positions.back()[axis]) continue;
      steps.back().step = joined_name(steps.back().step, padded_number(position[axis], axes[axis].extent - 1));
    }
  }
  return steps;
}

// Returns the steps of `step`, one for each level of its file. Formats without levels refuse the option when they are
// opened.
std::vector<SeriesStep> with_levels(const SeriesStep& step, const SourceOptions& options) {
  if (options.levels == Levels::composite) return {step};
  const SourceFormat& format = format_of(step.path);
  if (format.levels == nullptr) return {step};
  const std::int64_t count = format.levels(step.path, options);
  std::vector<SeriesStep> steps;
  for (std::int64_t from_finest = 0; from_finest < count; ++from_finest) {
    SeriesStep at = step;
    at.level = count - 1 - from_finest;
    at.from_finest = from_finest;
    at.series = cat(step.path, '\n', step.series, '\n', from_finest);  // the boxes of a level may differ between files
    steps.push_back(std::move(at));
  }
  return steps;
}

}  // namespace

SourceOptions options_of_step(const SourceOptions& options, const SeriesStep& step) {
  SourceOptions of_step = options;
  of_step.dataset = step.dataset;
  of_step.index = step.index;
  of_step.own_level = step.level;
  return of_step;
}

std::vector<SeriesStep> expand_series(std::span<const std::string> inputs, const SourceOptions& options,
                                      const Notice& notice) {
  std::vector<SeriesStep> steps;
  for (const std::string& input : inputs) {
    for (const SeriesStep& file : files_of(input, options.stack)) {
      for (const SeriesStep& dataset : with_datasets(file, options, notice)) {
        for (const SeriesStep& position : with_indices(dataset, options)) {
          const auto levels = with_levels(position, options);
          steps.insert(steps.end(), levels.begin(), levels.end());
        }
      }
    }
  }
  return steps;
}

}  // namespace weir
