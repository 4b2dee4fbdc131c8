// How AMReX says that numbers lie in a file: its RealDescriptor, "((8, (64 11 52 0 1 12 0 1023)),(8, (8 7 6 5 4 3 2
// 1)))", the format of the bits and the order of the bytes. Src/Base/AMReX_FabConv.cpp and AMReX_FPC.cpp have both.
#pragma once

#include <string>

#include "format/base/scalar_type.h"
#include "ingest/amrex/plotfile_text.h"

namespace weir {

struct RealLayout {
  ScalarType type = ScalarType::float64;  ///< or float32
  bool big_endian = false;

  friend bool operator==(const RealLayout&, const RealLayout&) = default;
};

/// "float64", "big-endian float32".
std::string real_layout_text(const RealLayout& layout);

/// Throws Error(input) for any other format than IEEE single and double precision, and bytes in another order than
/// rising or falling.
RealLayout parse_real_layout(PlotfileText& text);

}  // namespace weir
