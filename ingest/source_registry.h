// All formats there are. A new one is a file of its own and one line in
// source_registry.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ingest/source/source_options.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// One array or grid of a file, as `weir inspect` lists it.
struct DatasetInfo {
  std::string name;                   ///< as --dataset takes it; empty where the file holds one volume and no name
  std::vector<std::int64_t> extents;  ///< as the file orders them: slowest axis first for HDF5, x first for headers
  std::string type;                   ///< "float32", "big-endian float64", ...
  std::string layout;                 ///< "contiguous", "chunked 64 x 64 x 64, gzip, shuffle", ...
  std::vector<std::pair<std::string, std::string>> attributes;  ///< those that matter: units, missing value, spacing
  std::size_t leading_axes = 0;                                 ///< how many positions --index must give
  std::string obstacle;                                         ///< why it cannot be converted; empty where it can
};

/// One format. All functions are thread-safe.
struct SourceFormat {
  std::string_view name;  ///< as in SourceInfo::format
  /// Whether a file is of this format, by its path and its first kMagicBytes bytes (fewer in a shorter file).
  bool (*recognises)(std::string_view path, std::span<const std::byte> head);
  std::unique_ptr<VolumeSource> (*open)(const std::string& path, const SourceOptions& options);
  /// What the file holds, in the file's order. Reads no values. Throws what open throws, but for a choice
  /// among several.
  std::vector<DatasetInfo> (*list)(const std::string& path, const SourceOptions& options);
  bool raw_shape = false;  ///< takes --dims, --type, --endian and --offset
  bool container = false;  ///< takes --dataset and --index
};

inline constexpr std::size_t kMagicBytes = 16;

/// In the order they are asked; the last one takes every file.
std::span<const SourceFormat> source_formats();

/// The format that opens `path`. Throws Error(input) where the file cannot be read at all.
const SourceFormat& format_of(const std::string& path);

/// Opens `path` in its format, places it by options.spacing and options.origin and cuts out options.roi.
/// Throws what that format's open throws, and Error(usage) where an option is not for this format, or the
/// stored type cannot hold options.missing.
std::unique_ptr<VolumeSource> open_source(const std::string& path, const SourceOptions& options);

/// The list of a format whose files hold one volume: opens it and says what it is.
std::vector<DatasetInfo> list_single(const SourceInfo& info, std::string layout);

}  // namespace weir
