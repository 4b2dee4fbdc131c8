// Reports a spectrum, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/spectrum/power_spectrum.h"

namespace weir {

/// Returns {"block": [x, y, z], "blocks", "left_out", "wave_number": [...], "modes", "source", "decoded", "error"};
/// all lists have one length.
nlohmann::ordered_json spectrum_json(const PowerSpectrum& spectrum);

/// Returns a line for each shell: wave_number, modes, source, decoded, error.
std::string spectrum_csv(const PowerSpectrum& spectrum);

/// Returns one line: down to which wavelength the error is at most 1 % of the source's power. That is the longest
/// wavelength of the first shell in which the error is larger.
std::string spectrum_text(const PowerSpectrum& spectrum);

}  // namespace weir
