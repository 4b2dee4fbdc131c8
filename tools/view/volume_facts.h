// What a page says of a file besides its picture, as JSON: its grid, its certificate, its histogram.
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

/// Bins of a histogram that is sent: a page has no more pixels for it.
inline constexpr std::size_t kViewBins = 256;

/// Of a file, or what all steps of a series have in common.
struct SeenValues {
  MinMax range{0, 1};    ///< at the ends of colours and opacity
  float background = 0;  ///< as RenderOptions has it
};
SeenValues seen_values(const SeriesSummary& series);
/// `cells` are the file's, asked for where neither its root nor its certificate names a finite range. Throws as
/// own_sidecar and `cells`.
SeenValues seen_values(const NvdbFile& file, const std::function<std::shared_ptr<const MacrocellGrid>()>& cells);

/// {"range", "background", "opacity"}, the opacity where a scene gives none.
nlohmann::ordered_json values_facts(const SeenValues& values);

/// The grid, `values` and, of the sidecar where one belongs to the file, the certificate; quick. `name` is that of
/// the file for a page, which commands name it by. Throws as read_sidecar.
nlohmann::ordered_json volume_facts(const NvdbFile& file, const std::string& name, const SeenValues& values);

/// {"min", "max", "counts"}: the sidecar's, else counted, which decodes the whole file. Throws Error(interrupted) where
/// `cancel` was set meanwhile.
nlohmann::ordered_json histogram_facts(const NvdbFile& file, const std::atomic<bool>& cancel);

/// Colours of all maps by name: kMapColours of them each, "#rrggbb".
inline constexpr std::size_t kMapColours = 17;
nlohmann::ordered_json colormap_facts();

}  // namespace weir
