// The error certificate: what a reader decodes against the float32 source, over
// all finite source voxels, in double.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

namespace weir {

struct Certificate {
  double mse = 0;
  double rmse = 0;
  double nmse = 0;                ///< mse / range^2; infinite where something was lost of a volume of one value
  std::optional<double> psnr_db;  ///< 10 log10(range^2 / mse); none when lossless or without a range
  double max_abs = 0;
  bool lossless = false;  ///< every voxel, NaN too where kept, reads bit for bit
};

/// `squared_error` summed over `finite` voxels of a volume with values in [min, max].
Certificate make_certificate(double squared_error, double max_abs, bool lossless, std::uint64_t finite, float min,
                             float max);

/// Neumaier's compensated sum (1974): the error does not grow with the number of terms.
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
