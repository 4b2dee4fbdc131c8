// The names of what lies beside an output PATH while it is made: PATH.partial, its lock and its bytes until they are
// complete; its sidecar PATH.json, written as PATH.json.partial, and the one before it as PATH.json.previous;
// .NAME.work, the directory of what does not fit the memory; and for a picture .NAME.PID.partial.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "format/base/text.h"

namespace weir {

inline constexpr std::string_view kPartialEnding = ".partial";
inline constexpr std::string_view kPreviousEnding = ".previous";
inline constexpr std::string_view kWorkEnding = ".work";
inline constexpr std::string_view kSidecarEnding = ".json";
inline constexpr std::string_view kSidecarPartialEnding = ".json.partial";
inline constexpr std::string_view kSidecarPreviousEnding = ".json.previous";

/// Of all files that a conversion may replace or remove: what follows the output's own name.
inline constexpr std::array kOutputEndings{std::string_view(), kPartialEnding, kSidecarEnding, kSidecarPartialEnding,
                                           kSidecarPreviousEnding};

/// Of an output or a sidecar.
inline std::string partial_path(const std::string& path) { return cat(path, kPartialEnding); }
/// Of a sidecar.
inline std::string previous_path(const std::string& sidecar) { return cat(sidecar, kPreviousEnding); }
/// `name`: a file's, without directories.
inline std::string work_name(const std::string& name) { return cat('.', name, kWorkEnding); }

/// Directory part of an output's path, "." where there is none.
inline std::string directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace weir
