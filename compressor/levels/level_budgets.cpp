#include "compressor/levels/level_budgets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "compressor/levels/smallest_tree.h"
#include "compressor/select/file_size.h"
#include "format/base/error.h"
#include "format/base/message.h"

namespace weir {
namespace {

// Decimals of a rate, rounded down.
constexpr double kRateParts = 100;

// The budget that suits all levels that were added.
struct SuitableBudget {
  std::uint64_t bytes = 0;
  double rate = std::numeric_limits<double>::infinity();
  bool packed = true;

  void add(std::uint64_t dense, std::uint64_t smallest, std::uint64_t asked, const Box& domain) {
    bytes = std::max(bytes, smallest);
    const double exact = static_cast<double>(dense) / static_cast<double>(smallest);
    rate = std::min(rate, std::floor(exact * kRateParts) / kRateParts);
    packed = packed && room_for_packed(domain) <= asked;
  }

  Message text(const ConversionOptions& options) const {
    Message remedy = compose(option("size", bytes), " or more");
    if (options.budget.kind == Budget::Kind::rate && rate >= 1)
      remedy = compose(option("rate", rate), " or less, ", remedy);
    const bool may_pack = options.encoding != Encoding::packed && options.metric == Metric::sse &&
                          options.fill == FillMode::mean && options.non_finite != NonFinitePolicy::keep;
    return packed && may_pack ? compose(remedy, ", or for ", option("encoding", "packed")) : remedy;
  }
};

}  // namespace

void check_level_budgets(std::span<const SeriesStep> steps, std::span<const std::string> outputs, std::size_t at,
                         const ConversionOptions& options,
                         const std::function<std::unique_ptr<VolumeSource>(const SeriesStep&)>& open) {
  if (!options.budget.by_size() || steps[at].from_finest != 0) return;
  SuitableBudget suitable;
  Message first;  // error of the first level that has too little
  for (std::size_t i = at; i < steps.size() && (i == at || steps[i].from_finest.value_or(0) > 0); ++i) {
    const std::unique_ptr<VolumeSource> source = open(steps[i]);
    const Box domain = source->info().domain();
    const std::uint64_t dense = float32_bytes(domain);
    const std::uint64_t asked = asked_bytes(options.budget, dense);
    const std::uint64_t smallest = smallest_tree(*source, options);
    suitable.add(dense, smallest, asked, domain);
    if (asked >= smallest || !first.empty()) continue;
    first = compose(outputs[i], ": ", asked, " bytes asked, the smallest tree for this level takes ", smallest,
                    "; nothing is converted; ask for ");
  }
  if (!first.empty()) throw Error(ErrorKind::budget, compose(first, suitable.text(options)));
}

}  // namespace weir
