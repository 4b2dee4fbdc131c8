// Reads and checks the option structs of weir.h and turns them into the structs of the C++ libraries.
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

/// Reads all but data and strides. Throws Error(usage) that names the member that is out of its range.
DenseArray read_volume(const weir_volume* volume);

/// Reads the options. `memory` stays as given: it counts besides what the process has taken already. The output is left
/// empty.
ConversionOptions read_options(const weir_convert_options& options);
/// Returns *options, or the defaults of weir_convert_options_init() if `options` is null.
weir_convert_options options_or_defaults(const weir_convert_options* options);

/// Reads the input options; null means that none are given.
SourceOptions read_input_options(const weir_input_options* options);

/// Returns `path`. Throws Error(usage) if it is null, empty or a directory, because a rename would refuse those only
/// after all the work.
std::string checked_output(const char* path);

/// Makes the output and the work directory absolute, because those of a push must not move with the program's working
/// directory. Throws Error(io) if a path is relative and the working directory is gone.
void keep_places(ConversionOptions& options);

/// The callbacks of one conversion; it calls them one at a time.
class Callbacks {
 public:
  explicit Callbacks(const weir_convert_options& options) : options_(options) {}
  Callbacks(const Callbacks&) = delete;
  Callbacks& operator=(const Callbacks&) = delete;

  /// Returns the control for a conversion, which this object must outlive.
  ConversionControl control();
  /// Asks the caller whether to go on; if not, work that checks control().cancel ends.
  void look_for_cancel();

 private:
  void start(const std::string& pass, std::uint64_t total_bytes);
  void advance(std::uint64_t done_bytes);
  void tell_progress(std::uint64_t done_bytes);
  void ask_cancel();

  weir_convert_options options_;
  std::mutex mutex_;
  std::string pass_;
  std::uint64_t total_bytes_ = 0;
  std::atomic<bool> cancelled_{false};
};

}  // namespace weir::c
