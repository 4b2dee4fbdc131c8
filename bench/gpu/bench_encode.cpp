// weir_bench_encode [EDGE]: measures how fast the device surveys and encodes the packed blocks of a cloud and of
// turbulence at rates 20 and 8. Each has EDGE^3 float32 values in the device's memory; EDGE is 1024 by default and a
// multiple of 128. For comparison it measures the CPU with all cores, the same blocks sent from the host's memory
// through the device, and a plain copy of the values to the host. Compares each cost, near rung, stream and decoded
// value with the CPU's. Exits with 1 if bits differ, 2 for any other failure.
#include <cuda_runtime_api.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "bench/gpu/block_field.h"
#include "bench/gpu/device_seconds.h"
#include "bench/gpu/near_survey.h"
#include "compressor/packed/ladder_window.h"
#include "format/base/error.h"
#include "format/packed/block_decode.h"
#include "format/packed/block_encode.h"
#include "gpu/cuda/encode/device_coder.h"
#include "gpu/cuda/encode/launch.h"
#include "gpu/cuda/load/pinned_memory.h"
#include "gpu/cuda/runtime/check.h"
#include "gpu/cuda/runtime/device_array.h"
#include "ingest/synthetic/cloud.h"
#include "ingest/synthetic/turbulence.h"

namespace weir {
namespace {

constexpr std::uint32_t kBatch = 1U << 16U;  // streams that are encoded at a time

struct Surveyed {
  RungAsk ask;
  std::vector<BlockFigures> figures;
  std::vector<RungCost> costs;
  double seconds = 0;
};

class Bench {
 public:
  Bench(std::string name, const Field& field, double rate)
      : name_(std::move(name)), field_(field), rate_(rate), values_(field.values.size()) {
    make_encoder_tables(built_in_tables(), host_tables_[0], host_codes_[0]);
    tables_.upload(host_tables_);
    codes_.upload(host_codes_);
    values_.upload(field.values);
  }

  bool run() {
    copy_to_host();
    const Surveyed all = survey({});
    say("survey, all rungs, on the device", all.seconds);
    const std::int32_t step = choose_step(all);
    // The keys of a conversion that has looked ahead.
    const double size = static_cast<double>(step_size(step));
    const SearchKeys keys = KeyWindow(size * size / 2, 1, 1.25).keys();
    const Surveyed about = survey({false, step, {}, keys});
    say("survey, rungs about a known cut, on the device", about.seconds);
    const std::size_t other_costs = compare_costs(about) + (field_.edge <= 512 ? compare_costs(all) : 0);
    // The exponent of the largest power of two that is no coarser than the step.
    const NearAsk near_about{NearBlocks::all, false, -((step + 1) >> 1)};
    const std::size_t other_near = survey_near({false, step, near_about, keys}, "near rungs about it") +
                                   survey_near({true, 0, {NearBlocks::all}}, "all near rungs and floats in order");
    make_asks(all, step);
    const std::size_t other_streams = encode();
    through_host(about.ask);
    const bool same = other_costs + other_near + other_streams == 0;
    std::printf("%-12s %zu blocks have other costs, %zu other near rungs, %zu other streams or values: %s\n",
                name_.c_str(), other_costs, other_near, other_streams, same ? "same bits" : "OTHER BITS");
    std::fflush(stdout);
    return same;
  }

 private:
  void say(const char* what, double seconds) const {
    std::printf("%-12s %-52s %9.4f s %8.1f GB/s\n", name_.c_str(), what, seconds, field_.bytes() / seconds / 1e9);
    std::fflush(stdout);
  }

  void copy_to_host() {
    const std::size_t piece = std::min<std::size_t>(values_.bytes(), std::size_t{1} << 28U);
    std::string refusal;
    const auto pinned = PinnedMemory::make(piece, refusal);
    if (!pinned) throw Error(ErrorKind::io, refusal);
    say("a plain copy to page-locked memory", device_seconds([&] {
          for (std::size_t at = 0; at < values_.bytes(); at += piece) {
            check_cuda(
                cudaMemcpyAsync(pinned->data(), reinterpret_cast<const std::byte*>(values_.data()) + at,
                                std::min(piece, values_.bytes() - at), cudaMemcpyDeviceToHost, cudaStreamPerThread),
                "copying to the host");
          }
        }));
  }

  Surveyed survey(const RungAsk& ask) {
    const auto blocks = static_cast<std::size_t>(field_.blocks());
    Surveyed surveyed{ask, std::vector<BlockFigures>(blocks), std::vector<RungCost>(blocks * ask.most()), 0};
    const DeviceArray<BlockFigures> figures(blocks);
    const DeviceArray<RungCost> costs(surveyed.costs.size());
    SurveyCall call;
    call.box = field_.box(values_.data());
    call.tables = tables_.data();
    call.ask = ask;
    call.figures = figures.data();
    call.costs = costs.data();
    surveyed.seconds = device_seconds([&] { launch_survey(call, cudaStreamPerThread); });
    figures.download(surveyed.figures);
    costs.download(surveyed.costs);
    return surveyed;
  }

  std::size_t survey_near(const RungAsk& ask, const std::string& what) const {
    const NearSurvey near(field_, values_.data(), tables_.data(), codes_.data(), ask);
    say(("survey, " + what + ", on the device").c_str(), near.seconds());
    std::size_t other = 0;
    say(("survey, " + what + ", by the CPU").c_str(), seconds_of([&] { other = near.compare(); }));
    return other;
  }

  // Returns the bytes of all streams at a step.
  double bytes_at(const Surveyed& all, std::int32_t step) const {
    std::atomic<std::uint64_t> bytes{0};
    on_all_cores(field_.blocks(), [&](std::int64_t first, std::int64_t end) {
      std::uint64_t some = 0;
      for (std::int64_t b = first; b < end; ++b) {
        if (const RungCost* cost = cost_at(all, b, step); cost != nullptr) some += (cost->bits + 12) / 8;
      }
      bytes += some;
    });
    return static_cast<double>(bytes);
  }

  // Returns the coarsest step at which the blocks take as many bytes as the rate allows, or half of their most bytes if
  // that is less.
  std::int32_t choose_step(const Surveyed& all) const {
    const double wanted = std::min(field_.bytes() / rate_, bytes_at(all, kMostStep) / 2);
    std::int32_t low = kLeastStep;
    std::int32_t high = kMostStep;
    while (low < high) {
      const std::int32_t middle = (low + high) >> 1;
      if (bytes_at(all, middle) >= wanted) {
        high = middle;
      } else {
        low = middle + 1;
      }
    }
    return low;
  }

  // Returns the cost of the finest rung at `step` or coarser; null if a mean is enough or the block has no rungs.
  static const RungCost* cost_at(const Surveyed& all, std::int64_t b, std::int32_t step, std::int32_t* at = nullptr) {
    const BlockFigures& figures = all.figures[static_cast<std::size_t>(b)];
    const RungCost* found = nullptr;
    for (std::uint32_t k = 0; k < figures.rungs; ++k) {
      const std::int32_t own = rung_step(figures.first_step, figures.first_rung + static_cast<std::int32_t>(k));
      const RungCost& cost = all.costs[all.ask.most() * static_cast<std::size_t>(b) + k];
      if (own > step || cost.bits == 0 || cost.bits > 8 * 2048) break;
      found = &cost;
      if (at != nullptr) *at = own;
    }
    return found;
  }

  std::size_t compare_costs(const Surveyed& surveyed) const {
    std::atomic<std::size_t> other{0};
    const double seconds = seconds_of([&] {
      on_all_cores(field_.blocks(), [&](std::int64_t first, std::int64_t end) {
        thread_local const auto transform = std::make_unique<TransformBlock>();
        std::array<float, 512> values;
        for (std::int64_t b = first; b < end; ++b) {
          field_.block(b, values);
          const BlockFigures& figures = surveyed.figures[static_cast<std::size_t>(b)];
          bool same = transform->set(values) == (figures.transformed != 0);
          if (figures.transformed != 0 && figures.lattice == 0) {
            same = same && figures.mean == transform->mean() && figures.energy == transform->energy() &&
                   static_cast<double>(figures.largest) == transform->largest();
          }
          for (std::uint32_t k = 0; same && k < figures.rungs; ++k) {
            const RungCost& cost = surveyed.costs[surveyed.ask.most() * static_cast<std::size_t>(b) + k];
            if (cost.bits == 0) continue;
            const auto expected =
                transform->cost(rung_step(figures.first_step, figures.first_rung + static_cast<std::int32_t>(k)));
            same = expected.bits == cost.bits && expected.squared_error == cost.squared_error;
          }
          other += same ? 0 : 1;
        }
      });
    });
    say(surveyed.ask.all ? "survey, all rungs, by the CPU" : "survey, rungs about a known cut, by the CPU", seconds);
    return other;
  }

  void make_asks(const Surveyed& all, std::int32_t step) {
    const auto regions = static_cast<std::size_t>(field_.region_of(field_.blocks() - 1) + 1);
    std::vector<MeanRange> means(regions, {3e38F, -3e38F});
    std::int32_t coarsest = step;
    float low = 0;
    float high = 0;
    for (const float v : field_.values) {
      low = std::min(low, v);
      high = std::max(high, v);
    }
    for (std::int64_t b = 0; b < field_.blocks(); ++b) {
      MeanRange& range = means[static_cast<std::size_t>(field_.region_of(b))];
      range.low = std::min(range.low, all.figures[static_cast<std::size_t>(b)].mean);
      range.high = std::max(range.high, all.figures[static_cast<std::size_t>(b)].mean);
    }
    for (std::int64_t b = 0; b < field_.blocks(); ++b) {
      std::int32_t own = 0;
      const RungCost* cost = cost_at(all, b, step, &own);
      if (cost == nullptr || own < step - 40) continue;
      coarsest = std::min(coarsest, own);
      const MeanRange& range = means[static_cast<std::size_t>(field_.region_of(b))];
      const std::uint32_t bytes = stream_bytes(cost->bits, mean_bits(range, own));
      asks_.push_back(
          {range, static_cast<std::uint32_t>(b), 0, static_cast<std::uint16_t>(bytes), static_cast<std::int16_t>(own)});
    }
    for (std::size_t i = 0; i < asks_.size(); ++i) {
      asks_[i].offset = i % kBatch == 0 ? 0 : asks_[i - 1].offset + asks_[i - 1].bytes;
    }
    constants_.minimum = low;
    constants_.maximum = high;
    constants_.coarsest = coarsest;
    constants_.below_one = kBelowOne;
    constants_.below_more = kBelowMore;
    constants_.tables = built_in_tables();
  }

  std::size_t encode() {
    std::uint64_t all_bytes = 0;
    for (const StreamAsk& ask : asks_) all_bytes += ask.bytes;
    const std::size_t room = std::size_t{kBatch} * 2049;
    const DeviceArray<StreamState> states(kBatch);
    const DeviceArray<std::uint32_t> coded(std::size_t{512} * kBatch);
    const DeviceArray<std::uint16_t> words(room / 2 + kBatch + 1);
    const DeviceArray<float> decoded(std::size_t{512} * kBatch);
    const DeviceArray<std::byte> out(room);
    const DeviceArray<std::uint8_t> made(kBatch);
    const DeviceArray<StreamAsk> asks{std::span<const StreamAsk>(asks_)};
    EncodeCall call;
    call.box = field_.box(values_.data());
    call.constants = constants_;
    call.constants.tables = nullptr;
    call.tables = tables_.data();
    call.codes = codes_.data();
    call.states = states.data();
    call.coded = coded.data();
    call.words = words.data();
    call.decoded = decoded.data();
    call.out = out.data();
    call.made = made.data();
    const auto part = [&](std::size_t first) {
      call.asks = asks.data() + first;
      call.count = static_cast<std::uint32_t>(std::min<std::size_t>(kBatch, asks_.size() - first));
      launch_encode(call, cudaStreamPerThread);
    };
    const double seconds = device_seconds([&] {
      for (std::size_t first = 0; first < asks_.size(); first += kBatch) part(first);
    });
    say("encode and decode, on the device", seconds);
    std::printf("%-12s %zu of %lld blocks have streams, %.3f bits a voxel of all, %.1f GB/s of these blocks\n",
                name_.c_str(), asks_.size(), static_cast<long long>(field_.blocks()),
                8.0 * static_cast<double>(all_bytes) / static_cast<double>(field_.values.size()),
                2048.0 * static_cast<double>(asks_.size()) / seconds / 1e9);
    std::atomic<std::size_t> other{0};
    std::atomic<std::size_t> left{0};
    double cpu_seconds = 0;
    std::vector<float> host_decoded(decoded.size());
    std::vector<std::byte> host_out(out.size());
    std::vector<std::uint8_t> host_made(kBatch);
    for (std::size_t first = 0; first < asks_.size(); first += kBatch) {
      part(first);
      decoded.download(host_decoded);
      out.download(host_out);
      made.download(host_made);
      cpu_seconds += seconds_of([&] {
        on_all_cores(call.count, [&](std::int64_t begin, std::int64_t end) {
          thread_local const auto transform = std::make_unique<TransformBlock>();
          std::array<float, 512> values;
          std::array<float, 512> expected;
          std::vector<std::byte> stream;
          for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i) {
            const StreamAsk& ask = asks_[first + i];
            field_.block(ask.block, values);
            stream.resize(ask.bytes);
            transform->set(values);
            transform->encode(constants_, ask.means, ask.step, stream);
            const bool valid = decode_block(constants_, ask.means, stream.data(), ask.bytes, expected.data());
            if (host_made[i] == 0) {
              ++left;
              continue;
            }
            const bool same = valid && std::memcmp(stream.data(), host_out.data() + ask.offset, ask.bytes) == 0 &&
                              std::memcmp(expected.data(), host_decoded.data() + 512 * i, sizeof expected) == 0;
            other += same ? 0 : 1;
          }
        });
      });
    }
    say("encode and decode, by the CPU", cpu_seconds);
    std::printf("%-12s %zu streams are left to the CPU\n", name_.c_str(), left.load());
    return other;
  }

  // Surveys as a conversion does: boxes of 8 MiB from pageable memory, by all cores, with the figures copied back.
  void through_host(const RungAsk& ask) const {
    const auto coder =
        make_device_coder(0, [](const Error& error) { std::printf("the coder has failed: %s\n", error.what()); });
    const std::int64_t n = field_.blocks_along();
    const std::int64_t rows = std::max<std::int64_t>(1, (std::int64_t{8} << 20U) / (field_.edge * 256));
    const std::int64_t along_y = ceil_div(n, rows);
    const auto pass = [&] {
      std::atomic<std::int64_t> next{0};
      std::vector<std::jthread> threads;
      for (unsigned t = 0; t < std::max(1U, std::thread::hardware_concurrency()); ++t) {
        threads.emplace_back([&] {
          std::vector<float> values;
          for (;;) {
            const std::int64_t i = next++;
            if (i >= along_y * n) return;
            const Index3 lo{0, 8 * rows * (i % along_y), 8 * (i / along_y)};
            const Index3 hi{field_.edge, std::min(lo.y + 8 * rows, field_.edge), lo.z + 8};
            values.clear();
            for (std::int64_t z = lo.z; z < hi.z; ++z) {
              const float* from = field_.values.data() + field_.edge * (lo.y + field_.edge * z);
              values.insert(values.end(), from, from + field_.edge * (hi.y - lo.y));
            }
            const auto loaded = coder->load(values, {lo, hi}, {lo, hi});
            if (!loaded) return;
            loaded->begin_survey(ask);
            if (!loaded->end_survey()) return;
          }
        });
      }
    };
    pass();  // allocates the memory
    say("survey of 8 MiB boxes out of the host's memory", seconds_of(pass));
  }

  std::string name_;
  const Field& field_;
  double rate_;
  DeviceArray<float> values_;
  std::vector<CostTables> host_tables_ = std::vector<CostTables>(1);
  std::vector<CodeTables> host_codes_ = std::vector<CodeTables>(1);
  DeviceArray<CostTables> tables_{1};
  DeviceArray<CodeTables> codes_{1};
  std::vector<StreamAsk> asks_;
  BlockConstants constants_;
};

bool measure(const std::string& name, const SyntheticField& field, std::int64_t edge, double rate) {
  Field filled;
  const double seconds = seconds_of([&] { filled = fill(field, edge); });
  std::printf("%-12s %lld^3 float32, made in %.1f s by %u threads\n", name.c_str(), static_cast<long long>(edge),
              seconds, std::thread::hardware_concurrency());
  return Bench(name, filled, rate).run();
}

}  // namespace
}  // namespace weir

int main(int argc, char** argv) {
  try {
    const std::int64_t edge = argc > 1 ? std::strtoll(argv[1], nullptr, 10) : 1024;
    if (edge < 128 || edge % 128 != 0) {
      throw weir::Error(weir::ErrorKind::usage, "usage: weir_bench_encode [EDGE], a multiple of 128");
    }
    weir::use_device(0);
    cudaDeviceProp device{};
    weir::check_cuda(cudaGetDeviceProperties(&device, 0), "asking for the device");
    std::printf("%s\n", device.name);
    const weir::SyntheticOptions options{{edge, edge, edge}, 1};
    bool same = weir::measure("cloud", *weir::make_cloud(options), edge, 20);
    same = weir::measure("turbulence", *weir::make_turbulence(options), edge, 8) && same;
    return same ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "weir_bench_encode: %s\n", error.what());
    return 2;
  }
}
