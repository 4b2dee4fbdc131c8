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
#include "compressor/select/file_size.h"
#include "format/base/scalar_type.h"
#include "format/base/text.h"
#include "format/sidecar/valid_voxels.h"

namespace weir {
namespace {

constexpr double kRounding = 1e-9;  ///< relative difference of figures that were computed in another order

bool is_near(double a, double b) {
  return a == b || std::fabs(a - b) <= kRounding * std::max(std::fabs(a), std::fabs(b));
}

std::string shown(const std::optional<double>& value) { return value ? cat(*value) : "none"; }
std::string shown(const Index3& extent) { return cat(extent.x, " x ", extent.y, " x ", extent.z); }

VolumeCheck at_most(const std::string& name, std::uint64_t found, std::uint64_t most) {
  return {name, cat(found), cat("at most ", most), found <= most};
}

// `name`: for example "sidecar error"; `range`: least and largest value.
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
  const bool no_ratio = !std::isfinite(error.nmse) && !std::isfinite(from_mse.nmse);  // the range is a single value
  checks.push_back({name + ".nmse", cat(error.nmse), cat(from_mse.nmse, ", (rmse / range)^2"),
                    no_ratio || is_near(error.nmse, from_mse.nmse)});
  const bool exact = error.mse == 0 && error.max_abs == 0;
  checks.push_back({name + ".lossless", error.lossless ? "true" : "false", exact ? "true or false" : "false",
                    exact || !error.lossless});
}

// Checks that max_abs is at most the width of the source's range, widened by a background outside it: decoded values
// keep to that range. Weir 0.1, which did not record what became of missing voxels, did not guarantee this.
void check_span(const std::string& name, const Sidecar::CertifiedError& error, const Sidecar& s,
                std::vector<VolumeCheck>& checks) {
  if (s.missing.policy.empty()) return;
  const auto [lo, hi] = s.value_range;
  const double reach = std::fmax(hi, s.background.value) - std::fmin(lo, s.background.value);
  const bool known = std::isfinite(error.max_abs) && std::isfinite(lo) && std::isfinite(hi);
  checks.push_back({name + ".max_abs in value_range", cat(error.max_abs),
                    cat("at most ", reach, ", what value_range and background span"),
                    !known || error.max_abs <= reach * (1 + kRounding)});
}

// Checks the gradient's figures. Non-finite figures are null in the sidecar and are not checked.
void check_gradient(const Sidecar::GradientError& gradient, std::uint64_t voxels, std::vector<VolumeCheck>& checks) {
  const std::string name = "sidecar error.gradient";
  checks.push_back({name + ".rms", cat(gradient.rms), cat("0 to ", gradient.max_abs, ", max_abs"),
                    !(gradient.rms < 0) && !(gradient.rms > gradient.max_abs * (1 + kRounding))});
  checks.push_back({name + ".max_abs", cat(gradient.max_abs), "0 or more", !(gradient.max_abs < 0)});
  const double relative = gradient.relative_rms.value_or(0);
  checks.push_back({name + ".relative_rms", shown(gradient.relative_rms), "0 or more", !(relative < 0)});
  const bool all = gradient.voxels <= voxels && gradient.left_out == voxels - gradient.voxels;
  checks.push_back(
      {name + ".voxels and left_out", cat(gradient.voxels, " and ", gradient.left_out), cat(voxels, " together"), all});
}

std::uint64_t leaves_of(const Box& box) {
  if (box.empty()) return 0;
  const Index3 count = make_lattice(box, kLeafDim).count;
  return static_cast<std::uint64_t>(count.x) * static_cast<std::uint64_t>(count.y) *
         static_cast<std::uint64_t>(count.z);
}

// Checks the histogram: the first bin holds the least value, the last bin the largest.
void check_histogram(const Sidecar& s, std::vector<VolumeCheck>& checks) {
  const auto& [min, max, counts] = s.histogram;
  const std::uint64_t counted = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  checks.push_back({"sidecar histogram.counts", cat(counted, " in all"), cat(valid_voxels(s), ", the valid voxels"),
                    counted == valid_voxels(s)});
  if (counts.empty()) return;
  const auto [lo, hi] = s.value_range;
  const double bin = (max - min) / static_cast<double>(counts.size()) * (1 + kRounding);
  const bool holds = min <= lo && lo <= min + bin && max - bin <= hi && hi <= max;
  checks.push_back({"sidecar histogram.min and max", cat(min, " .. ", max),
                    cat("at most a bin beyond ", lo, " .. ", hi, ", value_range"), holds});
}

void check_digest(const std::string& name, const std::string& digest, std::vector<VolumeCheck>& checks) {
  const bool hex_digits = digest.find_first_not_of("0123456789abcdef") == std::string::npos;
  checks.push_back({name, digest, "32 lower-case hex digits", hex_digits && digest.size() == 32});
}

void check_digests(const Sidecar& s, std::vector<VolumeCheck>& checks) {
  check_digest("sidecar source.digest", s.source.digest, checks);
  if (!s.source.files_digest.empty()) check_digest("sidecar source.files_digest", s.source.files_digest, checks);
  if (s.visible && !s.visible->scene_digest.empty()) {
    check_digest("sidecar visible.scene_digest", s.visible->scene_digest, checks);
  }
}

// Checks that the error keeps the budget that was asked for; with a scene, the error of what the scene shows.
void check_budget(const Sidecar& s, std::uint64_t dense, std::vector<VolumeCheck>& checks) {
  const Sidecar::Budget& budget = s.budget;
  const Sidecar::CertifiedError& error = s.visible ? s.visible->error : s.error;
  const std::string asked = cat("sidecar budget.requested of kind ", budget.kind);
  if (budget.kind == "lossless" || budget.kind == "minimum") {
    checks.push_back({"sidecar budget.requested", shown(budget.requested), cat("none, of kind ", budget.kind),
                      !budget.requested.has_value()});
  }
  if (budget.kind == "lossless") {
    checks.push_back({asked, error.lossless ? "lossless" : "not lossless", "lossless", error.lossless});
    return;
  }
  const std::initializer_list<std::string_view> with_numbers{"psnr", "max_error", "size", "rate"};
  if (std::ranges::find(with_numbers, budget.kind) == with_numbers.end()) return;
  if (!budget.requested) {
    checks.push_back({asked, "none", "a number", false});
    return;
  }
  const double requested = *budget.requested;
  if (budget.kind == "psnr") {
    const bool met = !error.psnr_db || *error.psnr_db >= requested - kRounding * (1 + std::fabs(requested));
    checks.push_back({asked, cat(requested, " dB"), cat("at most ", shown(error.psnr_db), ", psnr_db"), met});
  } else if (budget.kind == "max_error") {
    checks.push_back(
        {asked, cat(requested), cat("at least ", error.max_abs, ", max_abs"), !(error.max_abs > requested)});
  } else if (requested > 0) {
    const bool by_size = budget.kind == "size";
    const double bytes = by_size ? requested : static_cast<double>(bytes_at_rate(dense, requested));
    const auto found = static_cast<double>(budget.file_bytes);
    const bool shorter = s.weir.options.contains("at-most");
    checks.push_back({asked, cat(bytes, " bytes"), cat(shorter ? "at least " : "", budget.file_bytes, ", file_bytes"),
                      shorter ? found <= bytes : found == bytes});
  }
}

void check_timing(const Sidecar::Timing& timing, std::vector<VolumeCheck>& checks) {
  const double least = std::min({timing.survey_s, timing.encode_s, timing.total_s});
  checks.push_back({"sidecar timing", cat(least, " s"), "0 s or more", !(least < 0)});
}

}  // namespace

std::vector<VolumeCheck> check_certificate(const Sidecar& s) {
  std::vector<VolumeCheck> checks;
  check_error("sidecar error", s.error, s.value_range, checks);
  check_span("sidecar error", s.error, s, checks);
  if (s.visible) {
    check_error("sidecar visible.error", s.visible->error, s.value_range, checks);
    check_span("sidecar visible.error", s.visible->error, s, checks);
  }
  if (s.error_preview) check_error("sidecar error_preview", *s.error_preview, s.value_range, checks);
  checks.push_back(
      {"sidecar source.extent", shown(s.source.extent), shown(s.grid.extent), s.source.extent == s.grid.extent});
  const auto voxels = static_cast<std::uint64_t>(volume(s.grid.extent));
  const std::uint64_t dense = voxels * sizeof(float);
  checks.push_back({"sidecar budget.dense_float32_bytes", cat(s.budget.dense_float32_bytes), cat(dense),
                    s.budget.dense_float32_bytes == dense});
  const double rate = static_cast<double>(dense) / static_cast<double>(std::max<std::uint64_t>(s.budget.file_bytes, 1));
  checks.push_back({"sidecar budget.rate", cat(s.budget.rate), cat(rate), is_near(s.budget.rate, rate)});
  const std::uint64_t leaves = leaves_of(s.grid.index_bbox);
  checks.push_back({"sidecar selection.leaves_total", cat(s.selection.leaves_total),
                    cat(leaves, ", the blocks of 8^3 that index_bbox touches"), s.selection.leaves_total == leaves});
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
  one_of("source.type", s.source.type, {type ? scalar_name(*type) : "none"});  // aliases are not accepted
  one_of("budget.kind", s.budget.kind, {"size", "rate", "psnr", "max_error", "lossless", "minimum"});
  check_budget(s, dense, checks);
  one_of("selection.metric", s.selection.metric, {"sse", "farthest", "closest", "median"});
  one_of("selection.fill", s.selection.fill, {"mean", "background"});
  one_of("selection.brick", cat(s.selection.brick), {"8", "16", "32"});
  one_of("nonfinite.policy", s.nonfinite.policy, {"error", "background", "keep"});
  if (!s.missing.policy.empty()) one_of("missing.policy", s.missing.policy, {"error", "background", "nan", "keep"});
  checks.push_back({"sidecar background.share", cat(s.background.share), "0 to 1",
                    s.background.share >= 0 && s.background.share <= 1});
  checks.push_back(at_most("sidecar conversion_loss.inexact", s.conversion_loss.inexact, voxels));
  checks.push_back(at_most("sidecar conversion_loss.overflow", s.conversion_loss.overflow, voxels));
  const double rounded = s.conversion_loss.max_abs_error;
  checks.push_back({"sidecar conversion_loss.max_abs_error", cat(rounded), "0 or more", !(rounded < 0)});
  if (s.visible) checks.push_back(at_most("sidecar visible.voxels", s.visible->voxels, voxels));
  // Weir 0.1 did not record what became of missing voxels, so it is not known which voxels were counted.
  if (!s.missing.policy.empty()) check_histogram(s, checks);
  if (s.gradient) check_gradient(*s.gradient, voxels, checks);
  check_digests(s, checks);
  check_timing(s.timing, checks);
  return checks;
}

}  // namespace weir
