// Writes floating-point numbers to JSON as their bits, because JSON has no infinity and some readers take -0.0 for 0.0.
#pragma once

#include <bit>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace weir {

inline nlohmann::json bits(float value) { return std::bit_cast<std::uint32_t>(value); }
inline nlohmann::json bits(double value) { return std::bit_cast<std::uint64_t>(value); }
inline float float_of(const nlohmann::json& json) { return std::bit_cast<float>(json.get<std::uint32_t>()); }
inline double double_of(const nlohmann::json& json) { return std::bit_cast<double>(json.get<std::uint64_t>()); }

}  // namespace weir
