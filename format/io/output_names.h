// The names of the files beside an output PATH while it is made. PATH.partial: its lock, and its bytes until they are
// complete. PATH.json: its sidecar, written as PATH.json.partial; the sidecar before it is PATH.json.previous.
// .NAME.work: the directory of spilled data. .NAME.PID.partial: a picture that is being written.
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

/// What follows the output's own name, for all files that a conversion may replace or remove.
inline constexpr std::array kOutputEndings{std::string_view(), kPartialEnding, kSidecarEnding, kSidecarPartialEnding,
                                           kSidecarPreviousEnding};

/// Returns the name under which the output or sidecar `path` is written.
inline std::string partial_path(const std::string& path) { return cat(path, kPartialEnding); }
/// Returns the name under which the previous `sidecar` is kept.
inline std::string previous_path(const std::string& sidecar) { return cat(sidecar, kPreviousEnding); }
/// `name` is a file name without directories.
inline std::string work_name(const std::string& name) { return cat('.', name, kWorkEnding); }

/// Returns the directory part of an output's path; "." if there is none.
inline std::string directory_of(const std::string& path) {
  const std::size_t slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

}  // namespace weir
