#include "ingest/source/left_out.h"

#include <algorithm>
#include <cstddef>

#include "format/base/text.h"

namespace weir {
namespace {

constexpr std::size_t kMostNamed = 3;
constexpr std::size_t kLeastAxes = 3;

}  // namespace

bool is_unread_volume(const DatasetInfo& dataset) {
  return !dataset.obstacle.empty() && !dataset.by_name_only && !dataset.over_time &&
         dataset.extents.size() >= kLeastAxes;
}

Message left_out_notice(const std::string& path, const std::string& taken, std::span<const LeftOut> left_out) {
  std::string text = cat(path, ": ", taken, " is read; left out: ");
  const std::size_t named = std::min(left_out.size(), kMostNamed);
  for (std::size_t i = 0; i < named; ++i) {
    text += cat(i == 0 ? "" : "; ", left_out[i].name, ": ", left_out[i].obstacle);
  }
  if (left_out.size() > named) text += cat("; and ", left_out.size() - named, " more (weir inspect lists them)");
  return text;
}

}  // namespace weir
