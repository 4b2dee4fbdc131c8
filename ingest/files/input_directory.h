// Inputs that are directories. A file in each identifies its format.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace weir {

/// The file that identifies a plotfile's directory.
inline constexpr const char* kDirectoryHead = "Header";

/// All files that identify a directory: of plotfiles; of Zarr version 3; of a group and of an array of Zarr version
/// 2.
inline constexpr std::array<const char*, 4> kDirectoryHeads{kDirectoryHead, "zarr.json", ".zgroup", ".zarray"};

/// Returns the path of the first of kDirectoryHeads that the directory `path` holds; links are followed. Returns
/// nullopt if `path` is no directory or holds none of them.
std::optional<std::string> head_in_directory(const std::string& path);

/// Something that has the name of a file of kDirectoryHeads and is no regular file.
struct IrregularHead {
  std::string path;
  std::string what;  ///< "is a pipe and not a regular file; copy its content to one"
};

/// Returns the first of kDirectoryHeads in the directory `path` that is a pipe, a socket, a device, a dangling link
/// or (except for Header) a directory. Returns nullopt if there is none.
std::optional<IrregularHead> irregular_head(const std::string& path);

/// Returns whether `path` is a directory that holds a file of kDirectoryHeads.
inline bool is_input_directory(const std::string& path) { return head_in_directory(path).has_value(); }

/// Returns the directory if `path` names a file of kDirectoryHeads in it: "run/plt00042" for "run/plt00042/Header".
/// Otherwise returns `path`. Looks at the name alone.
std::string_view named_by_head(std::string_view path);

/// Returns whether `path` names a directory by a file of kDirectoryHeads.
inline bool is_head(std::string_view path) { return named_by_head(path).size() != path.size(); }

/// Returns whether `path` names a plotfile by its Header.
bool is_plotfile_head(std::string_view path);

/// Returns `path` without trailing slashes if it is an input directory, otherwise `path`.
std::string without_last_slash(const std::string& path);

}  // namespace weir
