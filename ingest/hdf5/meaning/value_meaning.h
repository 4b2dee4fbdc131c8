// What a dataset's attributes say about its values: units, packing, missing data.
#pragma once

#include <hdf5.h>

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "ingest/hdf5/file/hdf5_type.h"
#include "ingest/source/stored_value.h"

namespace weir {

struct ValueMeaning {
  ValueMapping mapping;
  std::string units;              ///< attribute units (or Units); else empty
  std::optional<double> unit_si;  ///< of openPMD
  std::string obstacle;           ///< an attribute that makes the values unclear; else empty
  bool unpacks = true;            ///< scale and offset are clear
  std::string note;               ///< attributes that nothing is made of; else empty
};

/// `type`, or of integers whose attribute _Unsigned says that they are unsigned ones (NetCDF-3 had none), or not
/// (OPeNDAP has no signed bytes), as these. The caller holds Hdf5Lock.
StoredType type_as_meant(hid_t object, StoredType type);

/// By the conventions of NetCDF and CF: _FillValue and missing_value are missing, values are packed by scale_factor
/// and add_offset. In a NetCDF-4 file values equal to NetCDF's default fill are missing too where that is
/// what unwritten ones read as; of one byte nothing is, as in NetCDF's own tools. `fill` is the dataset's own fill
/// value as stored, empty where the user who wrote the file set none. The caller holds Hdf5Lock.
ValueMeaning value_meaning(hid_t object, const StoredType& type, std::span<const std::byte> fill);

/// Whether `fill`, of a dataset that was never written, may be NetCDF's own choice: its library sets one for each
/// variable. The caller holds Hdf5Lock.
bool may_be_netcdf_fill(hid_t object, const StoredType& type, std::span<const std::byte> fill);

}  // namespace weir
