#include "ingest/hdf5/file/hdf5_type.h"

#include <array>

#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {
namespace {

struct Known {
  hid_t type;
  StoredType stored;
};

// Returns the type IEEE 754 binary16, which the library has no name for.
Hdf5Handle half(hid_t single) {
  Hdf5Handle type(H5Tcopy(single));
  H5Tset_fields(type.get(), 15, 10, 5, 0, 10);
  H5Tset_size(type.get(), 2);
  H5Tset_ebias(type.get(), 15);
  return type;
}

// Returns whether `type` is a boolean as h5py and Fortran compilers store it.
bool is_boolean(hid_t type) {
  if (H5Tget_nmembers(type) != 2) return false;
  char* const first = H5Tget_member_name(type, 0);
  const bool named = first != nullptr && std::string_view(first) == "FALSE";
  H5free_memory(first);
  return named;
}

std::string number_text(hid_t type, std::string_view kind) {
  return cat(kind, " of ", H5Tget_precision(type), " bits in ", H5Tget_size(type), " bytes");
}

}  // namespace

std::optional<StoredType> stored_type(hid_t type) {
  const Hdf5Handle half_little = half(H5T_IEEE_F32LE);
  const Hdf5Handle half_big = half(H5T_IEEE_F32BE);
  using enum ScalarType;
  const std::array known{
      Known{H5T_STD_U8LE, {uint8, false}},        Known{H5T_STD_I8LE, {int8, false}},
      Known{H5T_STD_U16LE, {uint16, false}},      Known{H5T_STD_I16LE, {int16, false}},
      Known{H5T_STD_U32LE, {uint32, false}},      Known{H5T_STD_I32LE, {int32, false}},
      Known{H5T_STD_U64LE, {uint64, false}},      Known{H5T_STD_I64LE, {int64, false}},
      Known{half_little.get(), {float16, false}}, Known{H5T_IEEE_F32LE, {float32, false}},
      Known{H5T_IEEE_F64LE, {float64, false}},    Known{H5T_STD_U8BE, {uint8, false}},
      Known{H5T_STD_I8BE, {int8, false}},         Known{H5T_STD_U16BE, {uint16, true}},
      Known{H5T_STD_I16BE, {int16, true}},        Known{H5T_STD_U32BE, {uint32, true}},
      Known{H5T_STD_I32BE, {int32, true}},        Known{H5T_STD_U64BE, {uint64, true}},
      Known{H5T_STD_I64BE, {int64, true}},        Known{half_big.get(), {float16, true}},
      Known{H5T_IEEE_F32BE, {float32, true}},     Known{H5T_IEEE_F64BE, {float64, true}},
  };
  for (const Known& candidate : known) {
    if (H5Tequal(type, candidate.type) > 0) return candidate.stored;
  }
  return std::nullopt;
}

std::optional<StoredType> enumerated_type(hid_t type) {
  if (H5Tget_class(type) != H5T_ENUM) return std::nullopt;
  const Hdf5Handle base(H5Tget_super(type));
  return stored_type(base.get());
}

std::string type_text(hid_t type) {
  if (const auto stored = stored_type(type)) {
    return cat(stored->big_endian ? "big-endian " : "", scalar_name(stored->scalar));
  }
  switch (H5Tget_class(type)) {
    case H5T_INTEGER:
      return number_text(type, "integer");
    case H5T_FLOAT:
      return cat(number_text(type, "float"), H5Tget_size(type) == 2 ? ", not IEEE 754" : "");
    case H5T_STRING:
      return H5Tis_variable_str(type) > 0
                 ? "text of any length"
                 : cat("text of ", H5Tget_size(type), H5Tget_size(type) == 1 ? " byte" : " bytes");
    case H5T_BITFIELD:
      return number_text(type, "bit field");
    case H5T_OPAQUE:
      return cat("opaque of ", H5Tget_size(type), " bytes");
    case H5T_COMPOUND:
      return cat("compound of ", H5Tget_nmembers(type), " members");
    case H5T_REFERENCE:
      return "reference";
    case H5T_ENUM:
      return is_boolean(type) ? "boolean" : cat("enumeration of ", H5Tget_nmembers(type), " names");
    case H5T_VLEN:
      return "list of any length";
    case H5T_ARRAY: {
      const Hdf5Handle element(H5Tget_super(type));
      return cat("array of ", type_text(element.get()));
    }
    default:
      return "unknown type";
  }
}

}  // namespace weir
