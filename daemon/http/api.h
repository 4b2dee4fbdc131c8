// What the control server answers: the table of routes over Control.
// docs/http-api.md describes them all.
//
// HEAD goes wherever GET does. Errors are {"error": "..."}. No path of the file
// system is ever taken from a request.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "daemon/http/access.h"
#include "daemon/http/control.h"
#include "daemon/http/http_message.h"

namespace weir {

/// "GET /api/jobs/*" and so on: each method and path that is answered, * for any one segment.
std::vector<std::string> api_routes();

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
