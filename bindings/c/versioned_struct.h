// Reads and writes structs of a program that was compiled with an older or a newer version of them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>

#include "bindings/c/status.h"
#include "bindings/c/weir.h"
#include "format/base/text.h"

namespace weir::c {

/// The largest struct_size; a larger one is not a struct of any version, but memory that was never set up.
inline constexpr std::size_t kMaxStructBytes = 4096;

/// Bytes of the struct in the first version of the library. A struct that has grown gets a number of its own here.
template <typename T>
inline constexpr std::size_t kFirstBytes = sizeof(T);

template <>
inline constexpr std::size_t kFirstBytes<weir_convert_options> = offsetof(weir_convert_options, preview);

template <>
inline constexpr std::size_t kFirstBytes<weir_input_options> = offsetof(weir_input_options, component);

/// Sets all to zero except struct_size.
template <typename T>
weir_status init_struct(T* target, std::size_t bytes) noexcept {
  if (target == nullptr || bytes < kFirstBytes<T> || bytes > kMaxStructBytes) return WEIR_ERROR_USAGE;
  std::memset(static_cast<void*>(target), 0, bytes);
  target->struct_size = bytes;
  return WEIR_OK;
}

/// Returns *given in this library's form; members that an older header lacks become 0. `name` is for messages. Throws
/// Error(usage) if `given` is null, was not set up, or sets members of a newer header that this library does not know.
template <typename T>
T read_struct(const T* given, const char* name) {
  const std::size_t bytes = required(given, name)->struct_size;
  if (bytes < kFirstBytes<T> || bytes > kMaxStructBytes) {
    throw usage(cat(name, ": struct_size is ", bytes, ", and must be at least ", kFirstBytes<T>, "; set it up with ",
                    name, "_init"));
  }
  const auto* const begin = reinterpret_cast<const unsigned char*>(given);
  if (std::any_of(begin + std::min(bytes, sizeof(T)), begin + bytes, [](unsigned char b) { return b != 0; })) {
    throw usage(cat(name, ": sets members that are newer than this library, " WEIR_VERSION "; leave them 0"));
  }
  T known{};
  std::memcpy(&known, given, std::min(bytes, sizeof known));
  return known;
}

/// Writes the members of `source` that the header of `target` has; read_struct() has accepted `target`.
template <typename T>
void write_struct(T source, T* target) {
  source.struct_size = target->struct_size;
  std::memcpy(target, &source, std::min(source.struct_size, sizeof source));
}

}  // namespace weir::c
