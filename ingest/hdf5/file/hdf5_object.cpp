#include "ingest/hdf5/file/hdf5_object.h"

#include "ingest/hdf5/file/hdf5_attribute.h"

namespace weir {

std::vector<Hdf5Handle> enclosing_groups(hid_t file, const std::string& name) {
  std::vector<Hdf5Handle> groups;
  std::string rest = name;
  while (rest.size() > 1) {
    const std::size_t slash = rest.rfind('/');
    rest.resize(slash == std::string::npos ? 0 : slash);
    Hdf5Handle group(H5Gopen2(file, rest.empty() ? "/" : rest.c_str(), H5P_DEFAULT));
    if (group) groups.push_back(std::move(group));
  }
  return groups;
}

bool is_dataset(hid_t object) { return H5Iget_type(object) == H5I_DATASET; }

bool is_openpmd_constant(hid_t object) {
  return H5Iget_type(object) == H5I_GROUP && has_attribute(object, "value") && has_attribute(object, "shape");
}

}  // namespace weir
