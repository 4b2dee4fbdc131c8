// All formats there are. A new one is a folder of its own and an entry in
// source_registry.cpp.
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
  /// Whether a file is of this format, by its path and its first kMagicBytes bytes (fewer in a shorter file); a
  /// directory by those of the file in it that says what it is (kDirectoryHeads).
  bool (*recognises)(std::string_view path, std::span<const std::byte> head);
  std::unique_ptr<VolumeSource> (*open)(const std::string& path, const SourceOptions& options);
  /// What the file holds, in the file's order. Reads no values. Throws what open throws, but for a choice
  /// among several.
  std::vector<DatasetInfo> (*list)(const std::string& path, const SourceOptions& options);
  bool raw_shape = false;  ///< takes --dims, --type, --endian and --offset
  bool container = false;  ///< takes --dataset and --index
  bool vectors = false;    ///< takes --component
  bool directory = false;  ///< its inputs may be directories, which a file in them names (kDirectoryHeads)
  bool chunks = false;     ///< takes --missing-chunks
  /// How many levels of refinement a file has, up to options.level. A format with it takes --level, --levels and
  /// --upsample. Throws what open throws.
  std::int64_t (*levels)(const std::string& path, const SourceOptions& options) = nullptr;
  /// What the names of its files end with, in lower case, where a directory that is watched without patterns takes
  /// them: of formats that are for volumes alone, and not of weir's own results.
  std::span<const std::string_view> watched_endings = {};
};

inline constexpr std::size_t kMagicBytes = 16;

/// In the order they are asked; the last one takes every file.
std::span<const SourceFormat> source_formats();

/// The format that opens `path`, a file or a directory that holds a file of kDirectoryHeads. Throws Error(input) where
/// it cannot be read at all.
const SourceFormat& format_of(const std::string& path);
/// Whether that is the format of NanoVDB files, whatever its name ends with. Throws as format_of.
bool is_nanovdb(const std::string& path);

/// Throws Error(usage) where an option is not for `format`, that of `path`.
void refuse_foreign_options(const std::string& path, const SourceFormat& format, const SourceOptions& options);

/// Opens `path` in its format, places it by options.spacing and options.origin and cuts out options.roi.
/// Throws what that format's open throws, and Error(usage) where an option is not for this format, or the
/// stored type cannot hold options.missing.
std::unique_ptr<VolumeSource> open_source(const std::string& path, const SourceOptions& options);

}  // namespace weir
