// Drivers are parts of weir that need a large external library: HDF5, OpenVDB or cairo. They are shared objects,
// loaded at their first use. So a user of raw files pays neither for their memory nor for their start, and a build
// without them is the same program.
#pragma once

#include <string>

namespace weir {

/// Loads weir_NAME.so and calls its entry, once, and returns the entry's result. The dynamic linker finds the file by
/// the run path of the program or library that holds this code: the build's drivers/, or the installation's folder
/// weir beside its libraries. If the environment has WEIR_DRIVERS, an absolute path, the file is taken from that
/// folder. Throws Error(io), beginning with `what` ("a.h5: is an HDF5 file"), if the file is missing, cannot be
/// loaded or is of another build of weir. Throws Error(usage) if WEIR_DRIVERS is not absolute.
const void* load_driver(const std::string& name, const std::string& what);

/// Defines a driver's entry. Its name contains a digest of the headers that both sides are compiled with, so that no
/// program loads a driver of another build.
#define WEIR_DRIVER_ENTRY extern "C" __attribute__((visibility("default"))) const void* WEIR_DRIVER_SYMBOL()

}  // namespace weir
