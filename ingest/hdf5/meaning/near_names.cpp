#include "ingest/hdf5/meaning/near_names.h"

#include <algorithm>
#include <cctype>
#include <numeric>
#include <utility>

namespace weir {
namespace {

constexpr std::size_t kMostEdits = 2;

std::string last_part_lowered(std::string_view path) {
  std::string part(path.substr(path.rfind('/') + 1));
  std::transform(part.begin(), part.end(), part.begin(), [](unsigned char c) { return std::tolower(c); });
  return part;
}

// Levenshtein's distance, a row at a time.
std::size_t edits(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = std::exchange(row[j + 1], std::min({row[j] + 1, row[j + 1] + 1, replaced}));
    }
  }
  return row.back();
}

}  // namespace

std::vector<std::string> near_names(std::string_view wanted, std::span<const std::string> names, std::size_t count) {
  const std::string target = last_part_lowered(wanted);
  const std::size_t most = std::min(kMostEdits, target.size() / 3);
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const std::string& name : names) {
    const std::string part = last_part_lowered(name);
    if (part.size() > target.size() + most || target.size() > part.size() + most) continue;
    if (const std::size_t distance = edits(target, part); distance <= most) near.emplace_back(distance, name);
  }
  std::stable_sort(near.begin(), near.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> nearest;
  for (auto& [distance, name] : near) {
    if (nearest.size() < count) nearest.push_back(std::move(name));
  }
  return nearest;
}

}  // namespace weir
