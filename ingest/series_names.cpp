#include "ingest/series_names.h"
#include "ingest/files/input_directory.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/headers/number_pattern.h"
#include "ingest/source_registry.h"

namespace weir {
namespace {

// Returns the dataset's name as a part of a file's name: no leading slashes, and dots for slashes.
std::string dataset_part(std::string dataset) {
  dataset.erase(0, dataset.find_first_not_of('/'));
  std::replace(dataset.begin(), dataset.end(), '/', '.');
  return dataset;
}

// Returns the file and the volume in it, for messages.
std::string volume_text(const SeriesStep& step) {
  std::string text = step.path;
  if (!step.dataset.empty()) text += ": " + step.dataset;
  for (const std::int64_t& i : step.index) text += cat(&i == step.index.data() ? " at " : ",", i);
  if (step.level) text += cat(", level ", *step.level);
  return text;
}

// Returns "NAME_level_1.nvdb" for "NAME.nvdb". Returns `name` unchanged if `step` is no level.
std::string with_level(const std::string& name, const SeriesStep& step) {
  if (!step.from_finest) return name;
  constexpr std::string_view kEnd = ".nvdb";
  const bool ends = name.ends_with(kEnd);
  return cat(ends ? name.substr(0, name.size() - kEnd.size()) : name, "_level_", *step.from_finest, ends ? kEnd : "");
}

// Returns the shortest default name that tells the steps of one file apart.
std::string name_in_call(const SeriesStep& step, std::span<const SeriesStep> steps) {
  for (const char* name : {"{stem}.nvdb", "{stem}_{step}.nvdb", "{stem}_{dataset}.nvdb"}) {
    std::set<std::string> names;
    std::size_t count = 0;
    for (const SeriesStep& other : steps) {
      if (other.path != step.path) continue;
      names.insert(with_level(step_name(name, other), other));
      ++count;
    }
    if (names.size() == count) return step_name(name, step);
  }
  return step_name(step.step.empty() ? "{stem}_{dataset}.nvdb" : "{stem}_{dataset}_{step}.nvdb", step);
}

// Returns the extents of the axes that step.index has positions on; empty if they are not known.
std::vector<std::int64_t> chosen_axes(const DatasetInfo& dataset, const SeriesStep& step) {
  std::vector<std::int64_t> extents;
  if (step.index.size() == dataset.index_axes.size()) {
    for (const LeadingAxis& axis : dataset.index_axes) extents.push_back(axis.extent);
  } else if (dataset.extents.size() > step.index.size()) {  // the components are the voxels along x
    extents.assign(dataset.extents.begin(), dataset.extents.begin() + static_cast<std::ptrdiff_t>(step.index.size()));
  }
  return extents;
}

// Returns the positions as a part of a file's name. Axes with one element are left out, because they leave no choice.
std::string position_part(const DatasetInfo& dataset, const SeriesStep& step) {
  const std::vector<std::int64_t> extents = chosen_axes(dataset, step);
  std::string part;
  for (std::size_t axis = 0; axis < step.index.size(); ++axis) {
    const std::int64_t extent = axis < extents.size() ? extents[axis] : 0;
    if (extent != 1) part = joined_name(part, padded_number(step.index[axis], extent - 1));
  }
  return part;
}

// Returns "x" for a vector in space, "4" for a tensor.
std::string component_part(const DatasetInfo& dataset, const ComponentChoice& choice) {
  std::int64_t count = dataset.components;
  if (count == 1 && !dataset.index_axes.empty())
    count = dataset.index_axes.back().extent;  // before the last three axes
  const bool letter = !choice.magnitude && count <= 3 && choice.position < 3;
  return letter ? std::string("xyz").substr(static_cast<std::size_t>(choice.position), 1) : component_text(choice);
}

bool meant_by(const SeriesStep& step, const DatasetInfo& dataset) {
  if (!step.dataset.empty()) return dataset.name == step.dataset || dataset.name == '/' + step.dataset;
  const std::size_t positions = step.index.size();
  // With one more position, the components become the voxels along x.
  const bool with_components = dataset.components > 1 && positions + 3 == dataset.extents.size();
  return dataset.obstacle.empty() && !dataset.by_name_only &&
         (positions == 0 || positions == dataset.leading_axes || positions == dataset.index_axes.size() ||
          with_components);
}

// Returns the dataset that `step` opens, or null if it is unclear.
const DatasetInfo* opened(const std::vector<DatasetInfo>& datasets, const SeriesStep& step, bool component) {
  std::vector<const DatasetInfo*> meant;
  for (const DatasetInfo& dataset : datasets) {
    if (meant_by(step, dataset)) meant.push_back(&dataset);
  }
  const auto is_scalar = [](const DatasetInfo* dataset) { return dataset->components == 1; };
  if (component && !std::ranges::all_of(meant, is_scalar)) std::erase_if(meant, is_scalar);
  return meant.size() == 1 ? meant.front() : nullptr;
}

/// Makes default names from the contents of the files. Lists each file once.
class FileNames {
 public:
  explicit FileNames(const SourceOptions& options) : options_(options) {}

  /// Returns nullopt if the file cannot be listed (opening it reports the error) or if its dataset is unclear.
  std::optional<std::string> name_of(const SeriesStep& step) {
    if (!options_.magnitude.empty()) return of_magnitude(step);
    const bool chosen = !step.dataset.empty() || !step.index.empty() || options_.component || options_.level;
    if (options_.stack || !chosen) return step.stem + ".nvdb";
    try {
      const std::vector<DatasetInfo>& datasets = datasets_of(step.path);
      const DatasetInfo* const dataset = opened(datasets, step, options_.component.has_value());
      if (dataset == nullptr) return std::nullopt;
      const auto volumes = std::ranges::count_if(datasets, [&](const DatasetInfo& d) {
        return d.obstacle.empty() && (!d.by_name_only || !step.dataset.empty());
      });
      std::string name = step.stem;
      if (volumes > 1) name = joined_name(name, dataset_part(dataset->name));
      if (options_.component) name = joined_name(name, component_part(*dataset, *options_.component));
      if (options_.level) name = joined_name(name, cat("level", *options_.level));
      return joined_name(name, position_part(*dataset, step)) + ".nvdb";
    } catch (const Error&) {
      return std::nullopt;
    }
  }

 private:
  std::optional<std::string> of_magnitude(const SeriesStep& step) {
    SeriesStep first = step;
    first.dataset = options_.magnitude.front();
    try {
      const DatasetInfo* const dataset = opened(datasets_of(step.path), first, false);
      if (dataset == nullptr) return std::nullopt;
      std::string name = step.stem;
      for (const std::string& component : options_.magnitude) name = joined_name(name, dataset_part(component));
      return joined_name(joined_name(name, "magnitude"), position_part(*dataset, step)) + ".nvdb";
    } catch (const Error&) {
      return std::nullopt;
    }
  }

  const std::vector<DatasetInfo>& datasets_of(const std::string& path) {
    const auto known = datasets_.find(path);
    if (known != datasets_.end()) return known->second;
    const SourceFormat& format = format_of(path);
    return datasets_[path] = format.container ? format.list(path, options_) : std::vector<DatasetInfo>();
  }

  const SourceOptions& options_;
  std::map<std::string, std::vector<DatasetInfo>> datasets_;
};

constexpr std::array<const char*, 3> kNameWords{"{stem}", "{dataset}", "{step}"};

void refuse_words_of_directory(const std::string& output, std::string_view directory) {
  for (const char* word : kNameWords) {
    if (directory.find(word) == std::string_view::npos) continue;
    throw usage_error(compose(option("output", output), ": ", word,
                              " stands for something in a file's name only, and this is a directory's; give "
                              "DIRECTORY/{stem}.nvdb, or DIRECTORY/ alone"));
  }
}

void require_step(const std::string& output, std::string_view name, const SeriesStep& step) {
  if (name.find("{step}") == std::string_view::npos || !step.step.empty()) return;
  throw usage_error(compose(option("output", output), ": ", volume_text(step), " has no {step}: a pattern with %d, ",
                            "'run_%d.raw', or a range of ", option("index"),
                            " gives one, * and lists do not; use {stem}, or such a pattern"));
}

// Throws Error(usage) if `step` has no dataset and {dataset} leaves the name `path` empty or only an extension, which
// would make it a hidden file.
void require_stem(const std::string& output, std::string_view name, const SeriesStep& step, const std::string& path) {
  const std::string made = path.substr(path.rfind('/') + 1);
  const bool is_bare = made.empty() || (made.front() == '.' && made.find('.', 1) == std::string::npos);
  if (!is_bare || name.find("{dataset}") == std::string_view::npos || !step.dataset.empty()) return;
  const std::string would = made.empty() ? "there would be no name" : cat("the name would be ", made);
  throw Error(ErrorKind::usage, compose(option("output", output), ": ", volume_text(step), " has no {dataset}, so ",
                                        would, "; use {stem} or a plain name"));
}

// Returns advice for two steps that would share a name. If their words are all equal, no name can tell them apart.
Message remedy_for_names(const SeriesStep& a, const SeriesStep& b) {
  std::string words;  // words that both steps have and that differ between them
  for (const char* word : kNameWords) {
    const std::string of_a = step_name(word, a);
    const std::string of_b = step_name(word, b);
    if (!of_a.empty() && !of_b.empty() && of_a != of_b) words += cat(words.empty() ? "" : " or ", word);
  }
  if (!words.empty()) {
    return compose("give ", option("output"), " a directory, with a slash at its end, or a name with ", words);
  }
  const Message dataset = a.dataset == b.dataset ? Message() : compose(option("dataset"), " and ");
  return compose("convert them one at a time, with ", dataset, option("output", "NAME.nvdb"));
}

}  // namespace

std::string step_name(std::string_view name, const SeriesStep& step) {
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
    result += word == "stem" ? step.stem : word == "dataset" ? dataset_part(step.dataset) : step.step;
    name.remove_prefix(close + 1);
  }
  return result;
}

std::vector<std::string> series_outputs(std::span<const SeriesStep> steps, const std::string& output,
                                        const SourceOptions& options, DefaultNames names) {
  const bool directory = output.ends_with('/') || (steps.size() > 1 && std::filesystem::is_directory(output));
  const std::size_t directory_end = output.rfind('/') + 1;
  const std::string name = output.substr(directory_end);
  refuse_words_of_directory(output, std::string_view(output).substr(0, directory_end));
  FileNames of_file(options);
  const auto default_name = [&](const SeriesStep& step) {
    const auto by_file = names == DefaultNames::of_file ? of_file.name_of(step) : std::nullopt;
    return by_file ? *by_file : name_in_call(step, steps);
  };
  std::map<std::string, const SeriesStep*> taken;
  std::vector<std::string> paths;
  for (const SeriesStep& step : steps) {
    std::filesystem::path path = output.substr(0, directory_end) + step_name(name, step);
    if (output.empty()) path = std::filesystem::path(named_by_head(step.path)).replace_filename(default_name(step));
    if (directory) path /= default_name(step);
    path = with_level(path.string(), step);
    require_step(output, name, step);
    require_stem(output, name, step, path.string());
    const auto [other, is_new] = taken.emplace(path.lexically_normal().string(), &step);
    if (!is_new) {
      throw Error(ErrorKind::usage, compose(path.string(), ": ", steps.size(), " volumes, and two of them (",
                                            volume_text(*other->second), " and ", volume_text(step),
                                            ") would have this name; ", remedy_for_names(*other->second, step)));
    }
    paths.push_back(path.string());
  }
  return paths;
}

}  // namespace weir
