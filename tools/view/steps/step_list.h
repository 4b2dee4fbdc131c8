// The steps that viewers see. A step keeps its number as long as the list lives, even when other steps come or go, so
// that a view on its way still means the same file when it arrives. Any thread may ask.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace weir {

/// Returns each path without the folders that all of the paths lie in.
std::vector<std::string> step_names(const std::vector<std::string>& paths);

class StepList {
 public:
  /// Numbers the paths in the given order; at least one.
  explicit StepList(std::vector<std::string> paths);

  /// Returns how many numbers were given, to present and vanished steps.
  std::size_t count() const;
  /// Returns the path of a step. Throws std::out_of_range if there is no such step.
  std::string path(std::size_t step) const;
  /// Returns all paths, by number.
  std::vector<std::string> paths() const;
  /// Returns step_names() of paths(). Names change only when a step comes from another folder.
  std::vector<std::string> names() const;
  /// Returns the name of one step. Throws as path().
  std::string name(std::size_t step) const;
  /// Returns the numbers of the steps that are present, in natural order of their paths.
  std::vector<std::size_t> order() const;
  /// Returns the step after `step` in order(); nullopt after the last.
  std::optional<std::size_t> after(std::size_t step) const;

  /// Makes `paths` the present steps. A new path gets the next number; a path that returns gets its old number.
  /// Returns whether anything changed. An empty list changes nothing, because an unreadable directory also gives an
  /// empty list.
  bool update(const std::vector<std::string>& paths);

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> paths_;
  std::vector<std::string> names_;
  std::vector<std::size_t> order_;
};

}  // namespace weir
