// All formats there are. A new one is a file of its own and one line in
// source_registry.cpp.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "format/index.h"
#include "ingest/raw_source.h"
#include "ingest/volume_source.h"

namespace weir {

/// What the command line says about an input.
struct SourceOptions {
  RawOptions raw;          ///< what a raw file does not say itself; spacing, origin and direct I/O of any format
  std::optional<Box> roi;  ///< --roi: index space, half open; the whole volume where absent
};

/// One format. All functions are thread-safe.
struct SourceFormat {
  std::string_view name;  ///< as in SourceInfo::format
  /// Whether a file is of this format, by its path and its first kMagicBytes bytes (fewer in a shorter file).
  bool (*recognises)(std::string_view path, std::span<const std::byte> head);
  std::unique_ptr<VolumeSource> (*open)(const std::string& path, const SourceOptions& options);
};

inline constexpr std::size_t kMagicBytes = 16;

/// In the order they are asked; the last one takes every file.
std::span<const SourceFormat> source_formats();

/// Opens `path` in the first format that recognises it and cuts out options.roi. Throws what that
/// format's open throws; Error(input) where the file cannot be read at all.
std::unique_ptr<VolumeSource> open_source(const std::string& path, const SourceOptions& options);

}  // namespace weir
