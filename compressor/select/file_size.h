// Computes the size of a file from the budget.
#pragma once

#include <cstdint>
#include <string>

#include "compressor/select/budget.h"
#include "compressor/select/selection.h"
#include "format/base/message.h"

namespace weir {

/// "rate", "size", "psnr", "max_error", "lossless" or "minimum": the sidecar's budget.kind.
struct FileSize {
  std::uint64_t bytes = 0;
  std::string kind;
  Message notice;  ///< one line for the user where the size is not what was asked, or pads a lot; may be empty
};

/// Returns ceil(dense_bytes / rate), exact for the shortest decimal form of `rate`.
std::uint64_t bytes_at_rate(std::uint64_t dense_bytes, double rate);

/// Returns the bytes that a budget asks for: its size, or bytes_at_rate() of its rate.
std::uint64_t asked_bytes(const Budget& budget, std::uint64_t dense_float32_bytes);

/// Returns the exact file size for a budget that is not by error. Throws Error(budget) that names the minimum if the
/// budget is below it.
FileSize file_size_for(const Budget& budget, std::uint64_t dense_float32_bytes, const SelectionBytes& bytes,
                       const std::string& path);

}  // namespace weir
