// The weir_grid handle: a grid in a mapped file or in the caller's memory, and the sidecar that certifies it.
#pragma once

#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <string>

#include "bindings/c/weir.h"
#include "format/nanovdb/nvdb_file.h"
#include "format/sidecar/sidecar.h"
#include "gpu/volume/grid_samples.h"

/// The constructor sets everything except the samples; afterwards it is only read.
struct weir_grid {
 public:
  /// Maps the file at `path`. Throws Error(input).
  explicit weir_grid(const std::string& path);
  /// Reads the grid from `bytes`, which must outlive the object. Throws Error(input).
  weir_grid(std::span<const std::byte> bytes, const char* sidecar);

  const weir::NvdbGrid& grid() const { return file_ ? file_->grid() : *memory_; }
  const weir::NvdbFile* file() const { return file_ ? &*file_ : nullptr; }
  /// Returns the sidecar of this very file; null if there is none.
  const weir::Sidecar* sidecar() const { return sidecar_ ? &*sidecar_ : nullptr; }
  const char* sidecar_text() const { return sidecar_ ? text_.c_str() : nullptr; }
  /// Returns the samples, which the first call builds. Thread-safe.
  weir::GridSamples& samples() const;

 private:
  void take_sidecar(std::string text);

  std::optional<weir::NvdbFile> file_;
  std::optional<weir::NvdbGrid> memory_;
  std::string text_;
  std::optional<weir::Sidecar> sidecar_;
  mutable std::mutex mutex_;
  mutable std::optional<weir::GridSamples> samples_;
};
