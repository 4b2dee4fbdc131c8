// The methods that a sweep compares: those of `weir convert`, and ZFP.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "compressor/conversion_options.h"
#include "format/base/option_row.h"

namespace weir {

struct SweepMethod {
  std::string name;
  std::map<std::string, std::string> options;  ///< options of `weir convert` by long name; empty for ZFP

  bool is_zfp() const { return name == "zfp"; }
};

/// Returns every method name: "auto, fpn, ..., zfp".
std::string sweep_method_names();

/// Parses method names between commas. Throws Error(usage), naming --methods and the name, for an unknown or repeated
/// name.
std::vector<SweepMethod> parse_sweep_methods(std::string_view text);

/// Returns the conversion options that `weir convert` would read from the method's options and the nonfinite option of
/// `given`. Throws Error(usage) for an unknown policy.
ConversionOptions conversion_of(const SweepMethod& method, const GivenOptions& given);

/// Parses rates between commas. Throws Error(usage), naming --rates and the text, for a text that is no rate or is
/// repeated.
std::vector<double> parse_rates(std::string_view text);

}  // namespace weir
