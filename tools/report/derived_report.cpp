#include "tools/report/derived_report.h"

#include "format/base/text.h"
#include "tools/report/error_text.h"

namespace weir {
namespace {

// Returns whether no voxel is finite in both the source and the file.
bool compares_nothing(const DerivedErrors& errors) {
  return errors.octaves.zeros == 0 && errors.octaves.counts.empty();
}

const char* no_similarity_text(const DerivedErrors& errors) {
  if (compares_nothing(errors)) return "not defined: no value is finite";
  if (errors.similarity.left_out > 0) return "not defined: every window has a value that is not finite";
  return "not defined for one value";
}

std::string quantiles_text(const DerivedErrors& errors, double range, const std::string& units) {
  if (compares_nothing(errors)) return "|error|    not defined: no value is finite";
  std::string text;
  for (std::size_t i = 0; i < errors.quantiles.size(); ++i) {
    text += cat(i == 0 ? "|error|    " : "\n           ", 100 * DerivedErrors::kShares[i], " % of voxels at most ",
                largest_error_text(errors.quantiles[i], range, units));
  }
  return text;
}

}  // namespace

nlohmann::ordered_json derived_json(const DerivedErrors& errors) {
  using Json = nlohmann::ordered_json;
  Json quantiles;
  for (std::size_t i = 0; i < errors.quantiles.size(); ++i) {
    quantiles[cat(DerivedErrors::kShares[i])] = compares_nothing(errors) ? Json() : Json(errors.quantiles[i]);
  }
  const ErrorHistogram::Octaves& octaves = errors.octaves;
  const GradientError& gradient = errors.gradient;
  Json report;
  report["quantiles"] = quantiles;
  report["octaves"] = {{"zeros", octaves.zeros}, {"first", octaves.first}, {"counts", octaves.counts}};
  report["gradient"] = {{"rms", gradient.rms},
                        {"relative_rms", gradient.relative_rms ? Json(*gradient.relative_rms) : Json()},
                        {"max_abs", gradient.max_abs},
                        {"voxels", gradient.voxels},
                        {"left_out", gradient.left_out}};
  report["ssim"] = errors.similarity.mean ? Json(*errors.similarity.mean) : Json();
  report["ssim_windows"] = errors.similarity.windows;
  report["ssim_left_out"] = errors.similarity.left_out;
  return report;
}

std::string derived_text(const DerivedErrors& errors, double range, const std::string& units) {
  std::string text = quantiles_text(errors, range, units);
  text += cat("\ngradient   ", gradient_text(errors.gradient, units), "\nssim       ");
  const Similarity& s = errors.similarity;
  text += s.mean ? short_number(*s.mean) : no_similarity_text(errors);
  if (s.mean && s.left_out > 0) {
    text += cat("; ", s.left_out, " of ", s.windows + s.left_out,
                " windows left out, which have values that are not finite");
  }
  return text + '\n';
}

}  // namespace weir
