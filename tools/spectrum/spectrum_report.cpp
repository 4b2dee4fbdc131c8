#include "tools/spectrum/spectrum_report.h"

#include <algorithm>

#include "format/base/text.h"

namespace weir {
namespace {

constexpr double kSmallShare = 0.01;
// A share of the largest power in a shell. Smaller powers are rounding of float32 and hold no signal that could be
// lost.
constexpr double kPowerRounding = 1e-12;

std::string blocks_text(const PowerSpectrum& spectrum) {
  std::string text = cat(spectrum.blocks, spectrum.blocks == 1 ? " block" : " blocks", " of ", spectrum.block.x, " x ",
                         spectrum.block.y, " x ", spectrum.block.z, " voxels");
  if (spectrum.left_out > 0) text += cat(", ", spectrum.left_out, " more with values that are not finite left out");
  return text;
}

}  // namespace

nlohmann::ordered_json spectrum_json(const PowerSpectrum& spectrum) {
  using Json = nlohmann::ordered_json;
  Json report{{"block", {spectrum.block.x, spectrum.block.y, spectrum.block.z}},
              {"blocks", spectrum.blocks},
              {"left_out", spectrum.left_out}};
  for (const char* key : {"wave_number", "modes", "source", "decoded", "error"}) report[key] = Json::array();
  for (const PowerSpectrum::Shell& shell : spectrum.shells) {
    report["wave_number"].push_back(shell.wave_number);
    report["modes"].push_back(shell.modes);
    report["source"].push_back(shell.source);
    report["decoded"].push_back(shell.decoded);
    report["error"].push_back(shell.error);
  }
  return report;
}

std::string spectrum_csv(const PowerSpectrum& spectrum) {
  std::string text = "wave_number,modes,source,decoded,error\n";
  for (const PowerSpectrum::Shell& shell : spectrum.shells) {
    text += cat(shell.wave_number, ',', shell.modes, ',', shell.source, ',', shell.decoded, ',', shell.error, '\n');
  }
  return text;
}

std::string spectrum_text(const PowerSpectrum& spectrum) {
  const auto& shells = spectrum.shells;
  const std::string blocks = blocks_text(spectrum);
  if (shells.empty()) return cat("spectrum   not defined: ", blocks, '\n');
  const auto by_power = [](const auto& a, const auto& b) { return a.source < b.source; };
  const double rounding = kPowerRounding * std::max_element(shells.begin(), shells.end(), by_power)->source;
  const auto large = std::find_if(shells.begin(), shells.end(), [&](const PowerSpectrum::Shell& shell) {
    return shell.error > kSmallShare * shell.source && (shell.source > rounding || shell.error > rounding);
  });
  if (large == shells.begin()) {
    return cat("spectrum   the error has more than 1 % of the source's power from the longest wavelength on, ",
               short_number(1 / large->lowest), " world units; ", blocks, '\n');
  }
  if (large == shells.end()) {
    return cat("spectrum   the error has at most 1 % of the source's power at every wavelength; ", blocks, '\n');
  }
  return cat("spectrum   the error has at most 1 % of the source's power at wavelengths above ",
             short_number(1 / large->lowest), " world units; ", blocks, '\n');
}

}  // namespace weir
