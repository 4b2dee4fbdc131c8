// Parts of weir that need a large library of others, HDF5 or OpenVDB, are shared objects of their own ("drivers"),
// loaded at their first use: who reads raw files pays neither for their memory nor for their start, and a build without
// them is the same program.
#pragma once

#include <string>

namespace weir {

/// What the function `entry` of weir_NAME.so returns, which is loaded and called once. The file is looked for in the
/// folder WEIR_DRIVERS of the environment, else where the build and the installation put it beside the program or
/// library that holds this code. Throws Error(input), beginning with `what` ("a.h5: is an HDF5 file"), where it is not
/// there, is of another version or cannot be loaded.
const void* load_driver(const std::string& name, const std::string& what);

/// Whether load_driver would find the file.
bool driver_is_there(const std::string& name);

/// A driver's entry, which the driver defines by WEIR_DRIVER_ENTRY: its name holds the version, so that no program
/// takes one of another version.
#define WEIR_DRIVER_ENTRY extern "C" __attribute__((visibility("default"))) const void* WEIR_DRIVER_SYMBOL()

}  // namespace weir
