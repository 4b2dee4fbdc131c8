#include "tools/view/steps/viewed_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <span>

#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/digest.h"
#include "format/nanovdb/nvdb_file.h"
#include "ingest/files/numbered_series.h"
#include "ingest/source/convert_command.h"
#include "ingest/source_registry.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

bool is_directory(const std::string& path) {
  std::error_code none;
  return fs::is_directory(path, none);
}

std::string title_of(const std::string& input) {
  const fs::path path(input);
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

// Moves `step` to the front; the others keep their order.
void begin_with(ViewedFiles& files, std::size_t step) {
  const auto put_first = [&](std::vector<std::string>& paths) {
    const auto at = paths.begin() + static_cast<std::ptrdiff_t>(step);
    std::rotate(paths.begin(), at, at + 1);
  };
  put_first(files.steps);
  if (files.against.size() > 1) put_first(files.against);
}

}  // namespace

std::vector<std::string> find_steps(const StepChoice& choice) {
  const std::string& input = choice.input;
  std::error_code none;
  // A directory may also be an input, for example a Zarr array.
  const bool directory = is_directory(input);
  const std::string pattern = directory ? (fs::path(input) / "*.nvdb").string() : input;
  std::vector<std::string> files;
  try {
    if (choice.series && !directory) files = files_of_series(input);
    if (files.empty()) files = expand_volumes(std::array{pattern});
  } catch (const Error& error) {
    if (!directory || error.kind() != ErrorKind::input) throw;
    throw input_error(input, cat("holds no .nvdb file; weir convert makes them of what it holds: weir convert ",
                                 shell_word(input + "/*"), " -o ", shell_word(input + '/')));
  }
  for (const std::string& file : files) {
    if (!file.ends_with(".nvdb") && fs::exists(file, none) && !is_nanovdb(file)) {
      throw Error(ErrorKind::usage,
                  cat(file, ": is no NanoVDB file; convert it first: weir convert ", shell_word(file)));
    }
  }
  return files;
}

std::size_t volumes_held(const ViewedFiles& files) {
  const std::size_t steps = files.series() ? 2 : 1;  // the step that is shown, and the next step
  return steps + (files.against.empty() ? 0 : files.against.size() > 1 ? 2 : 1);
}

// For a series the key is the same for any of its files.
std::string viewed_key(const StepChoice& choice, const std::string& against) {
  if (choice.series && against.empty() && !is_directory(choice.input)) return series_digest(choice.input);
  const auto absolute = [](const std::string& path) { return fs::absolute(path).lexically_normal().string(); };
  const std::string named = cat(absolute(choice.input), '\n', against.empty() ? "" : absolute(against));
  return piece_digest(std::as_bytes(std::span(named))).hex();
}

ViewedFiles find_viewed_files(const StepChoice& choice, const std::string& against) {
  ViewedFiles files;
  files.key = viewed_key(choice, against);
  files.choice = choice;
  files.title = title_of(choice.input);
  std::error_code none;
  if (choice.series && choice.input.find_first_of("*?[") != std::string::npos && !fs::exists(choice.input, none)) {
    throw Error(ErrorKind::usage, compose(option("series"), cat(" is of one file, and ", choice.input,
                                                                " is a series by itself; leave it out")));
  }
  files.steps = find_steps(choice);
  if (!against.empty()) files.against = find_steps({against});
  if (files.against.size() > 1 && files.against.size() != files.steps.size()) {
    throw Error(ErrorKind::usage,
                compose(option("against", against), cat(" has ", files.against.size(), " files, ", choice.input,
                                                        " has ", files.steps.size(), "; give one file, or as many")));
  }
  for (const std::string& step : files.steps) files.heads.look_at(step);
  const bool single = !choice.series && files.steps == std::vector{choice.input};
  files.grow = !single && files.against.size() <= 1;
  // The named file gets the first number, because viewers see that step first.
  const auto named = std::find(files.steps.begin(), files.steps.end(), choice.input);
  if (choice.series && !is_directory(choice.input)) {
    if (named == files.steps.end()) {
      throw input_error(choice.input,
                        cat("is not there; name another file of its series, such as ", files.steps.front()));
    }
    begin_with(files, static_cast<std::size_t>(named - files.steps.begin()));
  }
  return files;
}

std::vector<std::string> begin_with_readable(ViewedFiles& files) {
  if (files.against.size() == 1) const NvdbFile comparable(files.against.front());
  const bool named = files.choice.series && !is_directory(files.choice.input);
  std::vector<std::string> faults;
  for (std::size_t step = 0;; ++step) {
    try {
      const NvdbFile readable(files.steps[step]);
      if (files.against.size() > 1) const NvdbFile comparable(files.against[step]);
      begin_with(files, step);
      return faults;
    } catch (const Error& error) {
      if (named || step + 1 == files.steps.size()) throw;
      faults.emplace_back(error.what());
    }
  }
}

bool lies_elsewhere(const ViewedFiles& files) {
  if (files.against.empty()) return false;
  return !summarise_series(std::array{files.steps.front(), files.against.front()}).difference.empty();
}

}  // namespace weir
