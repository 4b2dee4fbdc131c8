// What pages ask of the conversion for a scene: its command, what that would come to, and its run. Lives on the
// io_context's thread.
#pragma once

#include <boost/asio/io_context.hpp>
#include <cstddef>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "tools/view/base/open_files.h"
#include "tools/view/base/view_message.h"
#include "tools/view/convert/scene_converter.h"
#include "tools/view/convert/scene_forecasts.h"

namespace weir {

struct SceneRequestRules {
  std::string program;     ///< path of weir
  std::string preview_of;  ///< the source that the volume is a preview of; empty: its sidecar names it
  bool run = false;        ///< a page may have the conversion run
  bool forecast = true;    ///< a page may have it forecast, which takes the memory of a conversion
  std::vector<std::string> forecast_options = {};  ///< of weir convert: what a forecast may take
};

class SceneRequests {
 public:
  using Send = std::function<void(ViewerId viewer, const nlohmann::ordered_json& message)>;

  /// `files` must outlive the object.
  SceneRequests(boost::asio::io_context& io, SceneRequestRules rules, OpenFiles& files, Send send);

  /// Answers by `send`, now and as more is known, for the volume of that step, without a command where there is none:
  /// its sidecar or its source is not there.
  void handle(ViewerId viewer, std::size_t step, const std::string& volume, const ConvertRequest& request);
  /// The viewer is gone.
  void forget(ViewerId viewer) { forecasts_.forget(viewer); }

 private:
  void forecast(ViewerId viewer, const SceneConversion& conversion, const ConvertRequest& request);

  const SceneRequestRules rules_;
  OpenFiles& files_;
  const Send send_;
  SceneConverter converter_;
  SceneForecasts forecasts_;
};

}  // namespace weir
