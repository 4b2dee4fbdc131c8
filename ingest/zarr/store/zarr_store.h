// Where the objects of a Zarr hierarchy are: the files of a directory, or the entries of a zip file. Keys are paths
// within it, "fields/rho/zarr.json", without slashes at the ends; the root's is empty.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/files/file_state.h"

namespace weir {

/// An object that is there. Thread-safe.
class ZarrObject {
 public:
  virtual ~ZarrObject() = default;

  virtual std::uint64_t size() const = 0;
  /// Fills `into` from byte `offset` on; all of it lies inside. Throws Error(input) where the object cannot be read so,
  /// Error(io) where the device fails.
  virtual void read(std::uint64_t offset, std::span<std::byte> into) = 0;
};

/// What is known of an object without reading it.
struct ZarrObjectState {
  std::uint64_t bytes = 0;
  std::int64_t mtime_ns = 0;  ///< since 1970; 0 inside a zip file
  std::int64_t ctime_ns = 0;  ///< since 1970; 0 inside a zip file
};

/// What lies at a key.
struct ZarrFound {
  std::optional<ZarrObjectState> object;
  std::string in_its_place;  ///< where there is no object: what lies there instead, and the remedy; empty: nothing
};

/// Thread-safe.
class ZarrStore {
 public:
  virtual ~ZarrStore() = default;

  /// As messages name it: "run.zarr/rho/c/0/0/1", "run.zip: rho/c/0/0/1".
  virtual std::string shown(std::string_view key) const = 0;
  /// Throws Error(io) where it cannot be told.
  virtual ZarrFound find(const std::string& key) = 0;
  /// nullptr where there is none. Throws Error(input) where it is empty or cannot be read.
  virtual std::unique_ptr<ZarrObject> open(const std::string& key) = 0;
  /// Names of what lies directly below `key` and has something below it, sorted. Throws Error(io).
  virtual std::vector<std::string> groups_in(const std::string& key) = 0;
  /// The file that the object at `key` lies in.
  virtual std::string file_of(const std::string& key) const = 0;
  /// Whether all objects lie in one file, the zip file.
  virtual bool is_one_file() const = 0;
  /// Memory that it holds, in bytes.
  virtual std::uint64_t held_bytes() const { return 0; }

  /// nullopt where there is no object. Throws as find.
  std::optional<ZarrObjectState> look(const std::string& key) { return find(key).object; }

  /// The text of a metadata document; nullopt where there is none. Throws Error(input) where it is larger than
  /// kMostMetadataBytes.
  std::optional<std::string> text(const std::string& key);
};

/// `name` as a key: without slashes at its ends.
std::string without_slashes(std::string_view name);

/// "a/b": where either is empty, the other.
std::string joined_key(std::string_view group, std::string_view name);

}  // namespace weir
