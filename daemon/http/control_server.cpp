#include "daemon/http/control_server.h"

#include "daemon/http/api.h"
#include "daemon/http/view_requests.h"
#include "format/base/error.h"
#include "format/base/text.h"

namespace weir {
namespace {

ListenAddress control_address(const ControlServerSettings& settings) { return {"", 0, settings.control_socket}; }

AccessRules rules_of(const ControlServerSettings& settings) {
  const bool loopback = is_loopback(settings.address.host);
  if (!loopback && settings.token.empty()) {
    throw Error(ErrorKind::usage, cat(settings.address.text(),
                                      ": can be reached from other machines, so it needs a "
                                      "token; set service.token_file, or listen on 127.0.0.1"));
  }
  return {settings.token, loopback, settings.control_socket.empty() ? "" : control_address(settings).text()};
}

// The access rights of the socket's path decide who may connect. A browser reaches the socket through a tunnel from a
// loopback port, so the rule for Host headers holds here, too.
AccessRules rules_of_socket() { return {"", true}; }

HttpHandler answer_with(Control& control, const AccessRules& rules) {
  return [api = Api(control, rules)](const HttpRequest& request) { return api.answer(request); };
}

SocketHandler view_with(Control& control, const AccessRules& rules, const ControlServer::Take& view) {
  return {[&control, rules](const HttpRequest& request) { return refuse_view(rules, request, control.viewer()); }, view,
          is_view_request};
}

}  // namespace

ControlServer::ControlServer(boost::asio::io_context& io, const ControlServerSettings& settings, Control& control,
                             const Take& view)
    : http_(io, settings.address, settings.limits, answer_with(control, rules_of(settings)),
            view_with(control, rules_of(settings), view)) {
  if (settings.control_socket.empty()) return;
  control_socket_.emplace(io, control_address(settings), settings.limits, answer_with(control, rules_of_socket()),
                          view_with(control, rules_of_socket(), view));
}

}  // namespace weir
