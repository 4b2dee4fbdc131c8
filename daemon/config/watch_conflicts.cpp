#include "daemon/config/watch_conflicts.h"

#include <filesystem>
#include <string_view>
#include <tuple>

#include "format/base/text.h"
#include "format/io/real_path.h"

namespace weir {
namespace {

namespace fs = std::filesystem;

bool same_place(const std::string& a, const std::string& b) { return real_path(a) == real_path(b); }

std::string_view template_of(const WatchConfig& watch) {
  return watch.name.empty() ? std::string_view("{stem}.nvdb") : watch.name;
}

/// Whether some file can be a source of both.
bool share_sources(const WatchConfig& a, const WatchConfig& b) {
  return same_place(a.directory, b.directory) || (a.recursive && is_within(b.directory, a.directory)) ||
         (b.recursive && is_within(a.directory, b.directory));
}

std::optional<WatchConflict> conflict_of_two(std::span<const WatchConfig> watches, std::size_t first,
                                             std::size_t second) {
  const WatchConfig& a = watches[first];
  const WatchConfig& b = watches[second];
  if (a.label == b.label) {
    return WatchConflict{
        second, "label",
        cat("there is a watch of the label \"", a.label, "\" already; give this one a label of its own")};
  }
  if (same_place(a.output, b.output) && template_of(a) == template_of(b)) {
    return WatchConflict{second, "output",
                         cat("the watch \"", a.label, "\" writes the same names, ", template_of(a), " in ", a.output,
                             "; give this one another output or name")};
  }
  for (const auto& [deleting, reading, index] : {std::tuple(&a, &b, first), std::tuple(&b, &a, second)}) {
    if (deleting->source != AfterDone::delete_after_verify || !share_sources(a, b)) continue;
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
  for (std::size_t i = 0; i < watches.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (auto conflict = conflict_of_two(watches, j, i)) return conflict;
    }
    for (const WatchConfig& writer : watches) {
      if (!is_within(watches[i].directory, writer.output)) continue;
      const bool itself = &writer == &watches[i];
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
