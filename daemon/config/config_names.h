// The words of the configuration file for each setting with a fixed set of values.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "daemon/config/config.h"

namespace weir {

template <typename T, std::size_t N>
using Choices = std::array<std::pair<std::string_view, T>, N>;

inline constexpr Choices<Completion, 6> kCompletions{{{"auto", Completion::automatic},
                                                      {"close", Completion::close},
                                                      {"rename", Completion::rename},
                                                      {"marker", Completion::marker},
                                                      {"size", Completion::size},
                                                      {"stable", Completion::stable}}};
inline constexpr Choices<WatchMethod, 3> kWatchMethods{
    {{"auto", WatchMethod::automatic}, {"inotify", WatchMethod::inotify}, {"poll", WatchMethod::poll}}};
inline constexpr Choices<Priority, 2> kPriorities{{{"newest", Priority::newest}, {"oldest", Priority::oldest}}};
inline constexpr Choices<AfterDone, 2> kAfterDone{
    {{"keep", AfterDone::keep}, {"delete-after-verify", AfterDone::delete_after_verify}}};
inline constexpr Choices<Follow, 2> kFollow{{{"inside", Follow::inside}, {"anywhere", Follow::anywhere}}};
inline constexpr Choices<IoClass, 3> kIoClasses{
    {{"none", IoClass::none}, {"best-effort", IoClass::best_effort}, {"idle", IoClass::idle}}};
inline constexpr Choices<std::string_view, 6> kLogLevels{
    {{"trace", "trace"}, {"debug", "debug"}, {"info", "info"}, {"warn", "warn"}, {"error", "error"}, {"off", "off"}}};

template <typename T, std::size_t N>
std::string_view name_of(const Choices<T, N>& choices, T value) {
  for (const auto& [name, choice] : choices) {
    if (choice == value) return name;
  }
  return {};
}

std::string_view completion_name(Completion completion);  ///< "auto", "close", ...
std::string_view watch_method_name(WatchMethod method);   ///< "auto", "inotify", "poll"
std::string_view priority_name(Priority priority);        ///< "newest", "oldest"
std::string_view after_done_name(AfterDone source);       ///< "keep", "delete-after-verify"
std::string_view io_class_name(IoClass io_class);         ///< "none", "best-effort", "idle"

}  // namespace weir
