#include "ingest/file_values.h"

#include <filesystem>
#include <set>
#include <sstream>
#include <system_error>
#include <vector>

#include "format/base/error.h"
#include "ingest/dataset_pattern.h"
#include "ingest/source_registry.h"

namespace weir {
namespace {

constexpr std::size_t kVolumeAxes = 3;

// product() and sum() return the largest std::uint64_t if the result overflows.
std::uint64_t product(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  return __builtin_mul_overflow(a, b, &result) ? ~std::uint64_t{0} : result;
}
std::uint64_t sum(std::uint64_t a, std::uint64_t b) {
  std::uint64_t result = 0;
  return __builtin_add_overflow(a, b, &result) ? ~std::uint64_t{0} : result;
}

std::uint64_t count(const DatasetInfo& dataset) {
  std::uint64_t values = 1;
  for (const std::int64_t extent : dataset.extents) values = product(values, static_cast<std::uint64_t>(extent));
  const bool beside = dataset.extents.size() <= kVolumeAxes;  // else components are the last axis
  return beside ? product(values, static_cast<std::uint64_t>(dataset.components)) : values;
}

// Returns whether `type` is a number ("float32", "big-endian int16"), and not a record, text or reference.
bool is_number(const std::string& type) {
  const std::string last = type.substr(type.rfind(' ') + 1);
  const bool plain = last.size() == type.size() || type.starts_with("big-endian ");
  return plain && (last.starts_with("int") || last.starts_with("uint") || last.starts_with("float"));
}

// `lengths` holds the extents of all axes of all volumes in the file.
bool is_coordinate(const DatasetInfo& dataset, const std::set<std::int64_t>& lengths) {
  const std::vector<std::int64_t>& extents = dataset.extents;
  const bool along_one = extents.size() == 1 || (extents.size() == 2 && extents[1] == 2);
  return along_one && is_number(dataset.type) && (lengths.contains(extents[0]) || lengths.contains(extents[0] - 1));
}

bool is_chosen(const DatasetInfo& dataset, const std::string& chosen) {
  std::istringstream lines(chosen);
  for (std::string line; std::getline(lines, line);) {
    if (names_dataset(line, dataset.name)) return true;
  }
  return false;
}

}  // namespace

std::uint64_t values_of(std::span<const DatasetInfo> datasets, const std::string& chosen, bool scalars) {
  std::set<std::int64_t> lengths;
  for (const DatasetInfo& dataset : datasets) {
    if (dataset.extents.size() >= kVolumeAxes) lengths.insert(dataset.extents.begin(), dataset.extents.end());
  }
  std::uint64_t values = 0;
  for (const DatasetInfo& dataset : datasets) {
    if (dataset.by_name_only && !is_chosen(dataset, chosen)) continue;
    if (scalars && dataset.extents.empty() && !dataset.type.empty()) continue;
    if (!is_coordinate(dataset, lengths)) values = sum(values, count(dataset));
  }
  return values;
}

std::uint64_t file_values(const std::string& path, const SourceOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return 0;
  try {
    SourceOptions all = options;
    all.lists_damaged = true;
    const SourceFormat& format = format_of(path);
    return values_of(format.list(path, all), options.dataset, format.name == "hdf5" || format.name == "zarr");
  } catch (const Error&) {
    return 0;
  }
}

}  // namespace weir
