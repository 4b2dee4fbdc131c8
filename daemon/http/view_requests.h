// What is below /view/ is answered by the viewer, weir view, behind this server: which requests that are, who may ask,
// and what the viewer is sent.
#pragma once

#include <optional>
#include <string>

#include "daemon/http/access.h"
#include "daemon/http/control.h"
#include "daemon/http/http_message.h"
#include "daemon/http/socket_handler.h"

namespace weir {

/// Connections to the viewer at a time: each holds two pieces of its bytes. Those for files of the page are counted for
/// themselves, so that they keep nobody from looking: for one more, the oldest of them is closed.
inline constexpr std::size_t kMostViewerSockets = 16;
inline constexpr std::size_t kMostViewerFiles = 48;

bool is_view_request(const HttpRequest& request);

/// The refusal of such a request, or none. The page's own files need no token. Where POST is answered at another
/// address, all are refused: what a viewer shows is more than the figures of jobs.
std::optional<HttpResponse> refuse_view(const AccessRules& rules, const HttpRequest& request, const ViewerView& viewer);

/// The request as the viewer is sent it: without /view, with the viewer's token for the service's own, without a body,
/// and with no header but those that a viewer reads.
std::string forwarded_request(const UpgradeRequest& request, const std::string& token);

}  // namespace weir
