// Synthetic volumes as a VolumeSource: any box of any size on demand, in
// parallel, from nothing. `weir sample` writes them to files; tests read them
// directly.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "ingest/source/volume_source.h"
#include "ingest/synthetic/field.h"

namespace weir {

/// How a kind's values become integers.
enum class IntegerScaling {
  stretch,   ///< the nominal range over the type's range, zero kept at zero for signed types
  verbatim,  ///< the values are integers already
  none       ///< not finite: cannot
};

struct SyntheticKind {
  std::string_view name;
  std::string_view description;  ///< one line, for --help
  float min = 0;                 ///< nominal range of the finite values; all but a few in 10^6 of the
  float max = 0;                 ///< turbulent kinds' values lie inside, of the others all
  IntegerScaling scaling = IntegerScaling::stretch;
  std::unique_ptr<SyntheticField> (*make)(const SyntheticOptions&) = nullptr;
};

/// All kinds, in the order of the documentation.
std::span<const SyntheticKind> synthetic_kinds();
/// Throws Error(usage) listing the known names.
const SyntheticKind& find_synthetic_kind(std::string_view name);

inline constexpr std::string_view kSyntheticExtents =
    "every axis must be 1 to 2147483647 and the volume below 2^60 voxels";
bool is_synthetic_extent(const Index3& extent);

/// info(): path "synthetic:KIND", format "synthetic", type float32. bytes_read() counts the bytes made. Throws
/// Error(usage) for an unknown kind and where !is_synthetic_extent().
std::unique_ptr<VolumeSource> open_synthetic(std::string_view kind, const SyntheticOptions& options);

}  // namespace weir
