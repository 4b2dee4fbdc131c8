#include "tools/view/convert/scene_conversion.h"

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>

#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/real_path.h"
#include "ingest/files/file_state.h"
#include "ingest/source/convert_command.h"

namespace weir {

namespace {

namespace fs = std::filesystem;

// No option, whatever it begins with.
std::string as_path(const std::string& path) { return path.starts_with('-') ? "./" + path : path; }

std::string named_source(const std::string& volume, const Sidecar& sidecar) {
  std::error_code failure;
  // Relative to where the conversion was started, which may well be where this program was: the very file, then.
  const std::string& recorded = sidecar.source.path;
  struct stat status {};
  if (::stat(recorded.c_str(), &status) == 0 && S_ISREG(status.st_mode) &&
      utc_text(state_of(recorded, status).mtime_ns) == sidecar.source.mtime &&
      static_cast<std::uint64_t>(status.st_size) == sidecar.source.bytes) {
    return recorded;
  }
  std::string path = (fs::path(volume).parent_path() / recorded).string();
  const bool directory = fs::is_directory(path, failure);
  if (!is_there(path) || (!directory && fs::file_size(path, failure) != sidecar.source.bytes)) {
    throw input_error(path, cat("is not the source of ", volume, ", which had ", sidecar.source.bytes,
                                " bytes; put it there, or convert it again from where it is"));
  }
  return path;
}

}  // namespace

SceneConversion scene_conversion(const std::string& volume, const std::string& source, const Sidecar& sidecar,
                                 const ConvertRequest& request) {
  const std::string read = source.empty() ? named_source(volume, sidecar) : source;
  fs::path beside(source.empty() ? volume : source);
  if (!beside.has_filename()) beside = beside.parent_path();
  SceneConversion conversion;
  conversion.output = as_path((beside.parent_path() / (fs::path(volume).stem().string() + "_scene.nvdb")).string());
  std::vector<std::string>& words = conversion.arguments;
  words = {"convert", as_path(read)};
  for (const ConversionOption& option : input_options()) {
    const auto given = sidecar.weir.options.find(std::string(option.row.key));
    if (given == sidecar.weir.options.end() || given->second.empty()) continue;
    if (option.row.flag() && given->second != "true") continue;
    words.push_back(cat("--", option.row.key));
    if (!option.row.flag()) words.push_back(given->second);
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
