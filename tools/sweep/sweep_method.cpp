#include "tools/sweep/sweep_method.h"

#include <algorithm>
#include <array>

#include "compressor/options/conversion_request.h"
#include "format/base/error.h"
#include "format/base/text.h"
#include "tools/sweep/zfp_codec.h"

namespace weir {
namespace {

constexpr std::array kNames{"auto", "packed", "fpn", "float", "fp4", "fp8", "fp16", "paper", "paper32", "zfp"};

std::map<std::string, std::string> options_of(const std::string& name) {
  if (name == "zfp") return {};
  if (name == "paper") return {{"preset", "paper"}};
  if (name == "paper32") return {{"preset", "paper"}, {"brick", "32"}};
  return {{"encoding", name}};
}

}  // namespace

std::string sweep_method_names() {
  std::string text;
  for (const char* name : kNames) text += cat(text.empty() ? "" : ", ", name);
  return text;
}

std::vector<SweepMethod> parse_sweep_methods(std::string_view text) {
  std::vector<SweepMethod> methods;
  for (const std::string& name : split(text, ',')) {
    if (std::find(kNames.begin(), kNames.end(), name) == kNames.end()) {
      throw usage_error(cat("--methods names \"", name, "\", choose from ", sweep_method_names()));
    }
    if (std::any_of(methods.begin(), methods.end(), [&](const SweepMethod& m) { return m.name == name; })) {
      throw usage_error(cat("--methods names ", name, " twice; leave one of them out"));
    }
    if (name == "zfp" && !has_zfp()) {
      throw usage_error("--methods names zfp, and this weir was built without it; build it with -DWEIR_ZFP=ON");
    }
    methods.push_back({name, options_of(name)});
  }
  return methods;
}

ConversionOptions conversion_of(const SweepMethod& method, const GivenOptions& given) {
  GivenOptions options(method.options.begin(), method.options.end());
  for (const char* const key : {"nonfinite", "missing-policy"}) {
    if (const auto policy = given.find(key); policy != given.end()) options.insert(*policy);
  }
  return read_conversion_request(options).conversion;
}

std::vector<double> parse_rates(std::string_view text) {
  std::vector<double> rates;
  for (const std::string& part : split(text, ',')) {
    const auto rate = parse_double(part);
    if (!rate || !(*rate >= kLeastRate && *rate <= kMostRate)) {
      throw usage_error(cat("--rates holds \"", part,
                            "\", it must be positive numbers such as 20,10,8: dense float32 bytes ", "/ file bytes"));
    }
    // Compared as text, because the text is part of the names of kept files.
    if (std::any_of(rates.begin(), rates.end(), [&](double other) { return cat(other) == cat(*rate); })) {
      throw usage_error(cat("--rates holds ", part, " twice; leave one of them out"));
    }
    rates.push_back(*rate);
  }
  return rates;
}

}  // namespace weir
