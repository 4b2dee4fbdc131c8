// A spectrum for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "tools/spectrum/power_spectrum.h"

namespace weir {

/// {"block": [x, y, z], "blocks", "left_out", "wave_number": [...], "modes", "source", "decoded", "error"}: lists of
/// one length.
nlohmann::ordered_json spectrum_json(const PowerSpectrum& spectrum);

/// A line for each shell: wave_number, modes, source, decoded, error.
std::string spectrum_csv(const PowerSpectrum& spectrum);

/// One line: to which wavelength down the error is at most 1 % of the source's power; that is the longest one of the
/// first shell in which it is more.
std::string spectrum_text(const PowerSpectrum& spectrum);

}  // namespace weir
