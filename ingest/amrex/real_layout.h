// AMReX's description of stored numbers, its RealDescriptor, "((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2
// 1)))": the format of the bits and the order of the bytes. See Src/Base/AMReX_FabConv.cpp and AMReX_FPC.cpp.
#pragma once

#include <string>

#include "format/base/scalar_type.h"
#include "ingest/amrex/plotfile_text.h"

namespace weir {

struct RealLayout {
  ScalarType type = ScalarType::float64;  ///< float64 or float32
  bool big_endian = false;

  friend bool operator==(const RealLayout&, const RealLayout&) = default;
};

/// Returns the layout as text: "float64", "big-endian float32".
std::string real_layout_text(const RealLayout& layout);

/// Throws Error(input) if the format is not IEEE single or double precision, or if the bytes are in neither rising
/// nor falling order.
RealLayout parse_real_layout(PlotfileText& text);

}  // namespace weir
