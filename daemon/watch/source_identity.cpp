#include "daemon/watch/source_identity.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "daemon/store/file_identity.h"
#include "daemon/watch/store_quiet.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "format/io/digest.h"
#include "ingest/files/input_directory.h"
#include "ingest/zarr/metadata/zarr_json.h"

namespace weir {
namespace {

constexpr std::array kMetadata{"zarr.json", ".zarray", ".zgroup", ".zattrs", ".zmetadata"};
/// Larger documents are taken for groups, which may hold the metadata of all their members. If such a
/// document is an array after all, its directory is listed in vain, and nothing is missed.
constexpr std::size_t kMostArrayBytes = std::size_t{16} << 10U;

bool exists(const std::string& path) {
  struct stat status {};
  return ::stat(path.c_str(), &status) == 0;
}

bool is_node(const std::string& directory) {
  return exists(directory + "/zarr.json") || exists(directory + "/.zarray") || exists(directory + "/.zgroup");
}

/// Returns whether the metadata in `directory` are those of an array, which holds only chunks.
bool is_array(const std::string& directory) {
  if (exists(directory + "/.zarray")) return true;
  const std::string document = directory + "/zarr.json";
  struct stat status {};
  if (::stat(document.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return false;
  if (static_cast<std::uint64_t>(status.st_size) > kMostArrayBytes) return false;
  std::string text(static_cast<std::size_t>(status.st_size), '\0');
  std::ifstream file(document, std::ios::binary);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  try {
    return json_string(parse_zarr_json(text, document), "node_type") == "array";
  } catch (const Error&) {  // the document may still be being written
    return false;
  }
}

/// Returns the entries directly in `directory`, sorted by name, that may be groups and arrays. Returns none if the
/// directory cannot be listed completely or has more than `entries` entries. Subtracts the listed entries from
/// `entries`.
std::set<std::string> directories_in(const std::string& directory, std::size_t& entries) {
  std::set<std::string> found;
  std::error_code error;  // a directory that may not be listed cannot be converted either
  for (std::filesystem::directory_iterator entry(directory, error), end; !error && entry != end;
       entry.increment(error)) {
    if (entries == 0) return {};
    --entries;
    std::error_code unknown;
    if (!entry->is_regular_file(unknown)) found.insert(entry->path().string());
  }
  return error ? std::set<std::string>() : found;
}

/// Adds the groups and arrays in `top`, the outer ones first, until `nodes` has kMostWatchedNodes or `entries` are
/// listed.
void add_nodes_in(const std::string& top, std::size_t& entries, std::set<std::string>& nodes) {
  std::vector<std::string> groups{top};
  while (!groups.empty()) {
    std::vector<std::string> inner;
    for (const std::string& group : groups) {
      if (is_array(group)) continue;
      for (const std::string& directory : directories_in(group, entries)) {
        if (!is_node(directory)) continue;
        if (nodes.size() >= kMostWatchedNodes && !nodes.contains(directory)) return;
        nodes.insert(directory);
        inner.push_back(directory);
      }
      if (entries == 0) return;
    }
    groups = std::move(inner);
  }
}

/// Returns the directory `store`, the directories on the way to the datasets that the options name, and the groups
/// and arrays in these. If a name is a pattern, or none is given, returns all groups and arrays in the store.
std::set<std::string> node_directories(const std::string& store, const std::vector<std::string>& convert_options) {
  std::set<std::string> directories{store};
  std::vector<std::string> tops;
  for (const std::string& option : convert_options) {
    constexpr std::array kNaming{"--dataset=", "--magnitude="};
    const auto naming = std::find_if(kNaming.begin(), kNaming.end(), [&](auto key) { return option.starts_with(key); });
    if (naming == kNaming.end()) continue;
    for (const std::string& dataset : split(option.substr(std::string_view(*naming).size()), ',')) {
      std::string directory = store;
      for (const std::string& name : split(dataset, '/')) {
        if (name.empty()) continue;
        directory += '/' + name;
        directories.insert(directory);
      }
      tops.push_back(dataset.find_first_of("*?[") == std::string::npos ? directory : store);
    }
  }
  if (tops.empty()) tops.push_back(store);
  std::size_t entries = kMostListedEntries;
  for (const std::string& top : tops) add_nodes_in(top, entries, directories);
  return directories;
}

}  // namespace

std::optional<FileIdentity> identify_source(const std::string& path, const std::vector<std::string>& convert_options) {
  std::optional<FileIdentity> identity = identify(path);
  if (!identity || identity->bytes == 0 || !is_store_head(path)) return identity;
  std::vector<std::uint64_t> states;
  for (const std::string& directory : node_directories(std::string(named_by_head(path)), convert_options)) {
    for (const char* const name : kMetadata) {
      const std::string file = cat(directory, '/', name);
      FileIdentity state;
      struct stat status {};
      if (::stat(file.c_str(), &status) == 0) {
        state = identity_of(status);
      } else if (!says_missing(errno)) {
        return std::nullopt;
      }
      states.insert(states.end(), {state.bytes, static_cast<std::uint64_t>(state.mtime_ns), state.inode});
      if (file == path) continue;
      identity->bytes += state.bytes;
      identity->mtime_ns = std::max(identity->mtime_ns, state.mtime_ns);
    }
  }
  const Digest digest = piece_digest(std::as_bytes(std::span(states)));
  std::memcpy(&identity->inode, digest.bytes.data(), sizeof identity->inode);
  identity->inode >>= 1U;  // SQLite's integers are signed
  return identity;
}

}  // namespace weir
