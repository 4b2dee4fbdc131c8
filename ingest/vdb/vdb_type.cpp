#include "ingest/vdb/vdb_type.h"

#include <algorithm>
#include <array>

namespace weir {
namespace {

constexpr std::array<VdbType, 9> kVdbTypes{{{"Tree_float_5_4_3", ScalarType::float32, 4, VdbLeaf::values, true},
                                            {"Tree_double_5_4_3", ScalarType::float64, 8, VdbLeaf::values, true},
                                            {"Tree_int32_5_4_3", ScalarType::int32, 4, VdbLeaf::values, false},
                                            {"Tree_int64_5_4_3", ScalarType::int64, 8, VdbLeaf::values, false},
                                            {"Tree_bool_5_4_3", ScalarType::uint8, 1, VdbLeaf::boolean, false},
                                            {"Tree_mask_5_4_3", ScalarType::uint8, 1, VdbLeaf::mask, false},
                                            {"Tree_vec3s_5_4_3", ScalarType::float32, 12, VdbLeaf::values, true, 3},
                                            {"Tree_vec3d_5_4_3", ScalarType::float64, 24, VdbLeaf::values, true, 3},
                                            {"Tree_vec3i_5_4_3", ScalarType::int32, 12, VdbLeaf::values, false, 3}}};

}  // namespace

const VdbType* vdb_type(std::string_view name) {
  const auto* const found =
      std::find_if(kVdbTypes.begin(), kVdbTypes.end(), [&](const VdbType& type) { return type.tree == name; });
  return found == kVdbTypes.end() ? nullptr : found;
}

}  // namespace weir
