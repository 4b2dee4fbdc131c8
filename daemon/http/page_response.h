// Answers with the files of a page and with headers that isolate the page.
#pragma once

#include <span>
#include <string_view>

#include "daemon/http/http_message.h"
#include "daemon/http/page_files.h"

namespace weir {

/// Returns the file `name` of the first of `pages` that has it; 404 if none has.
HttpResponse page_response(std::initializer_list<std::span<const PageFile>> pages, std::string_view name);

/// Adds the headers of every answer: no script, style or picture from another server, no display in another page's
/// frame, no guessed content types, and no caching unless the answer allows it. `connect`: other places that the page
/// may connect to, in the syntax of a content security policy.
void add_page_headers(HttpResponse& response, std::string_view connect = {});

}  // namespace weir
