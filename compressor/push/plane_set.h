// Planes of a volume, as a few ranges: which of them were handed over.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace weir {

/// Planes [lo, hi).
struct PlaneRange {
  std::int64_t lo = 0;
  std::int64_t hi = 0;
  friend bool operator==(const PlaneRange&, const PlaneRange&) = default;
};

class PlaneSet {
 public:
  /// Adds all planes of a range that is not empty, or, where some are there already, none, and returns the first
  /// such planes.
  std::optional<PlaneRange> add(const PlaneRange& planes);

  /// The ranges that are missing from [0, count), lowest first.
  std::vector<PlaneRange> missing(std::int64_t count) const;

 private:
  std::map<std::int64_t, std::int64_t> ranges_;  // lo to hi, none touches the next
};

/// "plane 7", "planes 3 to 5 and 9", "planes 0, 2, 4 and 1021 more": of at most three ranges, none empty, the others
/// are counted by their planes.
std::string planes_text(const std::vector<PlaneRange>& ranges);

}  // namespace weir
