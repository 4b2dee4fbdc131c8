// The answers of the control server: the table of routes over Control. docs/http-api.md describes all routes.
//
// HEAD is answered wherever GET is. Errors are {"error": "..."}. No path of the file system is ever taken from a
// request.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/http/access.h"
#include "daemon/http/control.h"
#include "daemon/http/http_message.h"

namespace weir {

/// Returns each answered method and path as "GET /api/jobs/*"; * stands for any one segment.
std::vector<std::string> api_routes();

inline constexpr std::size_t kMaxJobsPerPage = 1000;

class Api {
 public:
  /// `control` must outlive the object.
  Api(Control& control, AccessRules rules) : control_(control), rules_(std::move(rules)) {}

  /// Returns the answer to `request`. Throws what `control` throws.
  HttpResponse answer(const HttpRequest& request) const;

 private:
  Control& control_;
  AccessRules rules_;
};

}  // namespace weir
