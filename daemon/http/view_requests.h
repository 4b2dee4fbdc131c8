// Requests below /view/, which the viewer (weir view) behind this server answers: how they are recognized, who may
// send them, and what the viewer receives.
#pragma once

#include <optional>
#include <string>

#include "daemon/http/access.h"
#include "daemon/http/control.h"
#include "daemon/http/http_message.h"
#include "daemon/http/socket_handler.h"

namespace weir {

/// The most connections to the viewer at a time; each holds two pieces of its bytes. Connections for files of the
/// page are counted separately, so that they keep nobody from looking: for one more, the oldest of them is closed.
inline constexpr std::size_t kMostViewerSockets = 16;
inline constexpr std::size_t kMostViewerFiles = 48;

bool is_view_request(const HttpRequest& request);

/// Returns the refusal of a view request, or none. The page's own files need no token. If another address answers
/// POST, all view requests are refused here, because a viewer shows more than the figures of jobs.
std::optional<HttpResponse> refuse_view(const AccessRules& rules, const HttpRequest& request, const ViewerView& viewer);

/// Returns the request to send to the viewer: without /view and without a body, with the viewer's token instead of
/// the service's, and with only the headers that a viewer reads.
std::string forwarded_request(const UpgradeRequest& request, const std::string& token);

}  // namespace weir
