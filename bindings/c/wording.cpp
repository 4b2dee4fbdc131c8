#include "bindings/c/wording.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "format/base/ascii.h"

namespace weir::c {
namespace {

constexpr std::array<std::string_view, 5> kBudgets{"rate", "size", "psnr", "max-error", "lossless"};
/// Options with values that weir.h names WEIR_KEY_VALUE.
constexpr std::array<std::string_view, 12> kChoices{"encoding",  "preview",        "metric",  "fill",
                                                    "nonfinite", "missing-policy", "certify", "levels",
                                                    "upsample",  "missing-chunks", "endian",  "backend"};

bool holds(const auto& keys, const std::string& key) { return std::find(keys.begin(), keys.end(), key) != keys.end(); }

std::string enumerator_of(std::string_view name) { return upper_case(key_wording({std::string(name), {}})); }

std::string member_of(const std::string& key) {
  if (key == "dims") return "extent";
  if (key == "roi") return "roi_min to roi_max";
  return key_wording({key, {}});
}

}  // namespace

std::string c_wording(const OptionName& option) {
  if (holds(kChoices, option.key) && !option.value.empty()) {
    return cat("WEIR_", enumerator_of(option.key), "_", enumerator_of(option.value));
  }
  if (holds(kBudgets, option.key)) {
    const std::string kind = "WEIR_BUDGET_" + enumerator_of(option.key);
    if (option.key == "lossless") return kind;
    return cat(option.key == "size" ? "size" : "budget", " (", kind, ")", option.value.empty() ? "" : " ",
               option.value);
  }
  const std::string name = member_of(option.key);
  return option.value.empty() ? name : cat(name, " ", option.value);
}

}  // namespace weir::c
