#include "daemon/http/http_message.h"

#include <nlohmann/json.hpp>

#include "format/base/json_text.h"

namespace weir {

HttpResponse error_response(unsigned status, const std::string& message) {
  const nlohmann::json body{{"error", message}};
  HttpResponse response;
  response.status = status;
  response.body = json_text(body) + '\n';
  return response;
}

}  // namespace weir
