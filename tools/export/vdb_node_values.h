// The values of one node as a .vdb file stores them: active ones, perhaps
// compressed; of inactive ones only what is needed to restore them bit for bit.
// OpenVDB's own writer compares inactive values as numbers and so turns -0.0 into
// 0.0; this one compares bits.
#pragma once

#include <cstdint>
#include <ostream>
#include <span>

namespace weir {

/// The greatest finite 16-bit float.
inline constexpr float kMaxHalf = 65504;

/// How the values of a grid are stored.
struct VdbStorage {
  /// kVdbZip or kVdbBlosc or neither (ingest/vdb/vdb_header.h). kVdbActiveMask is always set in the file.
  std::uint32_t compression = 0;
  bool half = false;     ///< as 16-bit floats; all values given are such
  float background = 0;  ///< as stored
};

/// `value` as a 16-bit float holds it, rounded to nearest; infinite beyond kMaxHalf.
float rounded_to_half(float value);

/// Writes what follows a node's masks: openvdb/io/Compression.h, writeCompressedValues. `values` has an entry for each
/// bit of `active` and of `children`, z fastest; those of children don't matter, and no bit is set in both masks.
void write_vdb_values(std::ostream& out, std::span<const float> values, std::span<const std::uint64_t> active,
                      std::span<const std::uint64_t> children, const VdbStorage& storage);

}  // namespace weir
