// Parts of weir that need a large library of others, HDF5, OpenVDB or cairo, are shared objects of their own
// ("drivers"), loaded at their first use: who reads raw files pays neither for their memory nor for their start, and a
// build without them is the same program.
#pragma once

#include <string>

namespace weir {

/// What the entry of weir_NAME.so returns, which is loaded and called once. The dynamic linker looks for the file where
/// the run path of the program or library that holds this code says: the build's drivers/, or the installation's folder
/// weir beside its libraries; or it lies in the folder WEIR_DRIVERS of the environment, an absolute path. Throws
/// Error(io), beginning with `what` ("a.h5: is an HDF5 file"), where it is not there, cannot be loaded or is of another
/// build of weir.
const void* load_driver(const std::string& name, const std::string& what);

/// A driver's entry, which the driver defines by WEIR_DRIVER_ENTRY: a digest of the headers that both sides are
/// compiled with is a part of its name, so that no program takes a driver of another build.
#define WEIR_DRIVER_ENTRY extern "C" __attribute__((visibility("default"))) const void* WEIR_DRIVER_SYMBOL()

}  // namespace weir
