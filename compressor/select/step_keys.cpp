#include "compressor/select/step_keys.h"

#include <algorithm>

namespace weir {
namespace {

bool goes_before(const LeafPurchase& a, const LeafPurchase& b) {
  const double of_a = a.leaf->steps[a.step].key;
  const double of_b = b.leaf->steps[b.step].key;
  if (of_a != of_b) return of_a > of_b;
  if (a.leaf->brick != b.leaf->brick) return a.leaf->brick < b.leaf->brick;
  return a.leaf == b.leaf && a.step < b.step;
}

}  // namespace

double step_key(const LeafGain& leaf, std::uint32_t i, double region_key) {
  if (leaf.required && i == 0) return kRequiredKey;
  return std::max(kLastKey, std::min(leaf.steps[i].key, region_key));
}

std::vector<LeafPurchase> tied_steps(const RegionGains& gains, double region_key, double threshold) {
  std::vector<LeafPurchase> ties;
  for (const LeafGain& leaf : gains) {
    for (std::uint32_t i = 0; i < leaf.step_count; ++i) {
      if (step_key(leaf, i, region_key) == threshold) ties.push_back({&leaf, i});
    }
  }
  std::stable_sort(ties.begin(), ties.end(), goes_before);
  return ties;
}

}  // namespace weir
