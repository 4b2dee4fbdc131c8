#include "tools/spectrum/block_transform.h"

#include <fftw3.h>

#include <vector>

#include "format/base/error.h"

namespace weir {

class BlockTransform::Plan {
 public:
  // FFTW_ESTIMATE measures nothing, so the sums are the same in every run, and it does not touch the arrays.
  explicit Plan(const Index3& extent) {
    std::vector<double> values(static_cast<std::size_t>(volume(extent)));
    std::vector<std::complex<double>> result(static_cast<std::size_t>(volume(frequencies(extent))));
    plan_ = fftw_plan_dft_r2c_3d(static_cast<int>(extent.z), static_cast<int>(extent.y), static_cast<int>(extent.x),
                                 values.data(), fftw_array(result), FFTW_ESTIMATE | FFTW_UNALIGNED);
    if (plan_ == nullptr) throw Error(ErrorKind::internal, "FFTW has no plan for a block");
  }
  ~Plan() { fftw_destroy_plan(plan_); }
  Plan(const Plan&) = delete;
  Plan& operator=(const Plan&) = delete;

  void run(std::span<double> values, std::span<std::complex<double>> result) const {
    fftw_execute_dft_r2c(plan_, values.data(), fftw_array(result));
  }

 private:
  // std::complex<double> has the layout of an array of two doubles.
  static fftw_complex* fftw_array(std::span<std::complex<double>> numbers) {
    return reinterpret_cast<fftw_complex*>(numbers.data());
  }

  fftw_plan plan_ = nullptr;
};

BlockTransform::BlockTransform(const Index3& extent) : plan_(std::make_shared<const Plan>(extent)) {}

void BlockTransform::run(std::span<double> values, std::span<std::complex<double>> result) const {
  plan_->run(values, result);
}

bool has_fftw() { return true; }

}  // namespace weir
