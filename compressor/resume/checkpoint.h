// The progress of a conversion. Together with the files that it names, a checkpoint suffices to continue the conversion
// and produce the same bytes.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "compressor/leaf/encoding.h"
#include "compressor/packed/ladder_state.h"
#include "compressor/resume/encoded_state.h"
#include "compressor/survey/background.h"
#include "compressor/survey/survey_tally.h"
#include "format/io/digest.h"

namespace weir {

/// Named entries that identify a conversion. Two conversions with the same entries produce the same bytes.
using ConversionIdentity = std::map<std::string, std::string>;

struct Checkpoint {
  /// An attempt at an error target: the request that the encode pass works on.
  struct Attempt {
    int number = 0;
    double planned_error = 0;  ///< FileRequest::planned_error
    Encoding encoding = Encoding::float32;
    std::string seen;                ///< visible_values of the scene of the attempt
    std::optional<double> met = {};  ///< the planned error of an earlier file that met the target
  };

  ConversionIdentity identity;
  std::string spill_directory;                 ///< absolute path; empty: beside the journal
  std::map<std::string, std::uint64_t> files;  ///< name and bytes of each file that the members below depend on
  SurveyState survey;
  LadderState ladders;                   ///< for a packed file
  std::optional<Background> background;  ///< set when it is found
  std::optional<Attempt> attempt;
  Digest plan;  ///< digest of the plan of the file that is being encoded (encode_attempts.h)
  EncodedState encoded;
};

/// Returns a line with version and digest, then JSON.
std::string to_text(const Checkpoint& checkpoint);

/// Returns nullopt if `text` is not a whole checkpoint of this version.
std::optional<Checkpoint> parse_checkpoint(std::string_view text);

}  // namespace weir
