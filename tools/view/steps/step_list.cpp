#include "tools/view/steps/step_list.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <utility>

#include "ingest/files/file_pattern.h"

namespace weir {
namespace {

void sort_naturally(std::vector<std::size_t>& order, const std::vector<std::string>& paths) {
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return natural_less(paths[a], paths[b]); });
}

}  // namespace

std::vector<std::string> step_names(const std::vector<std::string>& paths) {
  if (paths.empty()) return {};
  std::string folders = paths.front().substr(0, paths.front().rfind('/') + 1);
  for (const std::string& path : paths) {
    while (!path.starts_with(folders)) {
      folders.pop_back();  // removes the trailing '/'
      folders.resize(folders.rfind('/') + 1);
    }
  }
  std::vector<std::string> names;
  for (const std::string& path : paths) names.push_back(path.substr(folders.size()));
  return names;
}

StepList::StepList(std::vector<std::string> paths)
    : paths_(std::move(paths)), names_(step_names(paths_)), order_(paths_.size()) {
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  sort_naturally(order_, paths_);
}

std::size_t StepList::count() const {
  const std::lock_guard lock(mutex_);
  return paths_.size();
}

std::string StepList::path(std::size_t step) const {
  const std::lock_guard lock(mutex_);
  return paths_.at(step);
}

std::vector<std::string> StepList::paths() const {
  const std::lock_guard lock(mutex_);
  return paths_;
}

std::vector<std::string> StepList::names() const {
  const std::lock_guard lock(mutex_);
  return names_;
}

std::string StepList::name(std::size_t step) const {
  const std::lock_guard lock(mutex_);
  return names_.at(step);
}

std::vector<std::size_t> StepList::order() const {
  const std::lock_guard lock(mutex_);
  return order_;
}

std::optional<std::size_t> StepList::after(std::size_t step) const {
  const std::lock_guard lock(mutex_);
  const auto found = std::find(order_.begin(), order_.end(), step);
  if (found == order_.end() || found + 1 == order_.end()) return std::nullopt;
  return *(found + 1);
}

bool StepList::update(const std::vector<std::string>& paths) {
  if (paths.empty()) return false;
  const std::lock_guard lock(mutex_);
  std::map<std::string, std::size_t> numbers;
  for (std::size_t i = 0; i < paths_.size(); ++i) numbers.emplace(paths_[i], i);
  std::vector<std::size_t> order;
  for (const std::string& path : paths) {
    const auto [at, fresh] = numbers.emplace(path, paths_.size());
    if (fresh) paths_.push_back(path);
    order.push_back(at->second);
  }
  names_ = step_names(paths_);
  sort_naturally(order, paths_);
  return std::exchange(order_, order) != order;
}

}  // namespace weir
