// Tests who may look at the files that weir view serves.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "format/base/error.h"
#include "format/base/text.h"
#include "tests/daemon/support/raw_client.h"
#include "tests/tools/support/converted_volume.h"
#include "tests/tools/view/served_view.h"
#include "tests/tools/view/view_client.h"

namespace weir::view_access_test {
namespace {

using Json = nlohmann::json;

class ViewAccessTest : public ConvertedVolume {
 protected:
  /// Returns the answer to a client with these headers.
  static std::string answer_to(const ServedView& served, const ClientHeaders& headers) {
    return upgrade_answer(served.port(), headers);
  }
  static std::string with_origin(const ServedView& served, const std::string& origin) {
    return answer_to(served, {"127.0.0.1:1", origin});
  }
};

TEST_F(ViewAccessTest, ForeignPages_AreRefused) {
  ServedView served(volume_);
  EXPECT_EQ(with_origin(served, "http://evil.example"),
            "403 {\"error\":\"Origin http://evil.example is not 127.0.0.1:1; open this server's own page\"}\n");
  EXPECT_EQ(with_origin(served, "null").substr(0, 3), "403");
  EXPECT_EQ(with_origin(served, "http://127.0.0.1:2").substr(0, 3), "403");
  EXPECT_EQ(with_origin(served, "http://127.0.0.1:1"), "101");
  EXPECT_EQ(with_origin(served, ""), "101");
  EXPECT_EQ(answer_to(served, {"evil.example", "http://evil.example"}).substr(0, 3), "421");
  EXPECT_EQ(get(served.port(), "/api/state", {"evil.example"}).first, 421);
  EXPECT_EQ(answer_to(served, {.target = "/api/state"}).substr(0, 3), "404");
}

TEST_F(ViewAccessTest, OtherMethodsThanGet_AreRefusedForThat) {
  const ServedView served(volume_);
  for (const char* method : {"POST", "PUT", "DELETE"}) {
    RawClient client(served.port());
    const RawResponse response =
        client.ask(cat(method, " /api/state HTTP/1.1\r\nHost: 127.0.0.1:1\r\nContent-Length: 0\r\n\r\n"));
    EXPECT_EQ(response.status, 405);
    EXPECT_EQ(response.body, cat("{\"error\":\"", method, " is not for /api/state; use GET\"}\n"));
  }
}

TEST_F(ViewAccessTest, Token_IsNeededForAllButThePage) {
  ViewSettings settings;
  settings.token = "se";
  ServedView served(volume_, "", settings);
  EXPECT_EQ(answer_to(served, {}).substr(0, 3), "401");
  EXPECT_EQ(answer_to(served, {.protocols = "weir.view, weir.token.7365ff"}).substr(0, 3), "401");
  EXPECT_EQ(answer_to(served, {.protocols = "weir.view, weir.token.7365"}), "101");
  EXPECT_EQ(get(served.port(), "/api/state").first, 401);
  EXPECT_EQ(get(served.port(), "/api/state", {}, "Bearer se").first, 200);
  EXPECT_EQ(get(served.port(), "/").first, 200);
  EXPECT_EQ(get(served.port(), "/page/view.js").first, 200);
}

TEST_F(ViewAccessTest, WrongToken_IsToldWhereTheRightOneIs) {
  ViewSettings settings;
  settings.token = "se";
  const auto answer = [&] { return get(ServedView(volume_, "", settings).port(), "/api/state", {}, "Bearer other"); };
  EXPECT_EQ(answer().second,
            "{\"error\":\"the token is not this viewer's; take the one in the file that --token-file names\"}\n");
  settings.any_host = true;
  EXPECT_EQ(answer().second,
            "{\"error\":\"the token is not this viewer's; take the one that it printed to --progress-fd\"}\n");
}

TEST_F(ViewAccessTest, AddressThatOthersReach_NeedsAToken) {
  ViewSettings settings;
  settings.address = {"0.0.0.0", 0};
  const auto serve = [&] { ServedView served(volume_, "", settings); };
  EXPECT_THROW(serve(), Error);
  try {
    serve();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::usage);
    EXPECT_EQ(std::string(error.what()),
              "--listen 0.0.0.0:0 can be reached from other machines, so it needs --token-file FILE; or listen on "
              "127.0.0.1");
  }
}

TEST_F(ViewAccessTest, Paths_AreThePagesAlone) {
  ServedView served(volume_);
  EXPECT_EQ(get(served.port(), "/page/dom.js").first, 200) << "shared with the page of weir watch";
  EXPECT_EQ(get(served.port(), "/page/..%2Fv.nvdb").first, 404);
  EXPECT_EQ(get(served.port(), "/v.nvdb").first, 404);
  EXPECT_EQ(get(served.port(), "/../v.nvdb").first, 404);
  EXPECT_EQ(get(served.port(), "/ws").first, 426);
  const Json state = Json::parse(get(served.port(), "/api/state").second);
  EXPECT_EQ(state["steps"], Json::parse("[\"v.nvdb\"]"));
  EXPECT_EQ(state["colormaps"]["gray"].front(), "#000000");
  EXPECT_EQ(state["colormaps"]["gray"].back(), "#ffffff");
}

}  // namespace
}  // namespace weir::view_access_test
