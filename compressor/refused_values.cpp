#include "compressor/refused_values.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "format/base/error.h"
#include "format/base/exact_text.h"
#include "format/base/share_text.h"
#include "format/base/text.h"

namespace weir {
namespace {

void refuse_non_finite(const Survey& survey, const SourceInfo& info) {
  if (survey.non_finite == 0) return;
  const Index3& at = survey.first_non_finite;
  const std::uint64_t beyond = std::min(survey.loss.overflow, survey.non_finite);
  const std::uint64_t others = survey.non_finite - beyond;
  std::string what;
  if (others > 0) what = cat(others, others == 1 ? " voxel is" : " voxels are", " NaN or infinite");
  if (beyond > 0) {
    what = cat(what, others > 0 ? " and " : "", beyond, beyond == 1 ? " voxel is" : " voxels are",
               " finite but beyond the 3.4e+38 of float32");
  }
  throw Error(ErrorKind::input, compose(info.path, ": ", what, ", the first (", survey.first_non_finite_value,
                                        beyond > 0 ? " as float32" : "", ") at ", at.x, ",", at.y, ",", at.z,
                                        beyond > 0 ? "; scale the values, or choose" : "; choose", " ",
                                        option("nonfinite", "background"), " or ", option("nonfinite", "keep")));
}

// Returns `value` as text in the precision of `type`: the float32 nearest to 1e20 is 1e+20.
std::string stored_text(const StoredValue& value, ScalarType type) {
  const bool is_float = std::holds_alternative<double>(value) && type != ScalarType::float64;
  if (!is_float) return stored_value_text(value);
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), static_cast<float>(as_double(value))).ptr;
  return {text.data(), end};
}

}  // namespace

void refuse_missing(const Survey& survey, const SourceInfo& info) {
  if (survey.missing == 0) return;
  const std::string dataset = info.dataset.empty() ? "" : cat(", dataset ", info.dataset);
  std::vector<std::string> texts;
  for (const StoredValue& value : info.mapping.missing) texts.push_back(stored_text(value, info.type));
  std::sort(texts.begin(), texts.end());
  texts.erase(std::unique(texts.begin(), texts.end()), texts.end());
  std::string values;
  for (const std::string& text : texts) values += cat(values.empty() ? "" : " or ", text);
  const Index3& at = survey.first_missing;
  throw Error(ErrorKind::input,
              compose(info.path, dataset, ": ", survey.missing, " of ", survey.voxels(), " voxels (",
                      share_text(survey.missing, survey.voxels()), survey.missing == 1 ? ") holds" : ") hold",
                      " no data (stored as ", values, "), the first at ", at.x, ",", at.y, ",", at.z, "; choose ",
                      option("missing-policy", "background"), " or, to take ", values, " for data, ",
                      option("missing-policy", "keep")));
}

namespace {

// What float32 lost is in no error that a file is made by.
void refuse_rounding(const Budget& budget, const Survey& survey, const SourceInfo& info) {
  const double rounded = survey.loss.max_abs_error;
  if (budget.kind != Budget::Kind::max_error || rounded <= budget.target) return;
  throw Error(ErrorKind::budget, compose(info.path, ": float32, which files hold, rounds ", survey.loss.inexact,
                                         survey.loss.inexact == 1 ? " value" : " values", " by up to ", rounded,
                                         ", more than ", option("max-error", budget.target), " allows; allow ",
                                         option("max-error", exact_text(rounded)),  // with fewer digits it may be less
                                         " or more, or subtract an offset from the values first"));
}

}  // namespace

void refuse_values(const ConversionOptions& options, const Survey& survey, const SourceInfo& info) {
  if (options.non_finite == NonFinitePolicy::error) refuse_non_finite(survey, info);
  if (missing_policy_name(options) == "error") refuse_missing(survey, info);
  refuse_rounding(options.budget, survey, info);
}

}  // namespace weir
