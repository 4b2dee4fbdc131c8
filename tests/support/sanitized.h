// Tells tests whether the build has a sanitizer. The sanitizer's memory counts as the process's own, so that no
// test of a memory ceiling can pass. It also reports memory that foreign libraries never free.
#pragma once

// GCC announces the sanitizer by a macro, clang by a feature.
#if defined(__has_feature)
#if __has_feature(address_sanitizer) && !defined(__SANITIZE_ADDRESS__)
#define __SANITIZE_ADDRESS__ 1
#endif
#if __has_feature(thread_sanitizer) && !defined(__SANITIZE_THREAD__)
#define __SANITIZE_THREAD__ 1
#endif
#endif

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/lsan_interface.h>
#endif

namespace weir {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

/// While an object lives, no allocation of its thread is reported as a leak.
#if defined(__SANITIZE_ADDRESS__)
using LeaksOfLibraries = __lsan::ScopedDisabler;
#else
struct LeaksOfLibraries {
  LeaksOfLibraries() {}  // NOLINT(modernize-use-equals-default): so that one is never an unused variable
};
#endif

inline constexpr const char* kSanitizedSkip = "a sanitizer's own memory counts as the process's";

}  // namespace weir
