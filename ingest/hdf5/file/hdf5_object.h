// One dataset (or group) of an open file, and the words for it.
#pragma once

#include <string>
#include <vector>

#include "ingest/hdf5/file/hdf5_handle.h"

namespace weir {

struct Hdf5Object {
  Hdf5Handle handle;
  std::string path;  ///< of the file the user named
  std::string name;  ///< inside it, from the root: "/fields/density"

  /// "PATH: /fields/density", how messages begin.
  std::string where() const { return path + ": " + name; }
};

/// The groups an object lies in, its own first, the root last: "/a/b/c" lies in "/a/b", "/a" and "/". Those
/// that cannot be opened are left out. The caller holds Hdf5Lock.
std::vector<Hdf5Handle> enclosing_groups(hid_t file, const std::string& name);

/// The object that a link of `group` leads to; invalid where there is no such link, or one of another place that leads
/// nowhere. Throws Error(input) where the file has it and it cannot be opened. The caller holds Hdf5Lock.
Hdf5Handle open_linked(hid_t group, const std::string& name);

bool is_dataset(hid_t object);

/// A component of an openPMD record that is the same everywhere: a group with the attributes `value` and
/// `shape` in place of a dataset. The caller holds Hdf5Lock, as for is_dataset.
bool is_openpmd_constant(hid_t object);

}  // namespace weir
