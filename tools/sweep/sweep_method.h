// The methods a sweep compares: the conversion's own, and ZFP.
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
  std::map<std::string, std::string> options;  ///< of `weir convert`, long names; none for ZFP

  bool is_zfp() const { return name == "zfp"; }
};

/// "auto, fpn, ..., zfp": every name.
std::string sweep_method_names();

/// Of names between commas. Throws Error(usage) naming --methods and the name that is none, or is there twice.
std::vector<SweepMethod> parse_sweep_methods(std::string_view text);

/// What `weir convert` makes of the method's options and the nonfinite of `given`. Throws Error(usage) for a policy
/// that is none.
ConversionOptions conversion_of(const SweepMethod& method, const GivenOptions& given);

/// Of numbers between commas. Throws Error(usage) naming --rates and what is no rate, or is there twice.
std::vector<double> parse_rates(std::string_view text);

}  // namespace weir
