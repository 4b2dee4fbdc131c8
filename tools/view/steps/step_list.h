// The steps that viewers see. A step keeps its number for as long as the list lives, whatever comes between or goes
// away, so that a view that is on its way means the same file when it arrives. Any thread may ask.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace weir {

/// What tells the paths apart: each without the folders that all of them lie in.
std::vector<std::string> step_names(const std::vector<std::string>& paths);

class StepList {
 public:
  /// Numbered as they stand; one at least.
  explicit StepList(std::vector<std::string> paths);

  /// How many numbers were given: of the steps that are there, and of those that were.
  std::size_t count() const;
  /// Throws std::out_of_range where there is no such step.
  std::string path(std::size_t step) const;
  /// All, by number.
  std::vector<std::string> paths() const;
  /// step_names() of paths(): as long as no step comes from another folder, they stay.
  std::vector<std::string> names() const;
  /// One of these. Throws as path().
  std::string name(std::size_t step) const;
  /// The numbers of those that are there, in natural order of their paths.
  std::vector<std::size_t> order() const;
  /// The one after `step` in that order; none after the last.
  std::optional<std::size_t> after(std::size_t step) const;

  /// `paths` are there from now on, and no others; a new one gets the next number, one that is back has its old one.
  /// Whether this changed anything. An empty list changes nothing: a directory that cannot be seen says no more.
  bool update(const std::vector<std::string>& paths);

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> paths_;
  std::vector<std::string> names_;
  std::vector<std::size_t> order_;
};

}  // namespace weir
