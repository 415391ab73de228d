#include "services/gateway/access.hpp"

#include <gtest/gtest.h>

namespace slammot::gateway {
namespace {

const AccessRules kRules{.token = "secret",
                         .trusted_addresses = {"172.30.77.1"},
                         .origins = {"https://viewer.example.org"},
                         .host_names = {"robot"}};

Caller local_page() { return {"127.0.0.1", true, "localhost:8765", "http://localhost:8765", ""}; }

TEST(Access, LetsThePageOfThisServerConnect) {
  EXPECT_EQ(verdict_on(local_page(), kRules), Verdict::kAllowed);
}

TEST(Access, AsksRemoteAddressesForTheToken) {
  Caller caller{"10.0.0.7", false, "10.0.0.2:8765", "", ""};
  EXPECT_EQ(verdict_on(caller, kRules), Verdict::kNeedsToken);
  caller.token = "secreT";
  EXPECT_EQ(verdict_on(caller, kRules), Verdict::kNeedsToken);
  caller.token = "secret";
  EXPECT_EQ(verdict_on(caller, kRules), Verdict::kAllowed);
}

TEST(Access, LetsNoRemoteAddressInWhereThereIsNoToken) {
  EXPECT_EQ(verdict_on({"10.0.0.7", false, "10.0.0.2:8765", "", ""}, {}), Verdict::kNeedsToken);
}

TEST(Access, TrustsAddressesThatAreListed) {
  EXPECT_EQ(verdict_on({"172.30.77.1", false, "localhost:8765", "", ""}, kRules),
            Verdict::kAllowed);
}

TEST(Access, RefusesPagesOfOtherServersUnlessListed) {
  Caller caller = local_page();
  caller.origin = "https://evil.example.org";
  EXPECT_EQ(verdict_on(caller, kRules), Verdict::kForeignOrigin);
  caller.origin = "https://viewer.example.org";
  EXPECT_EQ(verdict_on(caller, kRules), Verdict::kAllowed);
}

TEST(Access, RefusesAForeignNameThatResolvesToThisMachine) {
  Caller caller{"127.0.0.1", true, "evil.example.org:8765", "http://evil.example.org:8765", ""};
  EXPECT_EQ(verdict_on(caller, kRules), Verdict::kForeignHost);
  for (const char* host : {"robot:8765", "[::1]:8765", "127.0.0.1:8765", "localhost"}) {
    caller.host = host;
    caller.origin = "";
    EXPECT_EQ(verdict_on(caller, kRules), Verdict::kAllowed) << host;
  }
}

TEST(Access, ReadsTheTokenFromTheQuery) {
  EXPECT_EQ(query_value("a=1&token=xyz&b=", "token"), "xyz");
  EXPECT_EQ(query_value("token=xyz", "b"), "");
  EXPECT_EQ(query_value("&&=&token", "token"), "");
}

TEST(Access, DecodesWhatClientsEncode) {
  EXPECT_EQ(query_value("token=a%2Bb%2fc%3D", "token"), "a+b/c=");
  EXPECT_EQ(query_value("token=a+b", "token"), "a+b");
  EXPECT_EQ(query_value("token=%zz%4", "token"), "%zz%4");
  EXPECT_EQ(query_value("token=%", "token"), "%");
}

TEST(Access, ReadsTheTokenFromTheHeaderInAnyCase) {
  EXPECT_EQ(bearer_token("Bearer abc"), "abc");
  EXPECT_EQ(bearer_token("bearer abc"), "abc");
  EXPECT_EQ(bearer_token("Basic abc"), "");
  EXPECT_EQ(bearer_token("Bear"), "");
}

TEST(Access, MakesTokensThatDiffer) {
  EXPECT_EQ(new_token().size(), 32U);
  EXPECT_NE(new_token(), new_token());
}

}  // namespace
}  // namespace slammot::gateway
