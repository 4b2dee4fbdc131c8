// What a Zarr array is as a volume: its axes, where its voxels lie, what its values mean.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "ingest/source/index_choice.h"
#include "ingest/source/volume_source.h"
#include "ingest/zarr/meaning/multiscales.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

struct ArrayMeaning {
  std::vector<ScaleAxis> axes;      ///< as many as the array has, slowest first
  std::vector<double> scale;        ///< world units per step along each axis
  std::vector<double> translation;  ///< of the centre of element 0
  std::string place_note;           ///< what scale and translation do not say of it; else empty
  std::string coordinates_note;     ///< which axes have coordinates, as none are read; else empty
  ValueMapping mapping;             ///< by the attributes scale_factor, add_offset, missing_value and _FillValue
  std::string units;                ///< of the values, by the attribute units
  std::string long_name;
  std::string obstacle;  ///< why it is no volume; empty where it is one

  /// Those before the last three, which --index takes positions on.
  std::vector<LeadingAxis> leading(const ZarrArray& array) const;
};

/// `level` is the array's, where an image has it as one.
ArrayMeaning array_meaning(const ZarrArray& array, const std::optional<FoundLevel>& level);

/// The positions on the leading axes: those that `index` gives, or 0 on each where each has one element alone. Throws
/// Error(usage), beginning with `where`, where they do not fit.
std::vector<std::int64_t> checked_index(const ZarrArray& array, const ArrayMeaning& meaning,
                                        const std::vector<std::int64_t>& index, const std::string& where);

/// Puts extent, spacing, origin, labels, units and what else `meaning` says into `info`.
void describe_volume(const ZarrArray& array, const ArrayMeaning& meaning, const std::vector<std::int64_t>& index,
                     SourceInfo& info);

/// "t 3, z 64, y 128, x 128".
std::string axes_text(const ZarrArray& array, const ArrayMeaning& meaning);

}  // namespace weir
