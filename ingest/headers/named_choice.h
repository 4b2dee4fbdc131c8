// Which volume of a file that holds several by name: --dataset, or the only one.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "format/base/error.h"
#include "format/base/message.h"

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

/// Error(usage) of a file of `count` volumes, called `kind` ("components"), of which none was named: "PATH: holds 9
/// volumes; choose one with --dataset: CHOICE; CHOICE; and 7 more (weir inspect lists them)". `choices`, at least one,
/// say how to take each; few are shown.
Error several_volumes(const std::string& path, std::string_view kind, std::size_t count,
                      std::span<const Message> choices);

}  // namespace weir
