#include "tools/spectrum/spectrum_report.h"

#include <gtest/gtest.h>

namespace weir::spectrum_report_test {
namespace {

/// Returns shells of 1, 2 and 3 cycles in four world units, with power 1 and the given errors. The second and third
/// shell begin 0.05 below their wave number.
PowerSpectrum spectrum_of(const std::vector<double>& errors) {
  PowerSpectrum spectrum;
  spectrum.block = {64, 64, 32};
  spectrum.blocks = 7;
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const double number = 0.25 * static_cast<double>(i + 1);
    spectrum.shells.push_back({number, 6 * (i + 1), 1, 0.5, errors[i], i == 0 ? number : number - 0.05});
  }
  return spectrum;
}

TEST(SpectrumReport, SaysToWhichWavelengthTheErrorIsSmall) {
  const std::string blocks = "7 blocks of 64 x 64 x 32 voxels\n";
  EXPECT_EQ(
      spectrum_text(spectrum_of({0.001, 0.01, 0.02})),
      "spectrum   the error has at most 1 % of the source's power at wavelengths above 1.429 world units; " + blocks);
  EXPECT_EQ(spectrum_text(spectrum_of({0.001, 0.01, 0.01})),
            "spectrum   the error has at most 1 % of the source's power at every wavelength; " + blocks);
  EXPECT_EQ(
      spectrum_text(spectrum_of({0.02, 0, 0})),
      "spectrum   the error has more than 1 % of the source's power from the longest wavelength on, 4 world units; " +
          blocks);
  PowerSpectrum wave = spectrum_of({1e-20, 1e-9, 1e-20});
  wave.shells[0].source = wave.shells[2].source = 1e-21;
  EXPECT_EQ(spectrum_text(wave),
            "spectrum   the error has at most 1 % of the source's power at every wavelength; " + blocks)
      << "where the source has no more than rounding, there is nothing to lose";
  PowerSpectrum none = spectrum_of({});
  none.blocks = 0;
  none.left_out = 2;
  EXPECT_EQ(
      spectrum_text(none),
      "spectrum   not defined: 0 blocks of 64 x 64 x 32 voxels, 2 more with values that are not finite left out\n");
}

TEST(SpectrumReport, TableAndJsonHaveAllShells) {
  EXPECT_EQ(spectrum_csv(spectrum_of({0.125, 1e-9})),
            "wave_number,modes,source,decoded,error\n0.25,6,1,0.5,0.125\n0.5,12,1,0.5,1e-09\n");
  EXPECT_EQ(spectrum_json(spectrum_of({0.125, 1e-9})).dump(),
            R"({"block":[64,64,32],"blocks":7,"left_out":0,"wave_number":[0.25,0.5],"modes":[6,12],)"
            R"("source":[1.0,1.0],"decoded":[0.5,0.5],"error":[0.125,1e-09]})");
}

}  // namespace
}  // namespace weir::spectrum_report_test
