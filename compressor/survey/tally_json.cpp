#include "compressor/survey/tally_json.h"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "compressor/survey/json_bits.h"

namespace weir {

using Json = nlohmann::json;

Json tally_json(const SurveyTally& t) {
  return {
      {"min", bits(t.min)},
      {"max", bits(t.max)},
      {"finite", t.finite},
      {"missing", t.missing},
      {"non_finite", t.non_finite},
      {"first_non_finite", t.first_non_finite},
      {"first_non_finite_value", bits(t.first_non_finite_value)},
      {"first_missing", t.first_missing},
      {"histogram",
       {{"exponent", t.histogram.exponent()}, {"base", bits(t.histogram.base())}, {"counts", t.histogram.counts()}}},
      {"value_counts", t.value_counts},
      {"loss",
       {{"inexact", t.loss.inexact},
        {"overflow", t.loss.overflow},
        {"max_abs_error", bits(t.loss.max_abs_error)},
        {"unmarked", t.loss.unmarked}}},
      {"sums", {{"rows", t.sums.rows}, {"faces", t.sums.faces}, {"ladders", t.sums.ladders}}}};
}

SurveyTally tally_of(const Json& json) {
  SurveyTally t;
  t.min = float_of(json.at("min"));
  t.max = float_of(json.at("max"));
  json.at("finite").get_to(t.finite);
  json.at("missing").get_to(t.missing);
  json.at("non_finite").get_to(t.non_finite);
  json.at("first_non_finite").get_to(t.first_non_finite);
  t.first_non_finite_value = float_of(json.at("first_non_finite_value"));
  json.at("first_missing").get_to(t.first_missing);
  const Json& histogram = json.at("histogram");
  const auto counts = histogram.at("counts").get<std::vector<std::uint64_t>>();
  if (counts.size() > RangeHistogram::kMaxBins) throw std::out_of_range("histogram");
  t.histogram = RangeHistogram::restored(histogram.at("exponent").get<int>(), double_of(histogram.at("base")), counts);
  json.at("value_counts").get_to(t.value_counts);
  const Json& loss = json.at("loss");
  loss.at("inexact").get_to(t.loss.inexact);
  loss.at("overflow").get_to(t.loss.overflow);
  t.loss.max_abs_error = double_of(loss.at("max_abs_error"));
  loss.at("unmarked").get_to(t.loss.unmarked);
  const Json& sums = json.at("sums");
  t.sums = {sums.at("rows").get<std::uint64_t>(), sums.at("faces").get<std::uint64_t>(),
            sums.at("ladders").get<std::array<std::uint64_t, 3>>()};
  return t;
}

std::string tally_text(const SurveyTally& tally) { return tally_json(tally).dump(); }

SurveyTally parse_tally(std::string_view text) { return tally_of(Json::parse(text)); }

}  // namespace weir
