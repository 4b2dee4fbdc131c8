// Surveys the near rungs of all blocks of a field on the device and compares them with the CPU's.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "bench/gpu/block_field.h"
#include "bench/gpu/device_seconds.h"
#include "format/packed/block_encode.h"
#include "format/packed/lattice_block.h"
#include "format/packed/rounded_block.h"
#include "gpu/cuda/encode/launch.h"
#include "gpu/cuda/runtime/device_array.h"

namespace weir {

class NearSurvey {
 public:
  /// `values`, `tables` and `codes` are on the device.
  NearSurvey(const Field& field, const float* values, const CostTables* tables, const CodeTables* codes,
             const RungAsk& ask)
      : field_(field),
        ask_(ask),
        figures_(static_cast<std::size_t>(field.blocks())),
        costs_(ask.near.most() * figures_.size()) {
    const DeviceArray<BlockFigures> figures(figures_.size());
    const DeviceArray<NearCost> costs(costs_.size());
    const DeviceArray<RungCost> rungs(ask.most() * figures_.size());
    SurveyCall survey;
    survey.box = field.box(values);
    survey.tables = tables;
    survey.ask = ask;
    survey.figures = figures.data();
    survey.costs = rungs.data();
    launch_survey(survey, cudaStreamPerThread);
    const NearCall call{survey.box, tables, codes, ask, figures.data(), rungs.data(), costs.data()};
    seconds_ = device_seconds([&] { launch_near_survey(call, cudaStreamPerThread); });
    figures.download(figures_);
    costs.download(costs_);
  }

  double seconds() const { return seconds_; }

  /// Returns the number of blocks for which the CPU's result differs.
  std::size_t compare() const {
    std::atomic<std::size_t> other{0};
    on_all_cores(field_.blocks(), [&](std::int64_t first, std::int64_t end) {
      thread_local const auto rounded = std::make_unique<RoundedBlock>();
      thread_local const auto coder = std::make_unique<ValueEncoder>(built_in_tables(), ValueEncoder::Kind::lattice);
      std::array<float, 512> values;
      for (std::int64_t b = first; b < end; ++b) {
        field_.block(b, values);
        other += is_same(static_cast<std::size_t>(b), values, *rounded, *coder) ? 0 : 1;
      }
    });
    return other;
  }

 private:
  bool is_same(std::size_t b, const std::array<float, 512>& values, RoundedBlock& rounded,
               const ValueEncoder& coder) const {
    const BlockFigures& figures = figures_[b];
    const bool has_some = figures.transformed != 0 && figures.lattice == 0 && figures.energy > 0;
    if (figures.near != (has_some ? ask_.near.most() : 0U)) return false;
    if (!has_some) return true;
    rounded.set(values);
    const std::int32_t coarsest = coarsest_near_exponent(rounded.exponent());
    const auto start = static_cast<std::uint32_t>(near_rung_about(coarsest, ask_.near.wanted));
    for (std::uint32_t k = 0; k < figures.near; ++k) {
      const NearCost& cost = costs_[ask_.near.most() * b + k];
      const bool needed = !ask_.searches() || figures.first_near + k == start;
      if (cost.bytes == 0 && !needed) continue;
      const auto expected = rounded.cost(coarsest - static_cast<std::int32_t>(figures.first_near + k));
      if (cost.bytes != (expected ? expected->bytes : kNoNearBytes)) return false;
      if (expected && cost.squared_error != expected->squared_error) return false;
    }
    const bool sparse = 2 * std::count(values.begin(), values.end(), 0.0F) > 512;
    if ((figures.ordered_bytes != 0) != (ask_.near.all || sparse)) return false;
    if (figures.ordered_bytes == 0) return true;
    BlockConstants constants;
    constants.tables = built_in_tables();
    std::array<std::byte, 4096> out;
    return encode_exact(coder, constants, std::nullopt, values, out) == figures.ordered_bytes;
  }

  const Field& field_;
  RungAsk ask_;
  std::vector<BlockFigures> figures_;
  std::vector<NearCost> costs_;
  double seconds_ = 0;
};

}  // namespace weir
