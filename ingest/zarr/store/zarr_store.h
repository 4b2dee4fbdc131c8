// The store of a Zarr hierarchy: its objects are the files of a directory, or the entries of a zip file. Keys are
// paths within the store, such as "fields/rho/zarr.json", without slashes at the ends. The root's key is empty.
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

/// An open object. Thread-safe.
class ZarrObject {
 public:
  virtual ~ZarrObject() = default;

  virtual std::uint64_t size() const = 0;
  /// Fills `into` from byte `offset` on. The whole range must lie inside the object. Throws Error(input) if the
  /// object cannot be read this way, Error(io) if the device fails.
  virtual void read(std::uint64_t offset, std::span<std::byte> into) = 0;
};

/// The state of an object, found without reading it.
struct ZarrObjectState {
  std::uint64_t bytes = 0;
  std::int64_t mtime_ns = 0;  ///< ns since 1970; 0 inside a zip file
  std::int64_t ctime_ns = 0;  ///< ns since 1970; 0 inside a zip file
};

/// What a store has at a key.
struct ZarrFound {
  std::optional<ZarrObjectState> object;
  std::string in_its_place;  ///< if there is no object: what lies there instead, and the remedy; empty: nothing
};

/// A store of objects. Thread-safe.
class ZarrStore {
 public:
  virtual ~ZarrStore() = default;

  /// Returns the name of `key` for messages: "run.zarr/rho/c/0/0/1", "run.zip: rho/c/0/0/1".
  virtual std::string shown(std::string_view key) const = 0;
  /// Returns what lies at `key`. Throws Error(io) if the file system cannot tell.
  virtual ZarrFound find(const std::string& key) = 0;
  /// Opens the object at `key`; returns nullptr if there is none. Throws Error(input) if it is empty or cannot be
  /// read.
  virtual std::unique_ptr<ZarrObject> open(const std::string& key) = 0;
  /// Returns the sorted names of the directories directly below `key`; in a zip file, only of those with entries in
  /// them. Throws Error(io).
  virtual std::vector<std::string> groups_in(const std::string& key) = 0;
  /// Returns the file that holds the object at `key`.
  virtual std::string file_of(const std::string& key) const = 0;
  /// Returns whether all objects lie in one file, a zip file.
  virtual bool is_one_file() const = 0;
  /// Returns the memory that the store holds, in bytes.
  virtual std::uint64_t held_bytes() const { return 0; }

  /// Returns the state of the object at `key`; nullopt if there is none. Throws the errors of find().
  std::optional<ZarrObjectState> look(const std::string& key) { return find(key).object; }

  /// Returns the text of the metadata document at `key`; nullopt if there is none. Throws Error(input) if it is
  /// larger than kMostMetadataBytes.
  std::optional<std::string> text(const std::string& key);
};

/// Returns `name` as a key, without slashes at its ends.
std::string without_slashes(std::string_view name);

/// Returns the joined key "a/b"; if one part is empty, the other part.
std::string joined_key(std::string_view group, std::string_view name);

}  // namespace weir
