// The set of planes of a volume that were handed over, as a few ranges.
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
  /// Adds all planes of a non-empty range. If the set already has some of them, adds none and returns the first range
  /// of planes that it has.
  std::optional<PlaneRange> add(const PlaneRange& planes);

  /// Returns the ranges that are missing from [0, count), lowest first.
  std::vector<PlaneRange> missing(std::int64_t count) const;

 private:
  std::map<std::int64_t, std::int64_t> ranges_;  // lo to hi, none touches the next
};

/// Returns the ranges as text: "plane 7", "planes 3 to 5 and 9", "planes 0, 2, 4 and 1021 more". At most three ranges
/// are named; the planes of the others are counted. No range is empty.
std::string planes_text(const std::vector<PlaneRange>& ranges);

}  // namespace weir
