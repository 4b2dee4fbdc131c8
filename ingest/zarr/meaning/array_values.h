// The meaning of the values of a Zarr array.
#pragma once

#include <string>

#include "ingest/source/stored_value.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

struct ArrayValues {
  ValueMapping mapping;  ///< from the attributes scale_factor, add_offset, missing_value and _FillValue
  std::string units;     ///< from the attribute units
  std::string long_name;
  std::string note;      ///< names attributes that are not applied; empty if there are none
  std::string obstacle;  ///< why the values cannot be read or their meaning is unknown; empty if nothing is in the way
};

/// Returns the meaning of the values by the CF conventions (8.1 and 2.5.1), as xarray writes them.
ArrayValues array_values(const ZarrArray& array);

}  // namespace weir
