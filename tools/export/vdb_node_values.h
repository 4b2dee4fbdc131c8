// Writes the values of one node as a .vdb file stores them: the active values, optionally compressed, and of the
// inactive values only as much as restores them bit for bit. OpenVDB's own writer compares inactive values as numbers
// and so turns -0.0 into 0.0; this writer compares bits.
#pragma once

#include <cstdint>
#include <ostream>
#include <span>

namespace weir {

/// The largest finite 16-bit float.
inline constexpr float kMaxHalf = 65504;

/// How the values of a grid are stored.
struct VdbStorage {
  /// kVdbZip, kVdbBlosc or neither (ingest/vdb/vdb_header.h). kVdbActiveMask is always set in the file.
  std::uint32_t compression = 0;
  bool half = false;     ///< values are stored as 16-bit floats; all given values must be exact in that type
  float background = 0;  ///< as stored
};

/// Returns `value` rounded to the nearest 16-bit float; infinite beyond kMaxHalf.
float rounded_to_half(float value);

/// Writes the data that follow a node's masks (openvdb/io/Compression.h, writeCompressedValues). `values` has an entry
/// for each bit of `active` and of `children`, z fastest. Values at children are ignored; no bit may be set in both
/// masks.
void write_vdb_values(std::ostream& out, std::span<const float> values, std::span<const std::uint64_t> active,
                      std::span<const std::uint64_t> children, const VdbStorage& storage);

}  // namespace weir
