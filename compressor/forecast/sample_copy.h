// The values of a sample in a file without a name: read once, from wherever they lie, converted as often as it takes.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>

#include "format/io/file_system.h"
#include "ingest/source/volume_source.h"

namespace weir {

/// A source of the same values as float32, which lie in the page cache. Thread-safe.
class SampleCopy final : public VolumeSource {
 public:
  /// Reads all of `sample`, which must outlive the object for places(), in blocks of at most `block_bytes` and writes
  /// them to `file`. Throws what reading and writing throw, and Error(interrupted) where `cancel`, which may be null,
  /// says so.
  SampleCopy(VolumeSource& sample, std::unique_ptr<File> file, std::uint64_t block_bytes,
             const std::atomic<bool>* cancel);

  const SourceInfo& info() const override { return info_; }
  AccessShape access() const override { return {sizeof(float), {}, {}}; }
  ConversionLoss read(const Box& box, std::span<float> values) override;
  bool in_memory() const override { return true; }
  const CellPlaces* places() const override { return places_; }
  std::uint64_t bytes_read() const override { return bytes_read_; }
  /// What the sample's values lost as they became float32; reading the copy loses nothing more.
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
