// What the steps of a conversion tell its caller, and where they stop when it
// asks them to.
#pragma once

#include <cstdint>
#include <string>

#include "compressor/conversion.h"
#include "format/base/error.h"
#include "ingest/plan/block_stream.h"

namespace weir {

/// For passes that `control`, which must outlive them, watches and stops.
StreamOptions stream_options(const ConversionControl& control);

/// What a conversion that was asked to stop ends with, wherever it noticed.
Error interrupted_error();

/// Throws interrupted_error() where `control` says so.
void check_cancel(const ConversionControl& control);

/// Announces a pass over so many voxels; throws as check_cancel.
void start_pass(const ConversionControl& control, const std::string& name, std::uint64_t voxels);

}  // namespace weir
