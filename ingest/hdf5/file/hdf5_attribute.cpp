#include "ingest/hdf5/file/hdf5_attribute.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_error.h"
#include "ingest/hdf5/file/hdf5_handle.h"
#include "ingest/hdf5/file/hdf5_type.h"
#include "ingest/headers/header_text.h"

namespace weir {
namespace {

/// An open attribute, its type and its number of values; it has no values if it is absent.
struct Attribute {
  Attribute(hid_t owner, const char* called) : object(owner), name(called) {
    if (!has_attribute(object, name)) return;
    handle = Hdf5Handle(H5Aopen(object, name, H5P_DEFAULT));
    if (!handle) throw attribute_error(object, name);
    type = Hdf5Handle(H5Aget_type(handle.get()));
    if (!type) throw attribute_error(object, name);
    space = Hdf5Handle(H5Aget_space(handle.get()));
    const hssize_t points = H5Sget_simple_extent_npoints(space.get());
    if (points < 0) throw attribute_error(object, name);
    values = static_cast<std::size_t>(points);
    if (values > 0) kind = H5Tget_class(type.get());
  }

  bool fits() const { return values <= kMaxAttributeValues; }

  void read_into(hid_t memory_type, void* memory) const {
    if (H5Aread(handle.get(), memory_type, memory) < 0) throw attribute_error(object, name);
  }

  template <typename T>
  std::vector<T> read_as(hid_t memory_type) const {
    std::vector<T> read(values);
    read_into(memory_type, read.data());
    return read;
  }

  hid_t object;
  const char* name;
  Hdf5Handle handle;
  Hdf5Handle type;
  Hdf5Handle space;
  std::size_t values = 0;
  H5T_class_t kind = H5T_NO_CLASS;
};

std::string attribute_text(const char* text, std::size_t limit) {
  std::string_view view(text, strnlen(text, limit));
  while (view.ends_with(' ')) view.remove_suffix(1);
  return std::string(view);
}

std::vector<std::string> fixed_texts(const Attribute& attribute) {
  const std::size_t width = H5Tget_size(attribute.type.get());
  if (width == 0 || width > kMaxAttributeBytes / attribute.values) return {};
  std::vector<char> bytes(width * attribute.values);
  attribute.read_into(attribute.type.get(), bytes.data());
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < attribute.values; ++i) texts.push_back(attribute_text(bytes.data() + i * width, width));
  return texts;
}

// A conversion that leaves the source's bytes unchanged.
herr_t keep_stored(hid_t, hid_t, H5T_cdata_t* path, std::size_t, std::size_t, std::size_t, void*, void*, hid_t) {
  if (path->command == H5T_CONV_INIT) path->need_bkg = H5T_BKG_NO;
  return 0;
}

// Returns the bytes of all texts, from the references that the file stores in their place: a little-endian 32-bit
// length and the text's address ("HDF5 File Format Specification", variable-length types). The library has no call
// for this, and to read the texts it takes five times their memory. Returns nullopt if the library does not give the
// references.
std::optional<std::uint64_t> bytes_of_variable_texts(const Attribute& attribute) {
  constexpr const char* kConversion = "weir: stored references";
  const std::size_t width = static_cast<std::size_t>(H5Aget_storage_size(attribute.handle.get())) / attribute.values;
  constexpr std::size_t kLengthBytes = 4;
  if (width < kLengthBytes) return std::nullopt;
  const Hdf5Handle as_stored(H5Tcreate(H5T_OPAQUE, width));
  std::vector<unsigned char> references(width * attribute.values);
  if (H5Tregister(H5T_PERS_SOFT, kConversion, attribute.type.get(), as_stored.get(), keep_stored) < 0) {
    return std::nullopt;
  }
  const bool read = H5Aread(attribute.handle.get(), as_stored.get(), references.data()) >= 0;
  H5Tunregister(H5T_PERS_SOFT, kConversion, -1, -1, keep_stored);
  if (!read) return std::nullopt;
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < attribute.values; ++i) {
    for (std::size_t b = 0; b < kLengthBytes; ++b) bytes += std::uint64_t{references[i * width + b]} << (8 * b);
  }
  return bytes;
}

std::vector<std::string> variable_texts(const Attribute& attribute) {
  if (bytes_of_variable_texts(attribute).value_or(0) > kMaxAttributeBytes) return {};
  // The library converts no character sets, so the memory type must have the file's character set.
  const Hdf5Handle memory_type(H5Tcopy(H5T_C_S1));
  H5Tset_size(memory_type.get(), H5T_VARIABLE);
  H5Tset_cset(memory_type.get(), H5Tget_cset(attribute.type.get()));
  std::vector<char*> pointers(attribute.values, nullptr);
  attribute.read_into(memory_type.get(), pointers.data());
  std::vector<std::string> texts;
  for (const char* text : pointers) texts.push_back(text == nullptr ? "" : attribute_text(text, kMaxAttributeBytes));
  H5Dvlen_reclaim(memory_type.get(), attribute.space.get(), H5P_DEFAULT, pointers.data());
  return texts;
}

/// The most values that a message shows.
constexpr std::size_t kMostShown = 4;

template <typename T>
std::vector<StoredValue> stored(const std::vector<T>& values) {
  return {values.begin(), values.end()};
}

}  // namespace

Error attribute_error(hid_t object, const char* name) {
  const std::string reason = hdf5_reason();  // before a further call overwrites it
  return input_error(object_text(object), cat("its attributes cannot be read, looking for ", name, ": ", reason,
                                              "; they are damaged, or of a later version of HDF5: copy the "
                                              "file again, or write it anew"));
}

void check_attribute_bytes(hid_t object) {
  H5O_info_t info;
  // Either all attributes are in the object's header, with at most 64 KiB each, or none is.
  if (H5Oget_info2(object, &info, H5O_INFO_NUM_ATTRS | H5O_INFO_HDR) < 0) return;
  constexpr std::uint64_t kAttributeMessage = std::uint64_t{1} << 12U;
  if (info.num_attrs == 0 || (info.hdr.mesg.present & kAttributeMessage) != 0) return;
  if (H5Oget_info2(object, &info, H5O_INFO_META_SIZE) < 0) return;
  const std::uint64_t bytes = info.meta_size.attr.heap_size;
  if (bytes <= kMaxObjectAttributeBytes) return;
  throw input_error(object_text(object),
                    cat("its attributes take ", bytes, " bytes, and at most ", kMaxObjectAttributeBytes,
                        " are read; shorten the longest, or make a dataset of it"));
}

bool has_attribute(hid_t object, const char* name) {
  const htri_t found = H5Aexists(object, name);
  if (found < 0) throw attribute_error(object, name);
  return found > 0;
}

std::size_t attribute_values(hid_t object, const char* name) { return Attribute(object, name).values; }

std::vector<double> number_attribute(hid_t object, const char* name) {
  const Attribute attribute(object, name);
  if (!attribute.fits() || (attribute.kind != H5T_INTEGER && attribute.kind != H5T_FLOAT)) return {};
  return attribute.read_as<double>(H5T_NATIVE_DOUBLE);
}

std::vector<StoredValue> stored_value_attribute(hid_t object, const char* name) {
  const Attribute attribute(object, name);
  if (!attribute.fits()) return {};
  if (attribute.kind == H5T_FLOAT) return stored(attribute.read_as<double>(H5T_NATIVE_DOUBLE));
  if (attribute.kind == H5T_INTEGER && H5Tget_sign(attribute.type.get()) == H5T_SGN_NONE) {
    return stored(attribute.read_as<std::uint64_t>(H5T_NATIVE_UINT64));
  }
  if (attribute.kind == H5T_INTEGER) return stored(attribute.read_as<std::int64_t>(H5T_NATIVE_INT64));
  std::vector<StoredValue> values;
  for (const std::string& text : text_attribute(object, name)) {
    if (const auto value = parse_stored_value(text)) values.push_back(*value);
  }
  return values;
}

std::vector<StoredValue> enumerated_value_attribute(hid_t object, const char* name) {
  const Attribute attribute(object, name);
  if (attribute.kind != H5T_ENUM || !attribute.fits()) return stored_value_attribute(object, name);
  const Hdf5Handle base(H5Tget_super(attribute.type.get()));
  if (H5Tget_sign(base.get()) == H5T_SGN_NONE) {
    return stored(attribute.read_as<std::uint64_t>(H5T_NATIVE_UINT64));
  }
  return stored(attribute.read_as<std::int64_t>(H5T_NATIVE_INT64));
}

std::vector<std::string> text_attribute(hid_t object, const char* name) {
  const Attribute attribute(object, name);
  if (!attribute.fits() || attribute.kind != H5T_STRING) return {};
  return H5Tis_variable_str(attribute.type.get()) > 0 ? variable_texts(attribute) : fixed_texts(attribute);
}

std::string first_text_attribute(hid_t object, const char* name) {
  const std::vector<std::string> texts = text_attribute(object, name);
  return texts.empty() ? "" : texts[0];
}

std::string attribute_found(hid_t object, const char* name) {
  const Attribute attribute(object, name);
  if (attribute.values == 0) return "empty";
  std::vector<std::string> texts;
  if (attribute.kind == H5T_STRING) {
    for (const std::string& text : text_attribute(object, name)) texts.push_back(in_quotes(text));
  } else if (attribute.fits()) {
    for (const StoredValue& value : stored_value_attribute(object, name)) texts.push_back(stored_value_text(value));
  }
  if (texts.empty()) return cat("of type ", type_text(attribute.type.get()));
  if (texts.size() == 1) return texts[0];
  std::string shown;
  for (std::size_t i = 0; i < std::min(texts.size(), kMostShown); ++i) shown += cat(i == 0 ? "" : ", ", texts[i]);
  return cat(texts.size(), " values (", shown, texts.size() > kMostShown ? ", ...)" : ")");
}

}  // namespace weir
