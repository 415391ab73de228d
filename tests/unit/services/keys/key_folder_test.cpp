#include "services/keys/key_folder.hpp"

#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "services/keys/openssl.hpp"
#include "tests/support/temporary_folder.hpp"

namespace slammot::keys {
namespace {

using ::testing::HasSubstr;

class Keys : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!openssl(folder_.path(), {"version"})) GTEST_SKIP() << "there is no openssl";
    const auto fault = keys_.init(30);
    ASSERT_FALSE(fault) << fault->message;
  }
  std::string issue(const std::string& name) const {
    const auto fault = keys_.issue(name, grant_of(name), 10);
    return fault ? fault->message : "";
  }

  testing::TemporaryFolder folder_;
  KeyFolder keys_{folder_.path()};
};

TEST_F(Keys, HaveCertificatesOfTheAuthority) {
  ASSERT_EQ(issue("tracking"), "");
  EXPECT_TRUE(openssl(folder_.path(), {"verify", "-CAfile", "ca.pem", "tracking.cert.pem"}));
}

TEST_F(Keys, HavePermissionsAndGovernanceSignedByTheAuthority) {
  ASSERT_EQ(issue("tracking"), "");
  for (const char* name : {"tracking.permissions.p7s", "governance.p7s"}) {
    const auto verified =
        openssl(folder_.path(), {"smime", "-verify", "-text", "-in", name, "-CAfile", "ca.pem"});
    EXPECT_TRUE(verified) << name;
  }
}

TEST_F(Keys, OfARevokedIdentityAreRefused) {
  ASSERT_EQ(issue("tracking"), "");
  ASSERT_FALSE(keys_.revoke("tracking"));
  EXPECT_FALSE(openssl(folder_.path(), {"verify", "-CAfile", "ca.pem", "-CRLfile", "crl.pem",
                                        "-crl_check", "tracking.cert.pem"}));
  auto identities = keys_.identities();
  ASSERT_TRUE(identities);
  ASSERT_EQ(identities->size(), 1U);
  EXPECT_EQ(identities->front().name, "tracking");
  EXPECT_TRUE(identities->front().is_revoked);
  EXPECT_FALSE(identities->front().is_expired);
}

TEST_F(Keys, ThatWereNotIssuedAreNotRevoked) {
  const auto fault = keys_.revoke("tracking");
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->message, HasSubstr("tracking.cert.pem is missing: slammot keys list"));
}

TEST_F(Keys, AreReadByTheirOwnerOnly) {
  ASSERT_EQ(issue("tracking"), "");
  using std::filesystem::perms;
  for (const char* name : {"tracking.key.pem", "ca/ca.key.pem"}) {
    const perms granted = std::filesystem::status(folder_.path() / name).permissions();
    EXPECT_EQ(granted & (perms::group_all | perms::others_all), perms::none) << name;
  }
}

TEST_F(Keys, OfAnAuthorityAreNotReplaced) {
  const auto fault = keys_.init(30);
  ASSERT_TRUE(fault);
  EXPECT_THAT(fault->message, HasSubstr("has an authority already"));
}

TEST(KeysWithoutAuthority, AreRefusedInOneLine) {
  const testing::TemporaryFolder folder;
  const auto identities = KeyFolder(folder.path()).identities();
  ASSERT_FALSE(identities);
  EXPECT_THAT(identities.error().message, HasSubstr("has no authority"));
  for (const auto& path : {folder.path(), folder.path() / "missing"}) {
    const KeyFolder keys(path);
    for (const auto& fault :
         {keys.issue("tracking", grant_of("tracking"), 10), keys.revoke("tracking")}) {
      ASSERT_TRUE(fault);
      EXPECT_EQ(fault->message, path.string() +
                                    " has no authority: make one with slammot keys "
                                    "init " +
                                    path.string());
    }
  }
}

}  // namespace
}  // namespace slammot::keys
