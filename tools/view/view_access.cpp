#include "tools/view/view_access.h"

#include "format/base/ascii.h"
#include "format/base/text.h"

namespace weir {

bool offers_protocol(std::string_view protocols, std::string_view wanted) {
  for (const std::string& offered : split(protocols, ',')) {
    if (trimmed(offered) == wanted) return true;
  }
  return false;
}

std::string socket_sources(std::string_view host) {
  constexpr std::string_view kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-:[]";
  if (host.empty() || host.find_first_not_of(kPlain) != std::string_view::npos) return "";
  return cat("ws://", host, " wss://", host);
}

}  // namespace weir
