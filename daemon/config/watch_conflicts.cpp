#include "daemon/config/watch_conflicts.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <initializer_list>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "daemon/config/glob.h"
#include "format/base/text.h"
#include "format/io/real_path.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

/// The directories of a watch with symbolic links followed, and possible_names(). They are resolved once: asking the
/// file system for each pair of watches took minutes for a thousand watches.
struct Places {
  fs::path directory;
  fs::path output;
  std::vector<std::string> names;
};

// Returns `name` and its variants without {dataset} and {step}, because these words may be empty: a raw file has
// neither.
std::vector<std::string> without_words(std::string name) {
  std::vector<std::string> names{std::move(name)};
  for (const std::string_view word : {"{dataset}", "{step}"}) {
    for (std::size_t i = 0, count = names.size(); i < count; ++i) {
      std::string without = names[i];
      for (std::size_t at = without.find(word); at != std::string::npos; at = without.find(word)) {
        without.erase(at, word.size());
      }
      if (without != names[i]) names.push_back(std::move(without));
    }
  }
  return names;
}

// Returns the default names. If a file has several volumes and options choose some of them, convert appends more
// words to the stem.
std::vector<std::string> default_names(const WatchConfig& watch) {
  constexpr std::array kChoosing{"dataset", "index", "component", "magnitude", "level"};
  const bool chooses =
      std::ranges::any_of(kChoosing, [&](const char* option) { return watch.convert_option(option).has_value(); });
  if (!chooses) return {"{stem}.nvdb"};
  return {"{stem}.nvdb", "{stem}_{dataset}.nvdb", "{stem}_{step}.nvdb", "{stem}_{dataset}_{step}.nvdb"};
}

// Returns templates of all names that an output may have; no word in them is empty.
std::vector<std::string> possible_names(const WatchConfig& watch) {
  return watch.name.empty() ? default_names(watch) : without_words(watch.name);
}

/// Returns the first name of `a` that is also in `b`; empty if there is none.
std::string_view common_name(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  const auto at = std::ranges::find_first_of(a, b);
  return at == a.end() ? std::string_view() : std::string_view(*at);
}

/// Returns the part of `path` below `directory`: "sub/deep" for "/in/sub/deep" and "/in". Empty if it does not lie
/// below. Compares text, because lies_below() takes several times as long.
std::string_view place_below(const fs::path& path, const fs::path& directory) {
  const std::string_view text = path.native();
  const std::string_view above = directory.native() == "/" ? std::string_view() : directory.native();
  const bool is_below = text.size() > above.size() + 1 && text.starts_with(above) && text[above.size()] == '/';
  return is_below ? text.substr(above.size() + 1) : std::string_view();
}

/// Returns whether all patterns that `watch` includes lie in other subdirectories than `place`: for example
/// "run1/*.raw" if `place` is "run2".
bool includes_others(const WatchConfig& watch, std::string_view place) {
  const auto lies_elsewhere = [&](std::string_view pattern) {
    const std::size_t end = pattern.find('/');
    const std::string_view first = pattern.substr(0, end);
    const bool is_name = first.find_first_of("*?[{\\") == std::string_view::npos;
    return end != std::string_view::npos && is_name && first != place.substr(0, place.find('/'));
  };
  return !watch.include.empty() && std::ranges::all_of(watch.include, lies_elsewhere);
}

/// Returns whether `watch` excludes from its subdirectory `place` everything that `inner` includes there, by the same
/// patterns. A pattern without a slash matches names at any depth: if `inner` is recursive, "place/**/" must precede
/// it.
bool leaves_to(const WatchConfig& watch, const WatchConfig& inner, std::string_view place) {
  const auto excludes = [&](const std::string& pattern) {
    const bool at_any_depth = inner.recursive && pattern.find('/') == std::string::npos;
    return std::ranges::find(watch.exclude, cat(place, at_any_depth ? "/**/" : "/", pattern)) != watch.exclude.end();
  };
  return !inner.include.empty() && std::ranges::all_of(inner.include, excludes);
}

/// Returns whether a recursive watch takes no file directly in its subdirectory `place`, because it is hidden or
/// excluded. To test for any name, a name is used that nobody gives: a pattern without a set matches it only if it
/// matches every name.
bool leaves_out(const WatchConfig& watch, std::string_view place) {
  const auto is_excluded = [&](std::string_view path, bool any_name = false) {
    return std::ranges::any_of(watch.exclude, [&](const std::string& pattern) {
      return !(any_name && pattern.find('[') != std::string::npos) && matches_pattern(pattern, path);
    });
  };
  if (place.starts_with('.') || place.find("/.") != std::string_view::npos) return true;
  for (std::size_t end = place.find('/');; end = place.find('/', end + 1)) {
    if (is_excluded(place.substr(0, end))) return true;
    if (end == std::string_view::npos) return is_excluded(cat(place, "/\x01 any name \x01"), true);
  }
}

/// Returns the subdirectory (relative) of the recursive `outer` that `inner` watches, if both write the outputs of
/// its sources to one directory. Empty otherwise.
std::string_view twice_converted(const WatchConfig& outer, const Places& at_outer, const WatchConfig& inner,
                                 const Places& at_inner) {
  if (!outer.recursive) return {};
  const std::string_view place = place_below(at_inner.directory, at_outer.directory);
  if (place.empty() || place != place_below(at_inner.output, at_outer.output)) return {};
  const bool apart = leaves_out(outer, place) || includes_others(outer, place) || leaves_to(outer, inner, place);
  return apart ? std::string_view() : place;
}

/// Returns whether some file can be a source of both watches.
bool share_sources(const WatchConfig& a, const Places& at_a, const WatchConfig& b, const Places& at_b) {
  return at_a.directory == at_b.directory || (a.recursive && lies_below(at_b.directory, at_a.directory)) ||
         (b.recursive && lies_below(at_a.directory, at_b.directory));
}

/// Returns what the second watch must change because both write the same names; empty if they do not.
std::string same_names(const WatchConfig& a, const Places& at_a, const WatchConfig& b, const Places& at_b) {
  const auto written = [&](std::string_view name, const WatchConfig& into) {
    return cat("the watch \"", a.label, "\" writes the same names, ", name, " in ", into.output,
               "; give this one another output or name");
  };
  if (at_a.output == at_b.output) {
    const std::string_view name = common_name(at_a.names, at_b.names);
    return name.empty() ? std::string() : written(name, b);
  }
  for (const auto& [outer, at_outer, inner, at_inner] :
       {std::tuple(&a, &at_a, &b, &at_b), std::tuple(&b, &at_b, &a, &at_a)}) {
    const std::string_view place = twice_converted(*outer, *at_outer, *inner, *at_inner);
    const std::string_view name = place.empty() ? place : common_name(at_a.names, at_b.names);
    if (name.empty()) continue;
    return cat(written(name, *inner), ", or exclude ", place, " from the watch \"", outer->label, '"');
  }
  return {};
}

std::optional<WatchConflict> conflict_of_two(std::span<const WatchConfig> watches, std::span<const Places> places,
                                             std::size_t first, std::size_t second) {
  const WatchConfig& a = watches[first];
  const WatchConfig& b = watches[second];
  if (a.label == b.label) {
    return WatchConflict{
        second, "label",
        cat("there is a watch of the label \"", a.label, "\" already; give this one a label of its own")};
  }
  if (std::string message = same_names(a, places[first], b, places[second]); !message.empty()) {
    return WatchConflict{second, "output", std::move(message)};
  }
  for (const auto& [deleting, reading, index] : {std::tuple(&a, &b, first), std::tuple(&b, &a, second)}) {
    if (deleting->source != AfterDone::delete_after_verify) continue;
    if (!share_sources(a, places[first], b, places[second])) continue;
    return WatchConflict{index, "source",
                         cat("sources would be deleted that the watch \"", reading->label,
                             "\" converts too; keep them, or watch different directories")};
  }
  return std::nullopt;
}

}  // namespace

bool is_within(const std::string& path, const std::string& directory) {
  return lies_below(real_path(path), real_path(directory));
}

std::optional<WatchConflict> find_conflict(std::span<const WatchConfig> watches) {
  std::vector<Places> places;
  for (const WatchConfig& watch : watches) {
    places.push_back({real_path(watch.directory), real_path(watch.output), possible_names(watch)});
  }
  for (std::size_t i = 0; i < watches.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (auto conflict = conflict_of_two(watches, places, j, i)) return conflict;
    }
    for (std::size_t j = 0; j < watches.size(); ++j) {
      if (!lies_below(places[i].directory, places[j].output)) continue;
      const WatchConfig& writer = watches[j];
      const bool itself = i == j;
      return WatchConflict{i, itself ? "output" : "directory",
                           cat(watches[i].directory, " is watched and lies in the output ", writer.output,
                               itself ? "" : cat(" of the watch \"", writer.label, '"'),
                               ", so that results would be converted again; separate them, ", watches[i].directory,
                               "/nvdb is a good output for instance")};
    }
  }
  return std::nullopt;
}

}  // namespace weir
