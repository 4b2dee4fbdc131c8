#include "ingest/plan/limited_source.h"

#include <mutex>
#include <utility>

#include "ingest/source/forwarded_source.h"

namespace weir {
namespace {

class LimitedSource final : public ForwardedSource {
 public:
  LimitedSource(std::unique_ptr<VolumeSource> source, Bandwidth& bandwidth)
      : ForwardedSource(std::move(source)), bandwidth_(bandwidth) {}

  ConversionLoss read(const Box& box, std::span<float> values) override {
    const ConversionLoss loss = source().read(box, values);
    spend();
    return loss;
  }
  ConversionLoss read_alone(const Box& box, std::span<float> values) override {
    const ConversionLoss loss = source().read_alone(box, values);
    spend();
    return loss;
  }
  ConversionLoss read_repeated(const RepeatedPart& part, std::span<float> values) override {
    const ConversionLoss loss = source().read_repeated(part, values);
    spend();
    return loss;
  }

 private:
  // Several threads may read at once: each pays for the bytes read since the last payment.
  void spend() {
    std::uint64_t bytes = 0;
    {
      const std::scoped_lock lock(mutex_);
      const std::uint64_t read = source().bytes_read();
      bytes = read - std::exchange(paid_, read);
    }
    bandwidth_.spend(bytes);
  }

  Bandwidth& bandwidth_;
  std::mutex mutex_;
  std::uint64_t paid_ = 0;
};

}  // namespace

std::unique_ptr<VolumeSource> limit_source(std::unique_ptr<VolumeSource> source, Bandwidth& bandwidth) {
  return std::make_unique<LimitedSource>(std::move(source), bandwidth);
}

}  // namespace weir
