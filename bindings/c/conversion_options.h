// The options structs of weir.h as those of the C++ libraries, checked.
#pragma once

#include <atomic>
#include <cstdint>
#include <mutex>
#include <string>

#include "bindings/c/weir.h"
#include "compressor/conversion.h"
#include "ingest/source/source_options.h"
#include "ingest/values/array_source.h"

namespace weir::c {

/// All but data and strides. Throws Error(usage) naming the member that is out of its range.
DenseArray read_volume(const weir_volume* volume);

/// Null: the defaults. `memory` is as given, besides what the process has; output is left empty.
ConversionOptions read_options(const weir_convert_options& options);
/// *options, or what weir_convert_options_init makes where it is null.
weir_convert_options options_or_defaults(const weir_convert_options* options);

/// Null: none given.
SourceOptions read_input_options(const weir_input_options* options);

/// Throws Error(usage) where it is null, empty or a directory, which a rename would refuse after all of the work.
std::string checked_output(const char* path);

/// Makes output and work directory absolute: those of a push must not move with the program's working directory. Throws
/// Error(io) where that is gone and a path is relative to it.
void keep_places(ConversionOptions& options);

/// The callbacks of one conversion, called one at a time.
class Callbacks {
 public:
  explicit Callbacks(const weir_convert_options& options) : options_(options) {}
  Callbacks(const Callbacks&) = delete;
  Callbacks& operator=(const Callbacks&) = delete;

  /// For a conversion that this object outlives.
  ConversionControl control();
  /// Asks whether to go on; where not, whatever looks at control().cancel ends.
  void look_for_cancel();

 private:
  void start(const std::string& pass, std::uint64_t total_bytes);
  void advance(std::uint64_t done_bytes);
  void ask_cancel();

  weir_convert_options options_;
  std::mutex mutex_;
  std::string pass_;
  std::uint64_t total_bytes_ = 0;
  std::atomic<bool> cancelled_{false};
};

}  // namespace weir::c
