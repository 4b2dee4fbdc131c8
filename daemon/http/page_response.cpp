#include "daemon/http/page_response.h"

#include <algorithm>
#include <string>
#include <utility>

#include "format/base/text.h"

namespace weir {
namespace {

std::string_view page_type(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (name.ends_with(".svg")) return "image/svg+xml";
  return "application/octet-stream";
}

// The page uses no script, style or picture of another server and no inline script, and no other page may frame it.
std::string content_policy(std::string_view connect) {
  return cat("default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'",
             connect.empty() ? "" : " ", connect, "; base-uri 'none'; form-action 'none'; frame-ancestors 'none'");
}

}  // namespace

HttpResponse page_response(std::initializer_list<std::span<const PageFile>> pages, std::string_view name) {
  for (const std::span<const PageFile> page : pages) {
    for (const PageFile& file : page) {
      if (file.name == name) return {200, std::string(page_type(name)), std::string(file.content), {}};
    }
  }
  return error_response(404, cat("the page has no file ", name));
}

void add_page_headers(HttpResponse& response, std::string_view connect) {
  const bool cached = std::any_of(response.headers.begin(), response.headers.end(),
                                  [](const auto& header) { return header.first == "Cache-Control"; });
  if (!cached) response.headers.emplace_back("Cache-Control", "no-store");
  response.headers.emplace_back("Content-Security-Policy", content_policy(connect));
  for (const auto& [name, value] :
       {std::pair("X-Content-Type-Options", "nosniff"), std::pair("X-Frame-Options", "DENY"),
        std::pair("Referrer-Policy", "no-referrer"), std::pair("Cross-Origin-Resource-Policy", "same-origin")}) {
    response.headers.emplace_back(name, value);
  }
}

}  // namespace weir
