// Maps values to positions along an axis of a chart.
#pragma once

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace weir {

/// An axis from the first tick, at pixel `first`, to the last tick, at pixel `last`.
class PlotScale {
 public:
  PlotScale(std::vector<double> ticks, bool logarithmic, std::int32_t first, std::int32_t last)
      : ticks_(std::move(ticks)), logarithmic_(logarithmic), first_(first), last_(last) {}

  const std::vector<double>& ticks() const { return ticks_; }
  double at(double value) const {
    const double part = (map(value) - map(ticks_.front())) / (map(ticks_.back()) - map(ticks_.front()));
    return first_ + part * (last_ - first_);
  }
  std::int32_t pixel(double value) const { return static_cast<std::int32_t>(std::lround(at(value))); }

 private:
  double map(double value) const { return logarithmic_ ? std::log10(value) : value; }

  std::vector<double> ticks_;
  bool logarithmic_;
  std::int32_t first_;
  std::int32_t last_;
};

}  // namespace weir
