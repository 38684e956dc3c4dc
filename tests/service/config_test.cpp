// SPDX-License-Identifier: Apache-2.0
// What an operator sets, and the addresses that it stands for.
#include <gtest/gtest.h>

#include <fstream>

#include "server/config.h"
#include "tests/service/service_fixture.h"

namespace tilelight::server {
namespace {

Result<ConfigRequest> load(std::vector<const char*> flags, std::map<std::string, std::string> environment = {}) {
  flags.insert(flags.begin(), "tilelightd");
  return load_config(static_cast<int>(flags.size()), flags.data(), environment);
}

TEST(Config, FlagsWinOverTheEnvironmentOverTheFileOverTheDefaults) {
  const std::string path = ::testing::TempDir() + "tilelight_config_test.json";
  std::ofstream(path) << R"({"port": 1, "threads": 1, "max_queue": 1})";
  const std::string flag = "--config=" + path;
  const auto loaded = load({flag.c_str(), "--port", "3"}, {{"TILELIGHT_PORT", "2"}, {"TILELIGHT_THREADS", "2"}});
  ASSERT_TRUE(loaded) << loaded.error().detail;
  EXPECT_EQ(loaded->config.port, 3);
  EXPECT_EQ(loaded->config.threads, 2);
  EXPECT_EQ(loaded->config.max_queue, 1);
  EXPECT_EQ(loaded->config.admin_port, 8081);
  std::ofstream(path) << R"({"prot": 1})";
  EXPECT_NE(load({flag.c_str()}).error().detail.find("prot"), std::string::npos);
}

TEST(Config, UnknownNamesAndBadValuesRefuseToStartAndAreNamed) {
  EXPECT_NE(load({"--prot", "1"}).error().detail.find("--prot"), std::string::npos);
  EXPECT_NE(load({}, {{"TILELIGHT_PROT", "1"}}).error().detail.find("TILELIGHT_PROT"), std::string::npos);
  EXPECT_NE(load({"--port", "70000"}).error().detail.find("70000"), std::string::npos);
  EXPECT_FALSE(load({"--max-results", "10001"})) << "more than there are records to find them by";
  EXPECT_NE(load({"--data-dir", "/tmp/x"}).error().detail.find(":memory:"), std::string::npos);
  for (const char* hosts : {"https://render.example", "a.example,render.example:443", "*", "*.example"})
    EXPECT_NE(load({"--allowed-hosts", hosts}).error().detail.find("names of hosts"), std::string::npos) << hosts;
  EXPECT_TRUE(load({"--allowed-hosts", "render.example,xn--bcher-kva.example,my_host"}));
  EXPECT_NE(load({"--config", "/nowhere.json"}).error().detail.find("/nowhere.json"), std::string::npos);
}

TEST(Config, APublicAddressNeedsAWordOfAssent) {
  EXPECT_NE(load({"--host", "0.0.0.0"}).error().detail.find("--allow-open"), std::string::npos);
  EXPECT_FALSE(load({"--admin-host", "0.0.0.0"}));
  EXPECT_TRUE(load({"--host", "0.0.0.0", "--allow-open"}));
  EXPECT_TRUE(load({"--host", "::1"}));
  EXPECT_TRUE(load({"--data-dir", ":memory:", "--quiet"}));
}

TEST(Config, EverySettingIsInTheHelp) {
  const auto help = load({"--help"});
  ASSERT_TRUE(help);
  for (const Setting& setting : settings()) {
    EXPECT_NE(help->text.find("--" + std::string(setting.name)), std::string::npos) << setting.name;
  }
}

// A look-up that knows these names.
Resolve knows(std::map<std::string, std::vector<std::string>> names) {
  return [names = std::move(names)](const std::string& host) -> Result<std::vector<std::string>> {
    const auto found = names.find(host);
    if (found == names.end()) return fail("no_address", "no address of '" + host + "' is known");
    return found->second;
  };
}

Result<ConfigRequest> load_host(const char* host, const Resolve& resolve) {
  const char* flags[] = {"tilelightd", "--host", host, "--admin-host", "here"};
  return load_config(5, flags, {}, resolve);
}

TEST(Config, AHostIsPublicIfAnyOfItsAddressesIs) {
  const Resolve resolve = knows({{"here", {"127.0.0.1"}},
                                 {"127.example.org", {"93.184.216.34"}},
                                 {"both.example.org", {"127.0.0.1", "::1", "2001:db8::1"}},
                                 {"own.example.org", {"::1", "127.0.0.7"}}});
  const auto named_like_loopback = load_host("127.example.org", resolve);
  ASSERT_FALSE(named_like_loopback);
  EXPECT_NE(named_like_loopback.error().detail.find("127.example.org, which is 93.184.216.34,"), std::string::npos)
      << named_like_loopback.error().detail;
  EXPECT_NE(load_host("both.example.org", resolve).error().detail.find("2001:db8::1"), std::string::npos);
  EXPECT_NE(load_host("nowhere.example.org", resolve).error().detail.find("--host: no address"), std::string::npos);
  const auto own = load_host("own.example.org", resolve);
  ASSERT_TRUE(own) << own.error().detail;
  EXPECT_EQ(own->config.host_addresses, (std::vector<std::string>{"::1", "127.0.0.7"}))
      << "what was checked is what will be bound";
  EXPECT_EQ(own->config.admin_addresses, std::vector<std::string>{"127.0.0.1"});
}

TEST(Addresses, OfThisMachineAloneAreThoseOfLoopback) {
  for (const char* address :
       {"127.0.0.1", "127.255.0.3", "::1", "0:0:0:0:0:0:0:1", "::ffff:127.0.0.1", "::ffff:7f00:1"})
    EXPECT_TRUE(is_loopback(address)) << address;
  for (const char* address : {"0.0.0.0", "::", "::ffff:0.0.0.0", "128.0.0.1", "::2", "::7f00:1", "fe80::1%lo",
                              "10.0.0.1", "localhost", "127.example.org", ""})
    EXPECT_FALSE(is_loopback(address)) << address;
  for (const char* address : {"0.0.0.0", "::", "::ffff:0.0.0.0"}) EXPECT_TRUE(is_any_address(address)) << address;
  for (const char* address : {"127.0.0.1", "::1", "0.0.0.1"}) EXPECT_FALSE(is_any_address(address)) << address;
}

TEST(Addresses, OfAHostTheFirstThatThisMachineHasIsBoundAndNoOtherWhereItIsInUse) {
  const service::Service other;
  const auto open = [&](std::vector<std::string> addresses) {
    static const service::HandClock clock;
    Config config;
    config.host_addresses = std::move(addresses);
    config.port = other.port();
    config.admin_port = 0;
    config.log_level = "off";
    return App::open(std::move(config), clock);
  };
  const auto in_use = open({"127.0.0.1", "127.0.0.2"});
  ASSERT_FALSE(in_use);
  EXPECT_EQ(in_use.error().code, "bind");
  EXPECT_NE(in_use.error().detail.find("127.0.0.1:"), std::string::npos) << in_use.error().detail;
  const auto elsewhere = open({"192.0.2.1", "127.0.0.2"});  // the first is nobody's (RFC 5737)
  ASSERT_TRUE(elsewhere) << elsewhere.error().detail;
  EXPECT_EQ((*elsewhere)->port(), other.port());
}

TEST(Addresses, AreFoundInEverySpellingOfANumber) {
  for (const char* host : {"127.1", "2130706433", "0x7f.1", "0177.0.0.1"})
    EXPECT_EQ(resolve_host(host).value(), std::vector<std::string>{"127.0.0.1"}) << host;
  EXPECT_EQ(resolve_host("0").value(), std::vector<std::string>{"0.0.0.0"});
  EXPECT_EQ(resolve_host("").error().code, "no_address") << "which the system takes for every address";
}

}  // namespace
}  // namespace tilelight::server
