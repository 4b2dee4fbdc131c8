// Reads what a dataset's attributes say about its values: units, packing, missing data.
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
  std::string note;               ///< attributes that weir ignores; else empty
};

/// Returns the type that the values mean: `type`, or for integers with an attribute _Unsigned the unsigned or signed
/// type that the attribute says (NetCDF-3 had no unsigned integers, OPeNDAP has no signed bytes). The caller holds
/// Hdf5Lock.
StoredType type_as_meant(hid_t object, StoredType type);

/// Returns the meaning by the conventions of NetCDF and CF: values equal to _FillValue or missing_value are missing,
/// and scale_factor and add_offset pack the values. In a NetCDF-4 file values equal to NetCDF's default fill are
/// missing too, if unwritten values read as that fill. One-byte values have no default fill, as in NetCDF's own
/// tools. `fill` is the dataset's own fill value as stored, empty if the writer of the file set none. The caller
/// holds Hdf5Lock.
ValueMeaning value_meaning(hid_t object, const StoredType& type, std::span<const std::byte> fill);

/// Returns whether `fill`, from a dataset that was never written, may be NetCDF's own choice: its library sets a fill
/// value for each variable. The caller holds Hdf5Lock.
bool may_be_netcdf_fill(hid_t object, const StoredType& type, std::span<const std::byte> fill);

}  // namespace weir
