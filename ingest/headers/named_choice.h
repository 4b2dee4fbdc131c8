// Chooses a volume of a file that holds several by name: --dataset, or the only one.
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
  std::string name;      ///< its name for --dataset
  std::string obstacle;  ///< why it cannot be converted; empty if it can
};

/// Returns the position in `there` of the volume called `wanted` or, if `wanted` is empty, of the only one that can
/// be converted. Messages call a volume `kind`, "grid". Throws Error(input) if there is no volume of that name or it
/// cannot be converted. Throws Error(usage), listing the volumes, if several can be converted and none is named.
std::size_t choose_volume(const std::string& path, std::string_view kind, std::span<const NamedVolume> there,
                          const std::string& wanted);

/// Returns Error(usage) for a file of `count` volumes, called `kind` ("components"), of which none was named: "PATH:
/// holds 9 volumes; choose one with --dataset: CHOICE; CHOICE; and 7 more (weir inspect lists them)". `choices` (at
/// least one, few are shown) say how to choose each volume.
Error several_volumes(const std::string& path, std::string_view kind, std::size_t count,
                      std::span<const Message> choices);

}  // namespace weir
