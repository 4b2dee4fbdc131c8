#include "daemon/http/http_message.h"

#include <nlohmann/json.hpp>

namespace weir {

HttpResponse error_response(unsigned status, const std::string& message) {
  const nlohmann::json body{{"error", message}};
  HttpResponse response;
  response.status = status;
  response.body = body.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
  return response;
}

}  // namespace weir
