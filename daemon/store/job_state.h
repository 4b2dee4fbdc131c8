// The state of a job, and its names in the state file, the API and the metrics.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace weir {

enum class JobState {
  discovered,   ///< the source was seen and is not complete yet
  waiting,      ///< complete; converted when its turn comes
  running,      ///< being converted, verified or rendered
  done,         ///< its outputs are there and verified
  failed,       ///< every attempt failed; waits for a change of the source or for a retry
  quarantined,  ///< the source itself is bad; waits for it to change or for a retry
  cancelled     ///< by request; waits for a change of the source or for a retry
};

inline constexpr std::array kJobStateNames = {std::string_view("discovered"), std::string_view("waiting"),
                                              std::string_view("running"),    std::string_view("done"),
                                              std::string_view("failed"),     std::string_view("quarantined"),
                                              std::string_view("cancelled")};
inline constexpr std::size_t kJobStates = kJobStateNames.size();

inline constexpr std::string_view job_state_name(JobState state) {
  return kJobStateNames[static_cast<std::size_t>(state)];
}

/// Returns the state of this name; none if there is no such state.
inline constexpr std::optional<JobState> parse_job_state(std::string_view name) {
  for (std::size_t i = 0; i < kJobStates; ++i) {
    if (kJobStateNames[i] == name) return static_cast<JobState>(i);
  }
  return std::nullopt;
}

}  // namespace weir
