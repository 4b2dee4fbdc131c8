#include "tools/view/source_preview.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <filesystem>

#include "compressor/build_commit.h"
#include "compressor/conversion.h"
#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/file_system.h"
#include "format/io/real_path.h"
#include "ingest/source/convert_command.h"
#include "ingest/source_registry.h"
#include "tools/command.h"
#include "tools/options/given_options.h"
#include "tools/options/table_options.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRate = "8";

}  // namespace

bool is_source(const std::string& path) {
  if (path.ends_with(".nvdb") || !is_there(path)) return false;
  try {
    return !is_nanovdb(path);
  } catch (const Error&) {  // a directory that is no input, such as one of .nvdb files: find_viewed_files handles it
    return false;
  }
}

std::string dense_words(const std::string& source, const GivenOptions& given) {
  return cat(shell_word(source.starts_with('-') ? "./" + source : source), " --volume dense", input_words(given));
}

SourcePreview::SourcePreview(const std::string& source, const GivenOptions& given, const std::string& work_dir,
                             std::optional<std::uint64_t> memory, const ProgressOptions& shown, Kept kept)
    : folder_(work_dir) {
  fs::path name = fs::path(source);
  if (!name.has_filename()) name = name.parent_path();
  name = name.filename();
  file_ = folder_.path() / (kept == Kept::all ? name += ".nvdb" : name.replace_extension(".nvdb"));
  GivenOptions all{{"encoding", "packed"}, {"nonfinite", "background"}};  // shows what there is, despite NaN
  if (kept == Kept::all) {
    all.emplace("lossless", "true");
  } else {
    all.insert({{"rate", kRate}, {"at-most", "true"}});
  }
  all.insert(given.begin(), given.end());
  auto [source_options, options] = read_conversion_request(all);
  source_options.cancel = &interrupt_flag();
  source_options.spool_directory = folder_.path().string();
  options.output = file_.string();
  options.work_dir = folder_.path().string();
  options.resume = Resume::off;
  if (memory) options.memory = std::max(*memory, kLeastMemory);
  options.provenance = {WEIR_VERSION, build_commit(), recorded_options(given)};
  const auto volume = open_source(source, source_options);
  Progress progress(shown);
  ConversionControl control;
  control.cancel = &interrupt_flag();
  control.pass_started = [&](const std::string& pass, std::uint64_t bytes) { progress.start(pass, bytes); };
  control.pass_advanced = [&](std::uint64_t done) { progress.update(done); };
  control.notice = [](const Message& line) { spdlog::info("{}", line.text()); };
  const auto files = make_posix_file_system();
  convert_volume(*volume, options, control, *files);
  progress.finish();
}

}  // namespace weir
