// The registry of all input formats. A new format is a folder of its own and an entry in source_registry.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "ingest/source/dataset_info.h"
#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// One format. All functions are thread-safe.
struct SourceFormat {
  std::string_view name;  ///< as in SourceInfo::format
  /// Returns whether a file is of this format, by its path and its first kMagicBytes bytes (fewer in a shorter file).
  /// For a directory, `head` is from the file in it that identifies its format (kDirectoryHeads).
  bool (*recognises)(std::string_view path, std::span<const std::byte> head);
  std::unique_ptr<VolumeSource> (*open)(const std::string& path, const SourceOptions& options);
  /// Lists the datasets of the file, in the file's order. Reads no values. Throws what `open` throws, except for an
  /// unclear choice among several datasets.
  std::vector<DatasetInfo> (*list)(const std::string& path, const SourceOptions& options);
  bool raw_shape = false;  ///< takes --dims, --type, --endian and --offset
  bool container = false;  ///< takes --dataset and --index
  bool vectors = false;    ///< takes --component
  bool directory = false;  ///< its inputs may be directories; a file in each identifies the format (kDirectoryHeads)
  bool chunks = false;     ///< takes --missing-chunks
  /// Returns how many levels of refinement a file has, up to options.level. A format with this function takes
  /// --level, --levels and --upsample. Throws what `open` throws.
  std::int64_t (*levels)(const std::string& path, const SourceOptions& options) = nullptr;
  /// Name endings, in lower case, that a watched directory without patterns accepts. Only formats that are for
  /// volumes alone have them. weir's own results have none.
  std::span<const std::string_view> watched_endings = {};
};

inline constexpr std::size_t kMagicBytes = 16;

/// All formats, in the order they are asked. The last one (raw) accepts every file.
std::span<const SourceFormat> source_formats();

/// Returns the format that opens `path`: a file, or a directory that holds a file of kDirectoryHeads. Throws
/// Error(input) if `path` cannot be read.
const SourceFormat& format_of(const std::string& path);
/// Returns whether format_of(path) is NanoVDB, whatever the ending of the name. Throws what format_of throws.
bool is_nanovdb(const std::string& path);

/// Throws Error(usage) if `options` has an option that `format`, the format of `path`, does not take.
void refuse_foreign_options(const std::string& path, const SourceFormat& format, const SourceOptions& options);

/// Opens `path` in its format, places it by options.spacing and options.origin and cuts out options.roi. Throws what
/// the format's `open` throws, and Error(usage) if an option is not for this format or if the stored type cannot hold
/// options.missing.
std::unique_ptr<VolumeSource> open_source(const std::string& path, const SourceOptions& options);

}  // namespace weir
