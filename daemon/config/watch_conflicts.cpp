#include "daemon/config/watch_conflicts.h"

#include <filesystem>
#include <string_view>
#include <tuple>
#include <vector>

#include "format/base/text.h"
#include "format/io/real_path.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

/// Where a watch reads and writes, symbolic links followed. To ask the file system for each pair of watches took
/// minutes for a thousand.
struct Places {
  fs::path directory;
  fs::path output;
};

std::string_view template_of(const WatchConfig& watch) {
  return watch.name.empty() ? std::string_view("{stem}.nvdb") : watch.name;
}

/// Whether some file can be a source of both.
bool share_sources(const WatchConfig& a, const Places& at_a, const WatchConfig& b, const Places& at_b) {
  return at_a.directory == at_b.directory || (a.recursive && lies_below(at_b.directory, at_a.directory)) ||
         (b.recursive && lies_below(at_a.directory, at_b.directory));
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
  if (places[first].output == places[second].output && template_of(a) == template_of(b)) {
    return WatchConflict{second, "output",
                         cat("the watch \"", a.label, "\" writes the same names, ", template_of(a), " in ", a.output,
                             "; give this one another output or name")};
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
  for (const WatchConfig& watch : watches) places.push_back({real_path(watch.directory), real_path(watch.output)});
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
