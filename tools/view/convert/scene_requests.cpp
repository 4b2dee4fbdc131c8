#include "tools/view/convert/scene_requests.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "compressor/select/file_size.h"

namespace weir {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

SceneRequests::SceneRequests(boost::asio::io_context& io, SceneRequestRules rules, Send send)
    : rules_(std::move(rules)),
      send_(std::move(send)),
      converter_(io, rules_.program),
      forecasts_(io, rules_.program, rules_.forecast_options, send_) {}

void SceneRequests::handle(ViewerId viewer, const std::string& volume, const Sidecar& sidecar,
                           const ConvertRequest& request) {
  const SceneConversion conversion = scene_conversion(volume, rules_.preview_of, sidecar, request);
  Json reply{{"type", "conversion"}, {"id", request.id}, {"command", conversion.text}};
  reply["bytes"] = request.rate ? Json(bytes_at_rate(sidecar.budget.dense_float32_bytes, *request.rate)) : Json();
  const auto tell = [send = send_, viewer, reply](const std::string& state, const std::string& message) {
    Json told = reply;
    told["state"] = state;
    told["message"] = message;
    send(viewer, told);
  };
  if (!request.run) {
    tell("shown", "");
    return forecast(viewer, conversion, request);
  }
  if (!rules_.run) return tell("failed", "this server runs no conversion; start it with --allow-convert");
  converter_.start(conversion, request.scene_text, [tell](const std::string& output, const std::string& message) {
    tell(message.empty() ? "done" : "failed", message.empty() ? output : message);
  });
  tell("running", "");
}

void SceneRequests::forecast(ViewerId viewer, const SceneConversion& conversion, const ConvertRequest& request) {
  if (rules_.forecast) return forecasts_.ask(viewer, request.id, conversion, request.scene_text);
  send_(viewer,
        {{"type", "forecast"},
         {"id", request.id},
         {"state", "failed"},
         {"message",
          "no memory is set aside for a forecast here, run the command with --dry-run; --forecast-memory of weir "
          "view, or 192 MiB of viewer_memory of weir watch, has one made"}});
}

}  // namespace weir
