// What the control server answers: the table of routes over Control.
//
//   GET  /                                the page; its other files are /page/NAME
//   GET  /healthz                         200 while the process answers
//   GET  /readyz                          200 while every watch is up and the state file can be written, else 503
//                                         with the reason, for those who may see it
//   GET  /metrics                         metrics.h
//   GET  /api/status                      StatusView, and control_at: the address at which alone a POST is
//                                         answered, null where it is this one
//   GET  /api/jobs?state=S&watch=LABEL&text=T&problem=KEY&sort=K&order=O&limit=N&offset=N
//                                         JobPage; JobQuery says what they mean. K: changed (the default), discovered,
//                                         source, state, watch, bytes, seconds; O: desc (the default) or asc; limit 100
//                                         unless said, at most 1000
//   GET  /api/problems?limit=N            ProblemPage; the same limits
//   GET  /api/jobs/ID                     JobView with its log tail
//   GET  /api/jobs/ID/thumbnails/N        PNG of the job's output N
//   POST /api/jobs/ID/retry, /api/jobs/ID/cancel           the JobView as it is then; 409 in the wrong state;
//                                         retry?force=1: converted even where its outputs are done
//   POST /api/retry-failed?problem=KEY    {"retried": N}; without a key, of all problems. The first few are retried
//                                         when the answer comes, the rest within seconds: a stop in between leaves
//                                         these failed
//   POST /api/pause, /api/resume          StatusView as it is then
//
// HEAD goes wherever GET does. Errors are {"error": "..."}. No path of the file
// system is ever taken from a request.
#pragma once

#include <cstddef>

#include "daemon/http/access.h"
#include "daemon/http/control.h"
#include "daemon/http/http_message.h"

namespace weir {

inline constexpr std::size_t kMaxJobsPerPage = 1000;

class Api {
 public:
  /// `control` must outlive the object.
  Api(Control& control, AccessRules rules) : control_(control), rules_(std::move(rules)) {}

  /// Throws what `control` throws.
  HttpResponse answer(const HttpRequest& request) const;

 private:
  Control& control_;
  AccessRules rules_;
};

}  // namespace weir
