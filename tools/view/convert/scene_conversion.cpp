#include "tools/view/convert/scene_conversion.h"

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <vector>

#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "ingest/files/file_state.h"
#include "ingest/source/convert_command.h"
#include "tools/report/recorded_input.h"

namespace weir {

namespace {

namespace fs = std::filesystem;

// Returns `path` so that it cannot be taken for an option.
std::string as_path(const std::string& path) { return path.starts_with('-') ? "./" + path : path; }

// Returns whether the file at `path` matches the sidecar by size and time. A directory only has to exist, and one file
// among several only needs the size: the sidecar records nothing more that can be checked quickly.
bool is_source_of(const std::string& path, const Sidecar& sidecar) {
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) return false;
  if (S_ISDIR(status.st_mode)) return true;
  const bool same_size = static_cast<std::uint64_t>(status.st_size) == sidecar.source.bytes;
  return same_size &&
         (!sidecar.source.files_digest.empty() || utc_text(state_of(path, status).mtime_ns) == sidecar.source.mtime);
}

std::string named_source(const std::string& volume, const Sidecar& sidecar) {
  // Tries the place of that time first, if it is one file about which more than its name is known. Then tries the
  // recorded path relative to this process, which may have the same working directory, and relative to the volume, if
  // both were moved.
  const std::string& recorded = sidecar.source.path;
  const fs::path real = sidecar.source.real_path;
  std::error_code not_there;
  const bool by_name = real.filename() == fs::path(recorded).filename() && fs::is_regular_file(real, not_there);
  if (by_name && is_source_of(real.string(), sidecar)) return real.string();
  if (is_source_of(recorded, sidecar)) return recorded;
  std::string path = (fs::path(volume).parent_path() / recorded).string();
  if (is_source_of(path, sidecar)) return path;
  throw input_error(path, cat("is not the source of ", volume, ", which had ", sidecar.source.bytes, " bytes as of ",
                              sidecar.source.mtime, "; put it there, or convert it again from where it is"));
}

// Returns the value of an option with which the volume was read. The typed option may have chosen several volumes
// ("*", "time=*"), so the sidecar's fields come first.
std::string recorded_option(const Sidecar& sidecar, const std::string& key) {
  const auto& given = sidecar.weir.options;
  const bool lengths = given.contains("magnitude");  // the magnitude of several datasets
  if (key == "dataset") return lengths ? "" : sidecar.source.dataset;
  if (key == "component") return lengths ? "" : sidecar.source.component;
  if (key == "index") return index_text(sidecar.source.index);
  const auto found = given.find(key);
  return found == given.end() ? "" : found->second;
}

// Returns "STEM_scene.nvdb" in `directory`, or if it is taken the first free of "STEM_scene_2.nvdb" and so on.
std::string free_output(const fs::path& directory, const std::string& stem) {
  for (int number = 1;; ++number) {
    const std::string path = (directory / cat(stem, "_scene", number == 1 ? "" : cat('_', number), ".nvdb")).string();
    if (!is_there(path) && !is_there(sidecar_path(path))) return as_path(path);
  }
}

}  // namespace

SceneConversion scene_conversion(const std::string& volume, const std::string& source, const Sidecar& sidecar,
                                 const ConvertRequest& request) {
  if (const auto& level = sidecar.source.level) {
    throw input_error(volume, cat("is level ", level->number, " of ", level->count,
                                  ", which no conversion makes alone; convert the source without --levels separate to "
                                  "have a volume of all levels, and view that"));
  }
  const std::string read = source.empty() ? named_source(volume, sidecar) : source;
  fs::path beside(source.empty() ? volume : source);
  if (!beside.has_filename()) beside = beside.parent_path();
  SceneConversion conversion;
  conversion.output = free_output(beside.parent_path(), fs::path(volume).stem().string());
  std::vector<std::string>& words = conversion.arguments;
  words = {"convert", as_path(read)};
  for (const ConversionOption& option : input_options()) {
    const std::string value = recorded_option(sidecar, std::string(option.row.key));
    if (value.empty() || (option.row.flag() && value != "true")) continue;
    words.push_back(cat("--", option.row.key));
    if (!option.row.flag()) words.push_back(value);
  }
  if (sidecar.nonfinite.count > 0) words.insert(words.end(), {"--nonfinite", sidecar.nonfinite.policy});
  words.insert(words.end(), {"--encoding", request.encoding, request.rate ? "--rate" : "--psnr",
                             short_number(request.rate ? *request.rate : request.psnr_db), "-o", conversion.output,
                             "--scene", "scene.toml"});
  conversion.text = "weir";
  for (const std::string& word : words) conversion.text += cat(' ', shell_word(word));
  return conversion;
}

std::vector<std::string> conversion_command(const SceneConversion& conversion, const std::string& scene) {
  std::vector<std::string> words{"weir"};
  words.insert(words.end(), conversion.arguments.begin(), conversion.arguments.end());
  words.back() = scene;
  return words;
}

}  // namespace weir
