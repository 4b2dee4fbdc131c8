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

/// What a caller can watch and stop.
struct ConversionControl {
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const std::string& pass, std::uint64_t total_bytes)>
      pass_started;  ///< float32 bytes; of "check" the file's
  std::function<void(std::uint64_t done_bytes)> pass_advanced;
  Notice notice;
  std::function<void(std::uint64_t bytes)>
      planned;                          ///< of the file, before room is taken for it; again where it is replanned
  std::function<void()> before_commit;  ///< the last call before the output appears; what it throws keeps it from that
  bool pads_file = true;        ///< false: of a trial, whose file is not filled up to the size that was asked for
  BlockCoder* coder = nullptr;  ///< surveys and encodes packed blocks, where there is one; the bytes are the same
  Trace* trace = nullptr;       ///< gets the passes, and what each thread reads, surveys, encodes and writes in them
};

/// For passes that `control`, which must outlive them, watches and stops.
StreamOptions stream_options(const ConversionControl& control);

/// The error of a conversion that was asked to stop, in whichever step.
Error interrupted_error();

/// Throws interrupted_error() where `control` says so.
void check_cancel(const ConversionControl& control);

/// Announces a pass over so many voxels; throws as check_cancel.
void start_pass(const ConversionControl& control, const std::string& name, std::uint64_t voxels);

}  // namespace weir
