#include "ingest/synthetic/random_values.h"

#include <bit>

#include "ingest/synthetic/hash.h"

namespace weir {
namespace {

/// value(hash) for each voxel, the hash a function of seed, stream and position.
template <typename Value>
std::unique_ptr<SyntheticField> make_random(const SyntheticOptions& options, Value value) {
  const std::uint64_t key = derive_key(options.seed, 2);
  const auto at = [key, value](std::int64_t x, std::int64_t y, std::int64_t z) {
    return value(hash_position(key, x, y, z));
  };
  return std::make_unique<VoxelField<decltype(at)>>(at);
}

}  // namespace

std::unique_ptr<SyntheticField> make_white_noise(const SyntheticOptions& options) {
  return make_random(options, [](std::uint64_t bits) { return unit_float(bits); });
}

std::unique_ptr<SyntheticField> make_signed_zeros(const SyntheticOptions& options) {
  return make_random(options, [](std::uint64_t bits) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(bits >> 32U) & 0x80000000U);
  });
}

std::unique_ptr<SyntheticField> make_denormals(const SyntheticOptions& options) {
  // Built from bits, because arithmetic on denormals is twenty times slower on some processors.
  return make_random(
      options, [](std::uint64_t bits) { return std::bit_cast<float>(static_cast<std::uint32_t>(bits >> 52U) + 1); });
}

std::unique_ptr<SyntheticField> make_big_integers(const SyntheticOptions& options) {
  return make_random(options, [](std::uint64_t bits) { return 0x1p24F + 2.0F * static_cast<float>(bits >> 44U); });
}

}  // namespace weir
