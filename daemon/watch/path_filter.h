// Decides which files of a watched directory are sources.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/config.h"

namespace weir {

/// Paths are relative to the watched directory, without a leading slash: "sub/a.h5". Names are bytes.
///
/// An include or exclude pattern without a slash is for the last component ("*.raw"), one with a slash for the whole
/// path ("run*/out/*.h5"): see glob.h. Hidden directories are never entered. A hidden file matches only a pattern
/// whose last component begins with a dot. Without include, sources are the names of formats that weir reads:
/// NAME_XxYxZ_TYPE.raw (any .raw if WatchConfig::takes_any_raw), names with one of SourceFormat::watched_endings, the
/// Header of an AMReX plotfile, and the zarr.json, .zgroup or .zarray of a directory NAME.zarr.
///
/// A plotfile is the directory of its Header, and patterns apply to the directory: "plt*" for plt00042/Header.
/// Directories that AMReX has not finished (plt00042.temp) or has set aside (plt00042.old.1234) are no sources.
///
/// A Zarr hierarchy is a directory NAME.zarr outside any other, and patterns apply to the directory. Nothing else in
/// it is a source. Its directories are not entered, because there may be as many as chunks.
///
/// Never sources: WatchConfig::excluded_paths and paths below them, WatchConfig::excluded_numbers, X.nvdb.json, the
/// temporary files of a conversion (*.partial, *.nvdb.json.previous), and markers of the policy `marker`.
class PathFilter {
 public:
  /// Reads the file system once, because the directory and the excluded paths may be named through links.
  explicit PathFilter(const WatchConfig& watch);

  bool accepts_file(std::string_view path) const;
  /// Returns whether the directory `path` may contain sources.
  bool enters_directory(std::string_view path) const;
  /// Returns the source of a marker: "a.raw" for "a.raw.done" if the policy is `marker` and a.raw is accepted.
  std::optional<std::string> marked_source(std::string_view path) const;
  /// Returns why the symbolic link `path`, which has a target, is no source: its target lies outside the tree or is
  /// never a source. Empty if nothing speaks against it. Reads the file system.
  std::string link_refusal(const std::string& path) const;

 private:
  std::optional<std::string> in_tree(const std::string& path) const;
  bool is_excluded(std::string_view path) const;

  std::string directory_;
  std::string real_directory_;  ///< with links resolved; empty while the directory is not there
  bool recursive_;
  bool any_raw_;
  std::vector<std::string> include_;
  std::vector<std::string> exclude_;
  std::vector<std::string> excluded_;            ///< relative
  std::vector<NumberedFiles> excluded_numbers_;  ///< relative
  std::string marker_;                           ///< empty for another policy
};

}  // namespace weir
