#include "daemon/config/own_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <string_view>
#include <vector>

#include "format/base/text.h"
#include "format/io/real_path.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 3> kJournals{"-wal", "-shm", "-journal"};

struct WrittenFile {
  std::string key;
  std::string path;
  bool beside = false;  ///< a file made beside the one that the key names
};

std::vector<WrittenFile> written_files(const ServiceConfig& service) {
  std::vector<WrittenFile> files{{"state", service.state},
                                 {"log", service.log_file},
                                 {"port_file", service.port_file},
                                 {"control_socket", service.control_socket}};
  std::erase_if(files, [](const WrittenFile& file) { return file.path.empty(); });
  for (const std::string_view journal : kJournals) files.push_back({"state", cat(service.state, journal), true});
  if (!service.port_file.empty()) files.push_back({"port_file", service.port_file + ".new", true});
  if (!service.control_socket.empty()) files.push_back({"control_socket", service.control_socket + ".lock", true});
  return files;
}

// Returns by real path what each file is that the service reads.
std::map<fs::path, std::string> read_files(const DaemonConfig& config) {
  std::map<fs::path, std::string> files{{real_path(config.path), "this file"}};
  if (!config.service.token_file.empty()) files.emplace(real_path(config.service.token_file), "the token_file");
  for (const WatchConfig& watch : config.watches) {
    if (const auto scene = watch.convert_option("scene"))
      files.emplace(real_path(*scene), cat("the scene of the watch \"", watch.label, "\""));
  }
  return files;
}

// Log rotation renames weir.log to weir.1.log, and weir.1.log to weir.2.log.
NumberedFiles rotated_logs(const fs::path& log) {
  return {(log.parent_path() / log.stem()).string() + ".", log.extension().string(), false};
}

}  // namespace

std::optional<OwnFileConflict> find_own_file_conflict(const DaemonConfig& config) {
  const std::map<fs::path, std::string> read = read_files(config);
  std::map<fs::path, WrittenFile> written;
  for (const WrittenFile& file : written_files(config.service)) {
    const fs::path real = real_path(file.path);
    if (const auto at = read.find(real); at != read.end()) {
      const char* const is = file.beside ? " makes a file beside it that is " : " is ";
      return OwnFileConflict{file.key, cat(file.key, is, at->second, ", ", file.path, "; choose another name")};
    }
    const auto [other, is_new] = written.emplace(real, file);
    if (is_new) continue;
    if (!file.beside) {
      return OwnFileConflict{"", cat("two of state, log, port_file and control_socket are one file, ", file.path)};
    }
    return OwnFileConflict{other->second.key, cat(other->second.key, " is a file that ", file.key,
                                                  " makes beside its own, ", file.path, "; choose another name")};
  }
  return std::nullopt;
}

void exclude_own_files(DaemonConfig& config) {
  const ServiceConfig& service = config.service;
  std::vector<std::string> own{config.path, service.work_dir};
  for (const WrittenFile& file : written_files(service)) own.push_back(file.path);
  for (const WatchConfig& watch : config.watches) own.push_back(watch.output);
  std::sort(own.begin(), own.end());
  own.erase(std::unique(own.begin(), own.end()), own.end());
  std::vector<NumberedFiles> numbered{{service.state + ".corrupt-", "", true}};
  if (!service.log_file.empty()) numbered.push_back(rotated_logs(service.log_file));
  std::erase(own, "");
  // Each path is resolved once, because there may be as many as watches.
  std::vector<fs::path> real(own.size());
  std::ranges::transform(own, real.begin(), real_path);
  std::vector<fs::path> real_numbered(numbered.size());
  std::ranges::transform(numbered, real_numbered.begin(), real_path, &NumberedFiles::before);
  for (WatchConfig& watch : config.watches) {
    const fs::path directory = real_path(watch.directory);
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (lies_below(real[i], directory)) watch.excluded_paths.push_back(own[i]);
    }
    for (std::size_t i = 0; i < numbered.size(); ++i) {
      if (lies_below(real_numbered[i], directory)) watch.excluded_numbers.push_back(numbered[i]);
    }
  }
}

}  // namespace weir
