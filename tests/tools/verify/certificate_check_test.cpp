#include "tools/verify/certificate_check.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <string>

#include "tests/tools/support/converted_volume.h"

namespace weir::certificate_check_test {
namespace {

using CertificateCheck = ConvertedVolume;

std::string failed_names(const Sidecar& sidecar) {
  std::string names;
  for (const VolumeCheck& check : check_certificate(sidecar)) {
    if (!check.ok) names += check.name + '\n';
  }
  return names;
}

// Returns a sidecar of a volume that is not lossless.
Sidecar with_error(Sidecar sidecar) {
  const double range = sidecar.value_range[1] - sidecar.value_range[0];
  sidecar.error = {0.25, 0.5, 0.25 / range / range, 20 * std::log10(range / 0.5), 3, false};
  return sidecar;
}

TEST_F(CertificateCheck, FiguresOfALosslessVolume_Agree) { EXPECT_EQ(failed_names(sidecar()), ""); }

TEST_F(CertificateCheck, FigureThatContradictsAnother_Fails) {
  const Sidecar good = with_error(sidecar());
  const auto failed = [&](const std::function<void(Sidecar&)>& change) {
    Sidecar changed = good;
    change(changed);
    return failed_names(changed);
  };
  EXPECT_EQ(failed([](Sidecar&) {}), "");
  EXPECT_EQ(failed([](Sidecar& s) { s.error.rmse *= 1.001; }), "sidecar error.rmse\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.error.max_abs = s.error.rmse / 2; }), "sidecar error.max_abs\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.error.psnr_db = 999; }), "sidecar error.psnr_db\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.error.psnr_db.reset(); }), "sidecar error.psnr_db\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.error.lossless = true; }), "sidecar error.lossless\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.error.mse = 0, s.error.max_abs = 0, s.error.psnr_db.reset(); }),
            "sidecar error.rmse\nsidecar error.max_abs\nsidecar error.nmse\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.error.nmse *= 1.001; }), "sidecar error.nmse\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.error.nmse = -s.error.nmse; }), "sidecar error.nmse\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.source.extent = {1, 2, 3}; }).substr(0, 21), "sidecar source.extent");
  EXPECT_EQ(failed([](Sidecar& s) { s.budget.rate = 99; }), "sidecar budget.rate\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.budget.dense_float32_bytes = 8; }), "sidecar budget.dense_float32_bytes\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.selection.leaves_total = 1; }),
            "sidecar selection.leaves_total\nsidecar selection.leaves_kept of leaves_total\n");
  EXPECT_EQ(failed([](Sidecar& s) { ++s.selection.leaves_total; }), "sidecar selection.leaves_total\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.zeros->lost = s.zeros->count + 1; }), "sidecar zeros.lost\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.source.type = "float32x"; }), "sidecar source.type\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.nonfinite.policy = "never"; }), "sidecar nonfinite.policy\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.background.share = 1.5; }), "sidecar background.share\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.conversion_loss.overflow = 1U << 30U; }), "sidecar conversion_loss.overflow\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.histogram.counts[0] += 5; }), "sidecar histogram.counts\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.histogram.counts[0] += 5, s.missing.policy = ""; }), "") << "as of weir 0.1";
  EXPECT_EQ(failed([](Sidecar& s) { s.histogram.max *= 2; }), "sidecar histogram.min and max\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.histogram.min = 1; }), "sidecar histogram.min and max\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.histogram.counts.clear(); }), "sidecar histogram.counts\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.source.digest = "0123"; }), "sidecar source.digest\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.source.files_digest = std::string(32, 'G'); }), "sidecar source.files_digest\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.timing.encode_s = -1; }), "sidecar timing\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.conversion_loss.max_abs_error = -1; }),
            "sidecar conversion_loss.max_abs_error\n");
  EXPECT_EQ(failed([](Sidecar& s) {
              s.visible = Sidecar::Visible{"a.toml", 1, 1U << 30U, s.error, ""};
            }),
            "sidecar visible.voxels\n");
}

TEST_F(CertificateCheck, ErrorLargerThanValuesAndBackgroundSpan_Fails) {
  Sidecar changed = with_error(sidecar());
  const auto [low, high] = changed.value_range;
  changed.error.max_abs = high - low;
  EXPECT_EQ(failed_names(changed), "");
  changed.error.max_abs = high - low + 1;
  EXPECT_EQ(failed_names(changed), "sidecar error.max_abs in value_range\n");
  changed.background.value = low - 1;
  EXPECT_EQ(failed_names(changed), "") << "what dropped blocks read";
  changed.background.value = high + 0.5;
  EXPECT_EQ(failed_names(changed), "sidecar error.max_abs in value_range\n");
  changed.missing.policy = "";
  EXPECT_EQ(failed_names(changed), "") << "as of weir 0.1";
  changed = with_error(sidecar());
  changed.visible = Sidecar::Visible{"a.toml", 1, 1, changed.error, ""};
  changed.visible->error.max_abs = high - low + 1;
  EXPECT_EQ(failed_names(changed), "sidecar visible.error.max_abs in value_range\n");
}

TEST_F(CertificateCheck, NameThatWeirDoesNotWrite_Fails) {
  const auto failed = [&](const std::function<void(Sidecar&)>& change) {
    Sidecar changed = sidecar();
    change(changed);
    return failed_names(changed);
  };
  EXPECT_EQ(failed([](Sidecar& s) { s.budget.kind = "bogus"; }), "sidecar budget.kind\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.selection.metric = "bogus"; }), "sidecar selection.metric\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.selection.fill = "bogus"; }), "sidecar selection.fill\n");
  EXPECT_EQ(failed([](Sidecar& s) { s.selection.brick = 12; }), "sidecar selection.brick\n");
}

TEST_F(CertificateCheck, BudgetThatTheFileDoesNotMeet_Fails) {
  const Sidecar good = with_error(sidecar());
  const auto failed = [&](const std::string& kind, std::optional<double> requested, bool at_most = false) {
    Sidecar changed = good;
    changed.budget.kind = kind;
    changed.budget.requested = requested;
    if (at_most) changed.weir.options["at-most"] = "true";
    return failed_names(changed);
  };
  const double psnr_db = *good.error.psnr_db;
  EXPECT_EQ(failed("psnr", psnr_db), "");
  EXPECT_EQ(failed("psnr", psnr_db + 0.001), "sidecar budget.requested of kind psnr\n");
  EXPECT_EQ(failed("psnr", std::nullopt), "sidecar budget.requested of kind psnr\n");
  EXPECT_EQ(failed("max_error", 3), "");
  EXPECT_EQ(failed("max_error", 2.999), "sidecar budget.requested of kind max_error\n");
  EXPECT_EQ(failed("lossless", std::nullopt), "sidecar budget.requested of kind lossless\n");
  EXPECT_EQ(failed("lossless", 60), "sidecar budget.requested\nsidecar budget.requested of kind lossless\n");
  EXPECT_EQ(failed("minimum", std::nullopt), "");
  EXPECT_EQ(failed("minimum", 8), "sidecar budget.requested\n");
  const auto bytes = static_cast<double>(good.budget.file_bytes);
  EXPECT_EQ(failed("size", bytes), "");
  EXPECT_EQ(failed("size", bytes + 1), "sidecar budget.requested of kind size\n");
  EXPECT_EQ(failed("size", bytes + 1, true), "") << "a shorter file was allowed";
  EXPECT_EQ(failed("size", bytes - 1, true), "sidecar budget.requested of kind size\n");
  EXPECT_EQ(failed("rate", 1e6), "sidecar budget.requested of kind rate\n");
}

// The budget of a scene is met by what the scene shows.
TEST_F(CertificateCheck, BudgetOfAScene_IsMetByWhatItShows) {
  Sidecar changed = with_error(sidecar());
  changed.visible = Sidecar::Visible{"a.toml", 1, 1, changed.error, ""};
  changed.visible->error.mse = changed.visible->error.rmse = changed.visible->error.nmse = 0;
  changed.visible->error.max_abs = 0;
  changed.visible->error.psnr_db.reset();
  changed.visible->error.lossless = true;
  changed.budget.kind = "lossless";
  changed.budget.requested.reset();
  EXPECT_EQ(failed_names(changed), "");
}

TEST_F(CertificateCheck, GradientThatCannotBe_Fails) {
  Sidecar good = with_error(sidecar());
  good.gradient = Sidecar::GradientError{0.5, 0.1, 2, 40 * 30 * 20 - 7, 7};
  const auto failed = [&](const std::function<void(Sidecar::GradientError&)>& change) {
    Sidecar changed = good;
    change(*changed.gradient);
    return failed_names(changed);
  };
  EXPECT_EQ(failed([](Sidecar::GradientError&) {}), "");
  EXPECT_EQ(failed([](Sidecar::GradientError& g) { g.relative_rms.reset(); }), "");
  EXPECT_EQ(failed([](Sidecar::GradientError& g) { g.max_abs = std::nan(""); }), "") << "not finite";
  EXPECT_EQ(failed([](Sidecar::GradientError& g) { g.rms = 2.5; }), "sidecar error.gradient.rms\n");
  EXPECT_EQ(failed([](Sidecar::GradientError& g) { g.rms = -0.5; }), "sidecar error.gradient.rms\n");
  EXPECT_EQ(failed([](Sidecar::GradientError& g) { g.relative_rms = -1; }), "sidecar error.gradient.relative_rms\n");
  EXPECT_EQ(failed([](Sidecar::GradientError& g) { g.left_out = 8; }), "sidecar error.gradient.voxels and left_out\n");
}

TEST_F(CertificateCheck, VolumeWithoutAFiniteValue_HasNoRange) {
  Sidecar changed = sidecar();
  for (const double none : {std::nan(""), 0.0}) {  // weir 0.2.0 wrote 0
    changed.value_range = {none, none};
    changed.nonfinite = {40 * 30 * 20, "keep"};
    changed.histogram = {};
    EXPECT_EQ(failed_names(changed), "");
  }
}

// A sidecar has null for a figure that is not finite; it is read as NaN.
TEST_F(CertificateCheck, ErrorThatIsNotFinite_ContradictsNothing) {
  Sidecar changed = with_error(sidecar());
  changed.error.max_abs = std::nan("");
  EXPECT_EQ(failed_names(changed), "");
}

}  // namespace
}  // namespace weir::certificate_check_test
