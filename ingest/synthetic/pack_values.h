// Packs synthetic values for a raw file, in any scalar type and byte order.
#pragma once

#include <cstddef>
#include <span>

#include "format/base/scalar_type.h"
#include "ingest/synthetic/synthetic.h"

namespace weir {

class ValuePacker {
 public:
  /// Packs `kind`'s values as `type`. Floats are kept as they are. Integers with IntegerScaling::stretch are value *
  /// scale + shift, rounded to nearest (halves away from zero) and clamped. For signed types, shift is 0 and the
  /// larger end of the nominal range becomes the type's largest value. For unsigned types, the range from min(min, 0)
  /// to max becomes the type's range. Integers with IntegerScaling::verbatim are rounded and clamped. Throws
  /// Error(usage) if `type` is not supported or cannot hold the values that define the kind.
  ValuePacker(const SyntheticKind& kind, ScalarType type, bool big_endian);

  /// Returns whether the floats' own bytes are the file's bytes.
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
