// An open dataset or group of a file, and its name for messages.
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

/// Returns the path of the file that holds an open object; an external link may have led to another file than the
/// opened one. Empty if the path has 4096 bytes or more. The caller holds Hdf5Lock.
std::string file_of(hid_t object);

/// Returns the groups around an object, innermost first, the root last: for "/a/b/c" these are "/a/b", "/a" and "/".
/// Leaves out groups that cannot be opened. The caller holds Hdf5Lock.
std::vector<Hdf5Handle> enclosing_groups(hid_t file, const std::string& name);

/// Returns the object that the link `name` of `group` leads to. The handle is invalid if there is no such link, or if
/// the link points to another place where nothing is. Throws Error(input) if the file has the object but it cannot be
/// opened. The caller holds Hdf5Lock.
Hdf5Handle open_linked(hid_t group, const std::string& name);

bool is_dataset(hid_t object);

/// Returns whether `object` is an openPMD record component with one constant value: a group with the attributes
/// `value` and `shape` instead of a dataset. For this function and for is_dataset() the caller holds Hdf5Lock.
bool is_openpmd_constant(hid_t object);

}  // namespace weir
