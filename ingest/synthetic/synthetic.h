// Synthetic volumes as a VolumeSource: any box of any size, computed on demand and in parallel, without a file. `weir
// sample` writes them to files; tests read them directly.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "ingest/source/volume_source.h"
#include "ingest/synthetic/field.h"

namespace weir {

/// How the values of a kind become integers.
enum class IntegerScaling {
  stretch,   ///< nominal range to the type's range; zero stays zero for signed types
  verbatim,  ///< the values are integers already
  none       ///< values are not finite, so integers cannot hold them
};

struct SyntheticKind {
  std::string_view name;
  std::string_view description;  ///< one line, for --help
  float min = 0;                 ///< nominal range of the finite values. It holds all values; for the turbulent
  float max = 0;                 ///< kinds, all but a few in 10^6
  IntegerScaling scaling = IntegerScaling::stretch;
  std::unique_ptr<SyntheticField> (*make)(const SyntheticOptions&) = nullptr;
};

/// Returns all kinds, in the order of the documentation.
std::span<const SyntheticKind> synthetic_kinds();
/// Returns the kind `name`. Throws Error(usage), listing the known names, if there is none.
const SyntheticKind& find_synthetic_kind(std::string_view name);

inline constexpr std::string_view kSyntheticExtents =
    "every axis must be 1 to 2147483647 and the volume below 2^60 voxels";
bool is_synthetic_extent(const Index3& extent);

/// Opens a synthetic volume. info() has path "synthetic:KIND", format "synthetic" and type float32. bytes_read()
/// counts the bytes computed. Throws Error(usage) for an unknown kind, and if !is_synthetic_extent().
std::unique_ptr<VolumeSource> open_synthetic(std::string_view kind, const SyntheticOptions& options);

}  // namespace weir
