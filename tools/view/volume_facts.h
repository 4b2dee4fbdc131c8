// The facts that a page shows of a file besides its picture, as JSON: its grid, certificate and histogram.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "format/nanovdb/nvdb_file.h"
#include "gpu/volume/macrocell_grid.h"
#include "tools/options/volume_series.h"

namespace weir {

/// The most bins of a histogram that is sent; a page has no more pixels for it.
inline constexpr std::size_t kViewBins = 256;

/// The values of a file, or of all steps of a series together.
struct SeenValues {
  MinMax range{0, 1};    ///< values at the ends of colours and opacity
  float background = 0;  ///< as in RenderOptions
};
SeenValues seen_values(const SeriesSummary& series);
/// Returns the values of `file`. `cells` returns the file's macrocells; it is called only if neither the root nor the
/// certificate has a finite range. Throws as own_sidecar and `cells`.
SeenValues seen_values(const NvdbFile& file, const std::function<std::shared_ptr<const MacrocellGrid>()>& cells);

/// Returns {"range", "background", "opacity"}; the opacity is used if a scene gives none.
nlohmann::ordered_json values_facts(const SeenValues& values);

/// Returns the grid, `values` and the certificate, if a sidecar belongs to the file; quick. `name` is the file's name
/// on the page and in commands. Throws as read_sidecar.
nlohmann::ordered_json volume_facts(const NvdbFile& file, const std::string& name, const SeenValues& values);

/// Returns {"min", "max", "counts"} from the sidecar; without a sidecar counts them, which decodes the whole file.
/// Throws Error(interrupted) if `cancel` is set.
nlohmann::ordered_json histogram_facts(const NvdbFile& file, const std::atomic<bool>& cancel);

/// Colours of all maps by name: kMapColours colours each, "#rrggbb".
inline constexpr std::size_t kMapColours = 17;
nlohmann::ordered_json colormap_facts();

}  // namespace weir
