// Thumbnails as the API serves them.
#pragma once

#include <optional>
#include <string>

namespace weir {

/// The bytes of the PNG file at `path`; none where it is not there, is no regular file, has not a PNG file's first
/// bytes, or is larger than 8 MiB: then it is not what the service rendered.
std::optional<std::string> read_thumbnail(const std::string& path);

}  // namespace weir
