// The error certificate: the error of decoded values against the float32 source over all finite source voxels, in
// double.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

namespace weir {

struct Certificate {
  double mse = 0;
  double rmse = 0;
  double nmse = 0;                ///< mse / range^2; infinite if a volume of one value lost something
  std::optional<double> psnr_db;  ///< 10 log10(range^2 / mse); unset if lossless or if the range is 0
  double max_abs = 0;
  bool lossless = false;  ///< every voxel decodes bit for bit, NaN included if it is kept
};

/// Returns the certificate of a volume with values in [min, max]. `squared_error` is the sum over its `finite` voxels.
Certificate make_certificate(double squared_error, double max_abs, bool lossless, std::uint64_t finite, float min,
                             float max);

/// Neumaier's compensated sum (1974). Its error does not grow with the number of terms.
class CompensatedSum {
 public:
  void add(double term) {
    const double next = sum_ + term;
    compensation_ += std::abs(sum_) >= std::abs(term) ? (sum_ - next) + term : (term - next) + sum_;
    sum_ = next;
  }
  double value() const { return sum_ + compensation_; }

 private:
  double sum_ = 0;
  double compensation_ = 0;
};

}  // namespace weir
