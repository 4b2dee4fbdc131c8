#include "ingest/hdf5/file/hdf5_object.h"

#include <array>

#include "format/base/error.h"
#include "format/base/text.h"
#include "ingest/hdf5/file/hdf5_attribute.h"
#include "ingest/hdf5/file/hdf5_error.h"

namespace weir {

std::string file_of(hid_t object) {
  std::array<char, 4096> name{};
  const ssize_t length = H5Fget_name(object, name.data(), name.size());
  return length > 0 && static_cast<std::size_t>(length) < name.size() ? name.data() : "";
}

std::vector<Hdf5Handle> enclosing_groups(hid_t file, const std::string& name) {
  std::vector<Hdf5Handle> groups;
  std::string rest = name;
  while (rest.size() > 1) {
    const std::size_t slash = rest.rfind('/');
    rest.resize(slash == std::string::npos ? 0 : slash);
    Hdf5Handle group(H5Gopen2(file, rest.empty() ? "/" : rest.c_str(), H5P_DEFAULT));
    if (!group) continue;
    check_attribute_bytes(group.get());
    groups.push_back(std::move(group));
  }
  return groups;
}

Hdf5Handle open_linked(hid_t group, const std::string& name) {
  H5L_info_t info;
  if (name.empty() || H5Lexists(group, name.c_str(), H5P_DEFAULT) <= 0) return {};
  Hdf5Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT));
  if (object) return object;
  const std::string reason = hdf5_reason();  // before a further call overwrites it
  if (H5Lget_info(group, name.c_str(), &info, H5P_DEFAULT) < 0 || info.type != H5L_TYPE_HARD) return {};
  throw input_error(object_text(group),
                    cat("its member ", name, " cannot be opened: ", reason, "; the file is damaged"));
}

bool is_dataset(hid_t object) { return H5Iget_type(object) == H5I_DATASET; }

bool is_openpmd_constant(hid_t object) {
  return H5Iget_type(object) == H5I_GROUP && has_attribute(object, "value") && has_attribute(object, "shape");
}

}  // namespace weir
