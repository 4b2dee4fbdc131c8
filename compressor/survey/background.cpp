#include "compressor/survey/background.h"

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "compressor/survey/row_pieces.h"
#include "compressor/team/region_share.h"

namespace weir {
namespace {

struct Sample {
  float value;
  std::uint32_t packed;  // twice the number of voxels it stands for, plus 1 if it merges several samples

  std::uint32_t weight() const { return packed >> 1U; }
  bool repeated() const { return (packed & 1U) != 0; }
};
static_assert(std::max(kExactModeVoxels, kModeSamples* kLeafVoxels) < std::int64_t{1} << 31U);

// Adds a sample, or merges it with the last one if their values are equal: empty space gives one value many times.
void add_sample(float value, std::uint32_t weight, std::vector<Sample>& samples) {
  if (!samples.empty() && samples.back().value == value) {
    samples.back().packed = (samples.back().packed + 2 * weight) | 1U;
  } else {
    samples.push_back({value, 2 * weight});
  }
}

std::size_t fullest(std::span<const std::uint64_t> counts) {
  return static_cast<std::size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
}

// Calls visit(values) for each block of this rank's part of the volume.
template <typename Visit>
void for_each_own_value(VolumeSource& source, const BlockPlan& plan, const StreamOptions& options, Team& team,
                        Visit&& visit) {
  const OwnLeaves own(plan.lattice, team);
  std::vector<Box> boxes;
  for (std::int64_t i = 0; i < plan.size(); ++i) {
    for (const Box& part : own.of(plan.leaf_box(i))) boxes.push_back(plan.voxel_box(part));
  }
  team.run([&] { stream_blocks(source, boxes, options, [&](const Block& block) { visit(block.values); }); });
}

Background mode_of_counts(const Survey& survey, std::size_t bin) {
  Background best{0, "mode", 0};
  std::uint64_t most = 0;
  for (std::size_t i = 0; i < survey.value_counts.size(); ++i) {
    const auto value = static_cast<float>(survey.value_offset + static_cast<int>(i));
    if (survey.value_counts[i] <= most || survey.histogram.bin_of(value) != bin) continue;
    most = survey.value_counts[i];
    best.value = value;
  }
  best.share = static_cast<double>(most) / static_cast<double>(survey.finite);
  return best;
}

// Returns the value with the most weight. `method` is empty if no value occurs in two samples.
Background mode_of_samples(std::vector<Sample>& samples, double total, const std::string& method) {
  tbb::parallel_sort(samples.begin(), samples.end(),
                     [](const Sample& a, const Sample& b) { return a.value < b.value; });
  Background best;
  double most = 0;
  for (std::size_t i = 0; i < samples.size();) {
    double weight = 0;
    std::size_t end = i;
    for (; end < samples.size() && samples[end].value == samples[i].value; ++end) {
      weight += static_cast<double>(samples[end].weight());
    }
    // A single sample is no evidence, even if it stands for the many voxels of a leaf.
    if ((end - i >= 2 || samples[i].repeated()) && weight > most) {
      most = weight;
      best = {samples[i].value + 0.0F, method, weight / total};
    }
    i = end;
  }
  return best;
}

std::vector<Sample> all_voxels_in(const Survey& survey, std::size_t bin, VolumeSource& source, const BlockPlan& plan,
                                  const StreamOptions& options, Team& team) {
  std::vector<Sample> samples;
  for_each_own_value(source, plan, options, team, [&](std::span<const float> values) {
    for (const float v : values) {
      if (std::isfinite(v) && survey.histogram.bin_of(v) == bin) add_sample(v, 1, samples);
    }
  });
  team.concatenate(samples);
  return samples;
}

std::vector<Sample> sampled_leaves(const Survey& survey, std::size_t bin, const RowStore& rows, double& total) {
  const std::int64_t leaves = rows.leaves().size();
  const std::int64_t stride = (leaves + kModeSamples - 1) / kModeSamples;
  Team& team = rows.team();
  const Share own = team.share(leaves);
  struct Part {
    std::vector<Sample> samples;
    std::uint64_t weight = 0;
  };
  tbb::enumerable_thread_specific<Part> parts;
  team.run([&] {
    for_each_row_piece(rows, own.begin, own.end, [&](std::int64_t first, std::span<const LeafRow> piece) {
      Part& part = parts.local();
      for (std::int64_t i = (stride - first % stride) % stride; i < std::ssize(piece); i += stride) {
        const LeafRow& row = piece[static_cast<std::size_t>(i)];
        if (!std::isfinite(row.sample)) continue;
        part.weight += row.finite;
        if (survey.histogram.bin_of(row.sample) == bin) add_sample(row.sample, row.finite, part.samples);
      }
    });
  });
  std::vector<Sample> samples;
  std::uint64_t weight = 0;
  for (const Part& part : parts) {
    samples.insert(samples.end(), part.samples.begin(), part.samples.end());
    weight += part.weight;
  }
  team.concatenate(samples);
  team.sum<std::uint64_t>({&weight, 1});
  total = static_cast<double>(weight);
  return samples;
}

Background middle_of(const Survey& survey, std::size_t bin, std::uint64_t count) {
  const double middle = survey.histogram.first_edge() + (static_cast<double>(bin) + 0.5) * survey.histogram.bin_width();
  return {std::clamp(static_cast<float>(middle), survey.min, survey.max), "bin",
          static_cast<double>(count) / static_cast<double>(survey.finite)};
}

constexpr std::size_t kPaperBins = 1024;

// The arithmetic of the published code, which uses Real = float throughout.
template <typename Real>
std::size_t paper_bin_in(Real value, Real min, Real max) {
  Real v = value - min;
  v /= max - min;
  v *= static_cast<Real>(kPaperBins - 1);
  return static_cast<std::size_t>(v);
}

template <typename Real>
Real paper_edge_in(std::size_t bin, Real min, Real max) {
  return static_cast<Real>(bin) / static_cast<Real>(kPaperBins - 1) * (max - min) + min;
}

// Computes in double if the range overflows float. The published code gets NaN there.
std::size_t paper_bin(float value, float min, float max) {
  return std::isfinite(max - min) ? paper_bin_in(value, min, max) : paper_bin_in<double>(value, min, max);
}

float paper_edge(std::size_t bin, float min, float max) {
  return std::isfinite(max - min) ? paper_edge_in(bin, min, max)
                                  : static_cast<float>(paper_edge_in<double>(bin, min, max));
}

}  // namespace

Background find_background(const Survey& survey, const RowStore& rows, VolumeSource& source, const BlockPlan& plan,
                           const StreamOptions& options) {
  if (const auto& said = source.info().background) return {*said, "source", 0};
  if (survey.finite == 0) return {0, "none", 0};
  const std::vector<std::uint64_t> counts = survey.histogram.counts();
  const std::size_t bin = fullest(counts);
  if (!survey.value_counts.empty()) return mode_of_counts(survey, bin);
  if (survey.min == survey.max) return {survey.min + 0.0F, "mode", 1};
  Background mode;
  if (static_cast<std::int64_t>(survey.voxels()) <= kExactModeVoxels) {
    auto samples = all_voxels_in(survey, bin, source, plan, options, rows.team());
    mode = mode_of_samples(samples, static_cast<double>(survey.finite), "mode");
  } else {
    double total = 0;
    auto samples = sampled_leaves(survey, bin, rows, total);
    mode = mode_of_samples(samples, total, "sampled-mode");
  }
  return mode.method.empty() ? middle_of(survey, bin, counts[bin]) : mode;
}

Background paper_background(const Survey& survey, VolumeSource& source, const BlockPlan& plan,
                            const StreamOptions& options, Team& team) {
  if (survey.finite == 0) return {0, "none", 0};
  if (survey.min == survey.max) return {survey.min + 0.0F, "paper", 1};
  std::vector<std::uint64_t> counts(kPaperBins);
  if (!survey.value_counts.empty()) {
    for (std::size_t i = 0; i < survey.value_counts.size(); ++i) {
      if (survey.value_counts[i] == 0) continue;
      const auto value = static_cast<float>(survey.value_offset + static_cast<int>(i));
      counts[paper_bin(value, survey.min, survey.max)] += survey.value_counts[i];
    }
  } else {
    tbb::enumerable_thread_specific<std::vector<std::uint64_t>> tallies(counts);
    for_each_own_value(source, plan, options, team, [&](std::span<const float> values) {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, values.size(), 65536), [&](const auto& range) {
        std::vector<std::uint64_t>& tally = tallies.local();
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          if (std::isfinite(values[i])) ++tally[paper_bin(values[i], survey.min, survey.max)];
        }
      });
    });
    for (const auto& tally : tallies) {
      for (std::size_t i = 0; i < kPaperBins; ++i) counts[i] += tally[i];
    }
    team.sum<std::uint64_t>(counts);
  }
  const std::size_t bin = fullest(counts);
  const float value = paper_edge(bin, survey.min, survey.max);
  return {value, "paper", static_cast<double>(counts[bin]) / static_cast<double>(survey.finite)};
}

}  // namespace weir
