#include "tools/verify/certificate_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>

#include "compressor/leaf/certificate.h"
#include "format/base/scalar_type.h"
#include "format/base/text.h"
#include "format/sidecar/valid_voxels.h"

namespace weir {
namespace {

constexpr double kRounding = 1e-9;  ///< of figures that were computed in another order

bool is_near(double a, double b) {
  return a == b || std::fabs(a - b) <= kRounding * std::max(std::fabs(a), std::fabs(b));
}

std::string shown(const std::optional<double>& value) { return value ? cat(*value) : "none"; }
std::string shown(const Index3& extent) { return cat(extent.x, " x ", extent.y, " x ", extent.z); }

VolumeCheck at_most(const std::string& name, std::uint64_t found, std::uint64_t most) {
  return {name, cat(found), cat("at most ", most), found <= most};
}

// `name`: "sidecar error"; `range`: least and largest value.
void check_error(const std::string& name, const Sidecar::CertifiedError& error, const std::array<double, 2>& range,
                 std::vector<VolumeCheck>& checks) {
  const Certificate from_mse = make_certificate(error.mse, error.max_abs, error.lossless, 1,
                                                static_cast<float>(range[0]), static_cast<float>(range[1]));
  checks.push_back(
      {name + ".rmse", cat(error.rmse), cat(from_mse.rmse, ", the root of mse"), is_near(error.rmse, from_mse.rmse)});
  const bool bounded = error.rmse <= error.max_abs * (1 + kRounding) && (error.mse > 0 || !(error.max_abs > 0));
  checks.push_back({name + ".max_abs", cat(error.max_abs), cat("at least ", error.rmse, ", the rmse"),
                    bounded || !std::isfinite(error.max_abs)});
  const std::optional<double>& psnr_db = from_mse.psnr_db;
  const bool same = psnr_db && error.psnr_db
                        ? std::fabs(*psnr_db - *error.psnr_db) <= kRounding * (1 + std::fabs(*psnr_db))
                        : psnr_db.has_value() == error.psnr_db.has_value();
  checks.push_back(
      {name + ".psnr_db", shown(error.psnr_db), shown(psnr_db), same || !std::isfinite(range[1] - range[0])});
  const bool exact = error.mse == 0 && error.max_abs == 0;
  checks.push_back({name + ".lossless", error.lossless ? "true" : "false", exact ? "true or false" : "false",
                    exact || !error.lossless});
}

}  // namespace

std::vector<VolumeCheck> check_certificate(const Sidecar& s) {
  std::vector<VolumeCheck> checks;
  check_error("sidecar error", s.error, s.value_range, checks);
  if (s.visible) check_error("sidecar visible.error", s.visible->error, s.value_range, checks);
  if (s.packed) check_error("sidecar packed.error_preview", s.packed->error_preview, s.value_range, checks);
  checks.push_back(
      {"sidecar source.extent", shown(s.source.extent), shown(s.grid.extent), s.source.extent == s.grid.extent});
  const auto voxels = static_cast<std::uint64_t>(volume(s.grid.extent));
  const std::uint64_t dense = voxels * sizeof(float);
  checks.push_back({"sidecar budget.dense_float32_bytes", cat(s.budget.dense_float32_bytes), cat(dense),
                    s.budget.dense_float32_bytes == dense});
  const double rate = static_cast<double>(dense) / static_cast<double>(std::max<std::uint64_t>(s.budget.file_bytes, 1));
  checks.push_back({"sidecar budget.rate", cat(s.budget.rate), cat(rate), is_near(s.budget.rate, rate)});
  checks.push_back(
      at_most("sidecar selection.leaves_kept of leaves_total", s.selection.leaves_kept, s.selection.leaves_total));
  if (s.zeros) {
    checks.push_back(at_most("sidecar zeros.lost", s.zeros->lost, s.zeros->count));
    checks.push_back(at_most("sidecar zeros.count", s.zeros->count, voxels));
  }
  const auto one_of = [&](const char* name, const std::string& value, std::initializer_list<std::string_view> known) {
    const bool is_known = std::find(known.begin(), known.end(), value) != known.end();
    checks.push_back({cat("sidecar ", name), value, is_known ? value : "a name that weir writes", is_known});
  };
  const auto type = parse_scalar(s.source.type);
  one_of("source.type", s.source.type, {type ? scalar_name(*type) : "none"});  // by no alias
  one_of("nonfinite.policy", s.nonfinite.policy, {"error", "background", "keep"});
  if (!s.missing.policy.empty()) one_of("missing.policy", s.missing.policy, {"error", "background", "nan", "keep"});
  checks.push_back({"sidecar background.share", cat(s.background.share), "0 to 1",
                    s.background.share >= 0 && s.background.share <= 1});
  checks.push_back(at_most("sidecar conversion_loss.inexact", s.conversion_loss.inexact, voxels));
  checks.push_back(at_most("sidecar conversion_loss.overflow", s.conversion_loss.overflow, voxels));
  if (s.visible) checks.push_back(at_most("sidecar visible.voxels", s.visible->voxels, voxels));
  // Weir 0.1 did not say what became of missing voxels, and so which it counted.
  if (!s.histogram.counts.empty() && !s.missing.policy.empty()) {
    const std::uint64_t counted =
        std::accumulate(s.histogram.counts.begin(), s.histogram.counts.end(), std::uint64_t{0});
    checks.push_back({"sidecar histogram.counts", cat(counted, " in all"), cat(valid_voxels(s), ", the valid voxels"),
                      counted == valid_voxels(s)});
  }
  return checks;
}

}  // namespace weir
