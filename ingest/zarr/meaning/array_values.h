// What the values of a Zarr array mean.
#pragma once

#include <string>

#include "ingest/source/stored_value.h"
#include "ingest/zarr/metadata/zarr_array.h"

namespace weir {

struct ArrayValues {
  ValueMapping mapping;  ///< by the attributes scale_factor, add_offset, missing_value and _FillValue
  std::string units;     ///< by the attribute units
  std::string long_name;
  std::string note;      ///< attributes that nothing is made of; else empty
  std::string obstacle;  ///< why they cannot be read, or what they mean is unknown; else empty
};

/// By the conventions of CF (8.1 and 2.5.1), as xarray writes them.
ArrayValues array_values(const ZarrArray& array);

}  // namespace weir
