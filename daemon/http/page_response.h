// Answers with the files of a page, and the headers that keep a page to itself.
#pragma once

#include <span>
#include <string_view>

#include "daemon/http/http_message.h"
#include "daemon/http/page_files.h"

namespace weir {

/// The file `name` of the first of `pages` that has one; 404 where none does.
HttpResponse page_response(std::initializer_list<std::span<const PageFile>> pages, std::string_view name);

/// Adds what every answer has: no script, style or picture from anywhere else, no other page's frame, no guessed types,
/// no caching where the answer says nothing of it. `connect`: where the page may connect to besides this server, in the
/// words of a content policy.
void add_page_headers(HttpResponse& response, std::string_view connect = {});

}  // namespace weir
