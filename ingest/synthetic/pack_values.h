// Synthetic values as they go into a raw file: any scalar type, any byte order.
#pragma once

#include <cstddef>
#include <span>

#include "format/base/scalar_type.h"
#include "ingest/synthetic/synthetic.h"

namespace weir {

class ValuePacker {
 public:
  /// How `kind`'s values become `type`:
  /// floats: as they are. Integers, IntegerScaling::stretch: value * scale + shift rounded to nearest
  /// (halves away from zero) and clamped, where for signed types shift = 0 and the nominal range's larger end
  /// becomes the type's largest value, and for unsigned types the range from min(min, 0) to max becomes
  /// the type's range. IntegerScaling::verbatim: rounded and clamped.
  /// Throws Error(usage) where an integer type cannot hold what the kind is about.
  ValuePacker(const SyntheticKind& kind, ScalarType type, bool big_endian);

  /// True where the floats' own bytes are what belongs into the file.
  bool is_identity() const { return identity_; }
  /// `bytes` holds exactly values.size() values of the type. Runs in parallel.
  void pack(std::span<const float> values, std::span<std::byte> bytes) const;

 private:
  ScalarType type_;
  bool big_endian_;
  bool identity_;
  double scale_ = 1.0;
  double shift_ = 0.0;
};

}  // namespace weir
