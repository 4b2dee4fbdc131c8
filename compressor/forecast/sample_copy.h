// Copies the values of a sample to a file without a name. They are read once from their source and can then be
// converted several times.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "format/io/file_system.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// A source that gives the sample's values as float32 from the page cache. Thread-safe.
class SampleCopy final : public VolumeSource {
 public:
  /// Reads all of `sample` in blocks of at most `block_bytes` and writes them to `file`. `sample` must outlive the
  /// object because of places(). `cancel` may be null. Throws what reading and writing throw, and Error(interrupted)
  /// when `*cancel` is set.
  SampleCopy(VolumeSource& sample, std::unique_ptr<File> file, std::uint64_t block_bytes,
             const std::atomic<bool>* cancel);

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {sizeof(float), {}, {}}; }
  ConversionLoss read(const Box& box, std::span<float> values) override;
  bool in_memory() const override { return true; }
  const CellPlaces* places() const override { return places_; }
  std::uint64_t bytes_read() const override { return bytes_read_; }
  /// Returns the loss of the sample's values in the conversion to float32. Reading the copy loses nothing more.
  const ConversionLoss& copied_loss() const { return copied_loss_; }

 private:
  template <typename Action>
  void for_each_run(const Box& box, const Action& action) const;

  SourceInfo info_;
  const CellPlaces* places_;
  std::unique_ptr<File> file_;
  ConversionLoss copied_loss_;
  std::atomic<std::uint64_t> bytes_read_{0};
};

}  // namespace weir
