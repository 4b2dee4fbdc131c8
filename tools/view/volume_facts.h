// What a page says of a file besides its picture, as JSON: its grid, its certificate, its histogram.
#pragma once

#include <atomic>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>

#include "format/nanovdb/nvdb_file.h"

namespace weir {

/// Bins of a histogram that is sent: a page has no more pixels for it.
inline constexpr std::size_t kViewBins = 256;

/// The grid and, of the sidecar where one belongs to the file, the certificate; quick. `range` are the values at the
/// ends of colours and opacity, `background` as RenderOptions has it. Throws as read_sidecar.
nlohmann::ordered_json volume_facts(const NvdbFile& file, MinMax range, float background);

/// {"min", "max", "counts"}: the sidecar's, else counted, which decodes the whole file. Throws Error(interrupted) where
/// `cancel` was set meanwhile.
nlohmann::ordered_json histogram_facts(const NvdbFile& file, const std::atomic<bool>& cancel);

/// Colours of all maps by name: kMapColours of them each, "#rrggbb".
inline constexpr std::size_t kMapColours = 17;
nlohmann::ordered_json colormap_facts();

}  // namespace weir
