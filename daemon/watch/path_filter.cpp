#include "daemon/watch/path_filter.h"

#include <algorithm>
#include <filesystem>

#include "daemon/config/glob.h"
#include "daemon/watch/store_quiet.h"
#include "format/base/ascii.h"
#include "format/base/text.h"
#include "format/io/output_names.h"
#include "format/io/real_path.h"
#include "ingest/files/input_directory.h"
#include "ingest/raw/raw_name.h"
#include "ingest/source_registry.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

std::string_view name_of(std::string_view path) { return path.substr(path.find_last_of('/') + 1); }

// Returns whether AMReX still writes the plotfile's directory, or has renamed it to make room for a new one.
bool is_no_plotfile_yet(std::string_view path) {
  if (!is_plotfile_head(path)) return false;
  const std::string_view name = name_of(named_by_head(path));
  return name.ends_with(".temp") || name.find(".old.") != std::string_view::npos;
}

// Compares a plotfile or a Zarr hierarchy by the name of its directory.
bool matches(const std::vector<std::string>& patterns, std::string_view path) {
  if (is_plotfile_head(path) || is_store_head(path)) path = named_by_head(path);
  return std::any_of(patterns.begin(), patterns.end(),
                     [&](const std::string& pattern) { return matches_pattern(pattern, path); });
}

bool is_known_format(std::string_view path, bool any_raw) {
  if (is_store_head(path)) return !name_of(named_by_head(path)).starts_with('.');
  const std::string_view name = name_of(path);
  if (name.starts_with('.')) return false;
  if (is_plotfile_head(path)) return true;
  if (lower_case(name).ends_with(".raw")) return any_raw || parse_raw_name(name).has_value();
  return std::ranges::any_of(
      source_formats(), [&](const SourceFormat& format) { return ends_with_one_of(name, format.watched_endings); });
}

// Returns whether a conversion writes such a file beside a volume, as a result or temporarily.
bool is_of_weir(std::string_view path) {
  const auto is_beside_volume = [&](std::string_view ending) { return path.ends_with(cat(".nvdb", ending)); };
  return path.ends_with(kPartialEnding) || is_beside_volume(kSidecarEnding) || is_beside_volume(kSidecarPreviousEnding);
}

bool is_at_or_below(std::string_view path, std::string_view directory) {
  return path.starts_with(directory) &&
         (directory.empty() || path.size() == directory.size() || path[directory.size()] == '/');
}

bool is_numbered(std::string_view path, const NumberedFiles& files) {
  if (!path.starts_with(files.before)) return false;
  const std::string_view rest = path.substr(files.before.size());
  const std::size_t digits = std::min(rest.find_first_not_of("0123456789"), rest.size());
  return digits > 0 && (files.any_after || rest.substr(digits) == files.after);
}

}  // namespace

PathFilter::PathFilter(const WatchConfig& watch)
    : directory_(watch.directory),
      real_directory_(real_path(watch.directory).string()),
      recursive_(watch.recursive),
      any_raw_(watch.takes_any_raw()),
      include_(watch.include),
      exclude_(watch.exclude),
      marker_(watch.complete == Completion::marker ? watch.marker : std::string()) {
  for (const std::string& path : watch.excluded_paths) {
    if (auto relative = in_tree(path)) excluded_.push_back(*std::move(relative));
  }
  for (const NumberedFiles& files : watch.excluded_numbers) {
    if (auto relative = in_tree(files.before))
      excluded_numbers_.push_back({*std::move(relative), files.after, files.any_after});
  }
}

// Returns `path` relative to the tree with links resolved; none if it lies elsewhere.
std::optional<std::string> PathFilter::in_tree(const std::string& path) const {
  const fs::path relative = real_path(path).lexically_relative(real_directory_);
  if (relative.empty() || *relative.begin() == "..") return std::nullopt;
  return relative.string();
}

bool PathFilter::is_excluded(std::string_view path) const {
  return std::any_of(excluded_.begin(), excluded_.end(),
                     [&](const std::string& excluded) { return is_at_or_below(path, excluded); }) ||
         std::any_of(excluded_numbers_.begin(), excluded_numbers_.end(),
                     [&](const NumberedFiles& files) { return is_numbered(path, files); });
}

bool PathFilter::accepts_file(std::string_view path) const {
  if (!recursive_ && path.find('/') != std::string_view::npos) return false;
  if (is_of_weir(path)) return false;
  if (!marker_.empty() && path.ends_with(marker_)) return false;
  if (is_no_plotfile_yet(path)) return false;
  if ((is_in_store(path) || (is_head(path) && !is_plotfile_head(path))) && !is_store_head(path)) return false;
  if (!(include_.empty() ? is_known_format(path, any_raw_) : matches(include_, path))) return false;
  return !matches(exclude_, path) && !is_excluded(path);
}

bool PathFilter::enters_directory(std::string_view path) const {
  return recursive_ && !name_of(path).starts_with('.') && !is_in_store(path) && !matches(exclude_, path) &&
         !is_excluded(path);
}

std::optional<std::string> PathFilter::marked_source(std::string_view path) const {
  if (marker_.empty() || !path.ends_with(marker_)) return std::nullopt;
  const std::string_view source = path.substr(0, path.size() - marker_.size());
  if (name_of(source).empty() || !accepts_file(source)) return std::nullopt;
  return std::string(source);
}

std::string PathFilter::link_refusal(const std::string& path) const {
  const std::string link = cat(directory_, '/', path);
  std::error_code error;
  const std::string target = fs::canonical(link, error).string();
  if (error) return cat("a symbolic link that cannot be followed: ", error.message());
  if (!is_at_or_below(target, real_directory_)) {
    return cat("a symbolic link to ", target, ", outside the watched directory; watch that directory too");
  }
  const std::string_view inside = std::string_view(target).substr(real_directory_.size());
  if (is_excluded(inside.substr(inside.starts_with('/') ? 1 : 0))) {
    return cat("a symbolic link to ", target, ", which is weir's own");
  }
  return {};
}

}  // namespace weir
