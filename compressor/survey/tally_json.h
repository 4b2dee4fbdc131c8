// Converts a survey's tally to JSON and back, for a checkpoint and for other processes.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

#include "compressor/survey/survey_tally.h"

namespace weir {

/// Convert without loss in both directions. tally_of() throws std::exception if `json` is no tally.
nlohmann::json tally_json(const SurveyTally& tally);
SurveyTally tally_of(const nlohmann::json& json);

/// The same conversions with text. parse_tally() throws as tally_of().
std::string tally_text(const SurveyTally& tally);
SurveyTally parse_tally(std::string_view text);

}  // namespace weir
