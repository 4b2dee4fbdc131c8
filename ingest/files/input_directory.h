// Inputs that are directories: a file in each says what it is.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

/// The file in a plotfile's directory that says what it is.
inline constexpr const char* kDirectoryHead = "Header";

/// All such files: of plotfiles; of Zarr version 3; of a group and of an array of version 2.
inline constexpr std::array<const char*, 4> kDirectoryHeads{kDirectoryHead, "zarr.json", ".zgroup", ".zarray"};

/// The path of the first of kDirectoryHeads that the directory `path` holds, links followed; nullopt where it is none
/// or holds none.
std::optional<std::string> head_in_directory(const std::string& path);

/// What lies in the place of a file of kDirectoryHeads.
struct IrregularHead {
  std::string path;
  std::string what;  ///< "is a pipe and not a regular file; copy its content to one"
};

/// The first of kDirectoryHeads in the directory `path` that is a pipe, a socket, a device, a link to nothing or, but
/// for Header, a directory; nullopt where there is none.
std::optional<IrregularHead> irregular_head(const std::string& path);

/// Whether `path` is a directory that holds one of them.
inline bool is_input_directory(const std::string& path) { return head_in_directory(path).has_value(); }

/// The directory that `path` names by a file of kDirectoryHeads, "run/plt00042" for "run/plt00042/Header"; `path` else.
/// Looks at the name alone.
std::string_view named_by_head(std::string_view path);

/// Whether `path` names a directory so.
inline bool is_head(std::string_view path) { return named_by_head(path).size() != path.size(); }

/// Whether `path` names a plotfile by its Header.
bool is_plotfile_head(std::string_view path);

/// `path` without the slashes at its end where it is such a directory.
std::string without_last_slash(const std::string& path);

}  // namespace weir
