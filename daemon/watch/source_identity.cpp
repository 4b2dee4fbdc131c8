#include "daemon/watch/source_identity.h"

#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <set>
#include <span>
#include <string_view>

#include "daemon/store/file_identity.h"
#include "daemon/watch/store_quiet.h"
#include "format/base/text.h"
#include "format/io/digest.h"
#include "ingest/files/input_directory.h"

namespace weir {
namespace {

constexpr std::array kMetadata{"zarr.json", ".zarray", ".zgroup", ".zattrs", ".zmetadata"};

/// The directory `store`, and those in it on the way to the datasets that the options name.
std::set<std::string> node_directories(const std::string& store, const std::vector<std::string>& convert_options) {
  std::set<std::string> directories{store};
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
    }
  }
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
  identity->inode >>= 1U;  // SQLite's integers have a sign
  return identity;
}

}  // namespace weir
