#include "daemon/control_server.h"

#include "daemon/api.h"
#include "format/error.h"
#include "format/text.h"

namespace weir {
namespace {

AccessRules rules_of(const ControlServerSettings& settings) {
  const bool loopback = is_loopback(settings.address.host);
  if (!loopback && settings.token.empty()) {
    throw Error(ErrorKind::usage, cat(settings.address.text(),
                                      ": can be reached from other machines, so it needs a "
                                      "token; set service.token_file, or listen on 127.0.0.1"));
  }
  return {settings.token, loopback};
}

}  // namespace

ControlServer::ControlServer(boost::asio::io_context& io, const ControlServerSettings& settings, Control& control)
    : http_(io, settings.address, settings.limits,
            [api = Api(control, rules_of(settings))](const HttpRequest& request) { return api.answer(request); }) {}

}  // namespace weir
