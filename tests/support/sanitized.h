// Whether this build counts a sanitizer's memory as its own: no test of a memory ceiling can hold then.
#pragma once

namespace weir {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

inline constexpr const char* kSanitizedSkip = "a sanitizer's own memory counts as the process's";

}  // namespace weir
