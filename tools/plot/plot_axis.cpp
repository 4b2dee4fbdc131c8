#include "tools/plot/plot_axis.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace weir {
namespace {

constexpr int kMostEvenSteps = 8;
constexpr std::size_t kMostDecadeTicks = 10;

// Ticks are written with an exponent from kLargestPlain on, and if they would need more than kMostDecimals decimals.
constexpr double kLargestPlain = 1e6;
constexpr int kMostDecimals = 4;

// The share of a step by which rounding may have moved a tick.
constexpr double kTickRounding = 1e-9;

// Returns the double nearest to factor * 10^decade. Negative powers of ten have no exact binary form, so they are
// divided by.
double scaled(double factor, int decade) {
  return decade >= 0 ? factor * std::pow(10.0, decade) : factor / std::pow(10.0, -decade);
}

// Returns the n-th number of 1, 2, 5, 10, 20, 50, ...; n may be negative.
double one_two_five(int n) {
  constexpr std::array kFactors{1.0, 2.0, 5.0};
  const int decade = n >= 0 ? n / 3 : -((2 - n) / 3);
  return scaled(kFactors[static_cast<std::size_t>(n - 3 * decade)], decade);
}

std::vector<double> ticks_of(double lo, double hi, int stride) {
  int n = 3 * static_cast<int>(std::floor(std::log10(lo)));
  while (one_two_five(n) > lo) n -= stride;
  while (one_two_five(n + stride) <= lo) n += stride;
  std::vector<double> ticks{one_two_five(n)};
  while (ticks.back() < hi || ticks.size() < 2) ticks.push_back(one_two_five(n += stride));
  return ticks;
}

}  // namespace

double tick_step(double range, int most) {
  const double power = std::pow(10.0, std::floor(std::log10(range / most)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (range / (factor * power) <= most) return factor * power;
  }
  return 10 * power;
}

std::vector<double> even_ticks(double lo, double hi) {
  const double range = hi > lo ? hi - lo : std::max(std::abs(lo), 1.0);
  const double step = tick_step(range, kMostEvenSteps);
  const double first = std::floor(lo / step + kTickRounding);
  const double last = std::max(std::ceil(hi / step - kTickRounding), first + 1);
  std::vector<double> ticks;
  for (double i = first; i <= last; ++i) ticks.push_back(i * step);
  return ticks;
}

std::vector<double> decade_ticks(double lo, double hi) {
  std::vector<double> ticks = ticks_of(lo, hi, 1);
  return ticks.size() <= kMostDecadeTicks ? ticks : ticks_of(lo, hi, 3);
}

std::vector<double> minor_decade_ticks(double lo, double hi) {
  std::vector<double> ticks;
  for (int decade = static_cast<int>(std::floor(std::log10(lo))); scaled(1, decade) <= hi; ++decade) {
    for (int factor = 1; factor <= 9; ++factor) {
      const double tick = scaled(factor, decade);
      if (tick >= lo && tick <= hi) ticks.push_back(tick);
    }
  }
  return ticks;
}

std::string tick_text(double tick, double step) {
  if (!(std::abs(tick) > kTickRounding * step)) return "0";
  const int last = step > 0 ? static_cast<int>(std::floor(std::log10(step) + kTickRounding)) : 0;  // decimal place
  const int first = static_cast<int>(std::floor(std::log10(std::abs(tick)) + kTickRounding));
  const bool plain = std::abs(tick) < kLargestPlain && -last <= kMostDecimals;
  std::array<char, 400> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), tick,
                                          plain ? std::chars_format::fixed : std::chars_format::scientific,
                                          plain ? std::max(-last, 0) : std::max(first - last, 0));
  return {text.data(), end};
}

}  // namespace weir
