#include "tools/view/viewed_files.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/source/convert_command.h"
#include "ingest/source_registry.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> files_of(const std::string& input) {
  std::error_code none;
  const bool directory = fs::is_directory(input, none);
  // A directory may be an input, as a Zarr array is.
  const std::string pattern = directory ? (fs::path(input) / "*.nvdb").string() : input;
  std::vector<std::string> files;
  try {
    files = expand_volumes(std::array{pattern});
  } catch (const Error& error) {
    if (!directory || error.kind() != ErrorKind::input) throw;
    throw input_error(input, cat("holds no .nvdb file; weir convert makes them of what it holds"));
  }
  for (const std::string& file : files) {
    if (!file.ends_with(".nvdb") && fs::exists(file, none) && format_of(file).name != "nvdb") {
      throw Error(ErrorKind::usage,
                  cat(file, ": is no NanoVDB file; convert it first: weir convert ", shell_word(file)));
    }
  }
  return files;
}

std::string title_of(const std::string& input) {
  const fs::path path(input);
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

}  // namespace

ViewedFiles find_viewed_files(const std::string& input, const std::string& against) {
  ViewedFiles files;
  files.title = title_of(input);
  files.steps = files_of(input);
  if (!against.empty()) files.against = files_of(against);
  if (files.against.size() > 1 && files.against.size() != files.steps.size()) {
    throw Error(ErrorKind::usage,
                compose(option("against", against), cat(" has ", files.against.size(), " files, ", input, " has ",
                                                        files.steps.size(), "; give one file, or as many")));
  }
  files.summary = summarise_series(files.steps);
  return files;
}

}  // namespace weir
