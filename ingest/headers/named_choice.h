// Which volume of a file that holds several by name: --dataset, or the only one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace weir {

/// One volume that a file holds.
struct NamedVolume {
  std::string name;      ///< as --dataset takes it
  std::string obstacle;  ///< why it cannot be converted; empty where it can
};

/// Position in `there` of the one called `wanted` or, where that is empty, of the only one that can be converted.
/// `kind` is what messages call one, "grid". Throws Error(input) where there is none of that name or it cannot be
/// converted, Error(usage) where several can be and none is named; the message says which there are.
std::size_t choose_volume(const std::string& path, std::string_view kind, std::span<const NamedVolume> there,
                          const std::string& wanted);

}  // namespace weir
