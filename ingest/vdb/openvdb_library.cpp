#include "ingest/vdb/openvdb_library.h"

#include "ingest/drivers/driver.h"

namespace weir {

const OpenVdbLibrary& openvdb_library(const std::string& what) {
  return *static_cast<const OpenVdbLibrary*>(load_driver("openvdb", what));
}

}  // namespace weir
