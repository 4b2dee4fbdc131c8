// What a caller of a conversion can watch and stop, and how the conversion's steps report progress and stop on request.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "format/base/error.h"
#include "format/base/message.h"
#include "format/base/trace.h"
#include "format/packed/block_coder.h"
#include "ingest/plan/block_stream.h"

namespace weir {

/// The callbacks and switches by which a caller watches and stops a conversion.
struct ConversionControl {
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string& pass, std::uint64_t total_bytes)>
      pass_started;  ///< total as float32 bytes; for "check" the file's bytes
  std::function<void(std::uint64_t done_bytes)> pass_advanced;
  Notice notice;
  std::function<void(std::uint64_t bytes)>
      planned;  ///< the file's size, before its disk space is reserved; called again if the file is replanned
  /// The last call before the output appears. If it throws, the output does not appear.
  std::function<void()> before_commit;
  bool pads_file = true;        ///< false for a trial: its file is not padded to the requested size
  BlockCoder* coder = nullptr;  ///< if not null, surveys and encodes packed blocks; the file's bytes are the same
  Trace* trace = nullptr;       ///< receives the passes, and what each thread reads, surveys, encodes and writes
};

/// Returns stream options for passes that `control` watches and stops. `control` must outlive the passes.
StreamOptions stream_options(const ConversionControl& control);

/// Returns the error of a conversion that was asked to stop. It is the same error in every step.
Error interrupted_error();

/// Throws interrupted_error() if control.cancel is set.
void check_cancel(const ConversionControl& control);

/// Announces the pass `name` over `voxels` voxels. Throws as check_cancel() does.
void start_pass(const ConversionControl& control, const std::string& name, std::uint64_t voxels);

}  // namespace weir
