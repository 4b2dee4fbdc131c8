// Reads thumbnails for the API.
#pragma once

#include <optional>
#include <string>

namespace weir {

/// Returns the bytes of the PNG file at `path`. Returns none if the file is missing, is no regular file, does not
/// begin like a PNG file, or is larger than 8 MiB: the service did not render such a file.
std::optional<std::string> read_thumbnail(const std::string& path);

}  // namespace weir
