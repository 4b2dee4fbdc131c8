#include "daemon/jobs/job_figures.h"

#include "format/base/error.h"

namespace weir {
namespace {

std::string error_kind(int exit_code) {
  switch (exit_code) {
    case static_cast<int>(ErrorKind::usage):
      return "usage";
    case static_cast<int>(ErrorKind::input):
      return "input";
    case static_cast<int>(ErrorKind::budget):
      return "budget";
    case static_cast<int>(ErrorKind::io):
      return "io";
    default:
      return exit_code > 128 ? "killed" : "internal";
  }
}

}  // namespace

void JobFigures::converted(const std::string& watch, std::uint64_t bytes, const JobResult& result) {
  totals_.seconds.observe(result.seconds);
  ++totals_.done;
  totals_.bytes_in += bytes;
  totals_.bytes_out += result.bytes_written;
  const auto now = std::chrono::steady_clock::now();
  last_minute_.add(bytes, now);
  for (const std::string& of : {std::string(), watch}) {
    converted_.try_emplace(of, kWindow, started_).first->second.add(bytes, now);
  }
}

void JobFigures::attempt_failed(int exit_code) { attempt_failed(error_kind(exit_code)); }

RecentRate::Rates JobFigures::converted(const std::string& watch) const {
  const auto at = converted_.find(watch);
  return at == converted_.end() ? RecentRate::Rates{} : at->second.at(std::chrono::steady_clock::now());
}

}  // namespace weir
