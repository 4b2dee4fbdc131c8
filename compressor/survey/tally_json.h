// What a survey has counted so far, as JSON, for a checkpoint and for other processes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "compressor/survey/survey_tally.h"

namespace weir {

/// Nothing is lost on the way there and back. tally_of throws std::exception where that is none.
nlohmann::json tally_json(const SurveyTally& tally);
SurveyTally tally_of(const nlohmann::json& json);

/// The same as text.
std::string tally_text(const SurveyTally& tally);
SurveyTally parse_tally(std::string_view text);

}  // namespace weir
