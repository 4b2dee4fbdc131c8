// Which files of a watched directory are sources.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/config.h"

namespace weir {

/// Paths are relative to the watched directory, without a leading slash: "sub/a.h5". Names are bytes.
///
/// A pattern of include or exclude without a slash is for the last component ("*.raw"), one with a slash for the
/// whole path ("run*/out/*.h5"): see glob.h. Hidden directories are never entered; hidden files are for
/// patterns whose last component begins with a dot. Without include, sources are the names of formats weir
/// reads: NAME_XxYxZ_TYPE.raw (any .raw where WatchConfig::takes_any_raw), what ends with one of
/// SourceFormat::watched_endings, the Header of a plotfile of AMReX, and the zarr.json, .zgroup or .zarray of a
/// directory NAME.zarr.
///
/// A plotfile is the directory that its Header lies in, and patterns are for that: "plt*" for plt00042/Header. What
/// AMReX has not finished (plt00042.temp) or set aside (plt00042.old.1234) is no source.
///
/// A Zarr hierarchy is the directory NAME.zarr, in no other one, and patterns are for that; nothing else in it is a
/// source, and directories in it are not entered: there may be as many as chunks.
///
/// Never sources: WatchConfig::excluded_paths and what lies below them, WatchConfig::excluded_numbers, X.nvdb.json and
/// what a conversion is in the middle of writing (*.partial, *.nvdb.json.previous), markers of the policy `marker`.
class PathFilter {
 public:
  /// Looks at the file system once: excluded paths and the directory may be named through links.
  explicit PathFilter(const WatchConfig& watch);

  bool accepts_file(std::string_view path) const;
  /// Whether something below it can be a source.
  bool enters_directory(std::string_view path) const;
  /// "a.raw" for "a.raw.done" where the policy is `marker` and a.raw is accepted.
  std::optional<std::string> marked_source(std::string_view path) const;
  /// Why the symbolic link `path`, which leads somewhere, is no source: it leaves the tree, or leads to what is never
  /// a source. Empty: nothing against it. Looks at the file system.
  std::string link_refusal(const std::string& path) const;

 private:
  std::optional<std::string> in_tree(const std::string& path) const;
  bool is_excluded(std::string_view path) const;

  std::string directory_;
  std::string real_directory_;  ///< without links; empty while the directory is not there
  bool recursive_;
  bool any_raw_;
  std::vector<std::string> include_;
  std::vector<std::string> exclude_;
  std::vector<std::string> excluded_;            ///< relative
  std::vector<NumberedFiles> excluded_numbers_;  ///< relative
  std::string marker_;                           ///< empty: another policy
};

}  // namespace weir
