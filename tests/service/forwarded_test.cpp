// SPDX-License-Identifier: Apache-2.0
// What is believed of proxies, and of whom. Addresses are of RFC 5737 and RFC 3849.
#include "server/http/forwarded.h"

#include <gtest/gtest.h>

namespace tilelight::server {
namespace {

std::vector<Network> networks(std::initializer_list<const char*> texts) {
  std::vector<Network> out;
  for (const char* text : texts) out.push_back(parse_network(text).value());
  return out;
}

using Fields = std::vector<std::pair<std::string, std::string>>;

Request received(const std::string& peer, const Fields& fields, const std::vector<Network>& trusted) {
  Request request;
  request.client = peer;
  for (const auto& [name, value] : fields) request.headers.emplace(name, value);
  believe_proxies(request, trusted);
  return request;
}

const std::vector<Network> kTrusted = networks({"127.0.0.1", "10.0.0.0/8", "2001:db8:f::/48"});

std::string client_of(const std::string& peer, const Fields& fields) { return received(peer, fields, kTrusted).client; }

TEST(Network, IsAnAddressOrAllThatShareItsFirstBits) {
  const auto holds = [](const char* network, const char* address) {
    return parse_network(network).value().holds(parse_address(address).value());
  };
  EXPECT_TRUE(holds("10.0.0.0/8", "10.255.255.255"));
  EXPECT_FALSE(holds("10.0.0.0/8", "11.0.0.0"));
  EXPECT_TRUE(holds("10.128.0.0/9", "10.200.0.1"));
  EXPECT_FALSE(holds("10.128.0.0/9", "10.127.255.255"));
  EXPECT_TRUE(holds("192.0.2.1", "::ffff:192.0.2.1")) << "one address, two spellings";
  EXPECT_TRUE(holds("2001:db8::/33", "2001:db8:7fff::1"));
  EXPECT_FALSE(holds("2001:db8::/33", "2001:db8:8000::1"));
  EXPECT_TRUE(holds("0.0.0.0/0", "203.0.113.9"));
  EXPECT_FALSE(holds("0.0.0.0/0", "2001:db8::1"));
  EXPECT_TRUE(holds("::/0", "2001:db8::1"));
}

TEST(Network, ThatIsNoneIsRefusedInASentence) {
  for (const char* text :
       {"", "localhost", "10.0.0", "10.0.0.0/33", "10.0.0.0/-1", "10.0.0.0/", "10.0.0.0/8x", "::/129", "10.0.0.256",
        "010.0.0.1", "[::1]", "::1%lo", "10.0.0.1:80", " 10.0.0.1", "10.0.0.1/8"}) {
    const auto network = parse_network(text);
    ASSERT_FALSE(network) << text;
    EXPECT_NE(network.error().detail.find(std::string("'") + text + "'"), std::string::npos);
  }
}

TEST(Forwarded, CountsFromATrustedPeerAndFromNobodyElse) {
  EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", "192.0.2.1"}}), "192.0.2.1");
  EXPECT_EQ(client_of("127.0.0.2", {{"X-Forwarded-For", "192.0.2.1"}}), "127.0.0.2");
  EXPECT_EQ(client_of("2001:db8:f::7", {{"X-Forwarded-For", "192.0.2.1"}}), "192.0.2.1");
  EXPECT_EQ(client_of("fe80::1%eth0", {{"X-Forwarded-For", "192.0.2.1"}}), "fe80::1%eth0");
  EXPECT_EQ(client_of("127.0.0.1", {}), "127.0.0.1");
  EXPECT_EQ(received("127.0.0.1", {{"X-Forwarded-For", "192.0.2.1"}}, {}).client, "127.0.0.1");
}

TEST(Forwarded, TheClientIsTheRightmostAddressThatIsNoTrustedProxy) {
  EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", "198.51.100.9, 192.0.2.1"}}), "192.0.2.1");
  EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", "198.51.100.9, 192.0.2.1, 10.1.2.3"}}), "192.0.2.1");
  EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", "10.9.9.9,192.0.2.1 ,\t10.1.2.3,10.4.5.6"}}), "192.0.2.1");
  EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", "198.51.100.9"}, {"X-Forwarded-For", "192.0.2.1, 10.1.2.3"}}),
            "192.0.2.1")
      << "fields of one name are one list";
  EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", "10.7.7.7, 10.1.2.3"}}), "10.7.7.7")
      << "where all are trusted, the first of them asks for itself";
}

TEST(Forwarded, AnAddressHasOneSpellingHoweverItCame) {
  for (const char* text : {"2001:db8::1", "2001:0DB8:0::0:1", "[2001:db8::1]", "[2001:db8::1]:4711"}) {
    EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", text}}), "2001:db8::1") << text;
  }
  for (const char* text : {"192.0.2.1", "192.0.2.1:4711", "::ffff:192.0.2.1", "[::ffff:c000:201]:80"}) {
    EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", text}}), "192.0.2.1") << text;
  }
}

TEST(Forwarded, WhatIsNoAddressEndsTheChainAtTheProxyThatWroteIt) {
  for (const char* text : {"unknown", "_hidden", "192.0.2", "192.0.2.1.evil.example", "[2001:db8::1", "192.0.2.1:port",
                           "localhost", "fe80::1%eth0", "for=192.0.2.1", "\"192.0.2.1\""}) {
    EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", text}}), "127.0.0.1") << text;
    EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", "192.0.2.7, " + std::string(text) + ", 10.1.2.3"}}),
              "10.1.2.3")
        << text;
    EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", std::string(text) + ", 192.0.2.7"}}), "192.0.2.7") << text;
  }
  EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", ""}}), "127.0.0.1");
  EXPECT_EQ(client_of("127.0.0.1", {{"X-Forwarded-For", " , ,"}}), "127.0.0.1");
}

TEST(Forwarded, TheFieldOfRfc7239IsNotRead) {
  const Request request = received("127.0.0.1", {{"Forwarded", "for=192.0.2.1;proto=https;host=a.example"}}, kTrusted);
  EXPECT_EQ(request.client, "127.0.0.1");
  EXPECT_EQ(request.scheme, "");
}

TEST(Forwarded, SchemeHostAndPrefixAreThoseOfTheClientsPlaceInTheChain) {
  const Request request = received("127.0.0.1",
                                   {{"Host", "inner:8080"},
                                    {"X-Forwarded-For", "198.51.100.9, 192.0.2.1, 10.1.2.3"},
                                    {"X-Forwarded-Proto", "ftp, HTTPS, http"},
                                    {"X-Forwarded-Host", "a.example, b.example:8443, c.example"},
                                    {"X-Forwarded-Prefix", "/render/"}},
                                   kTrusted);
  EXPECT_EQ(request.scheme, "https");
  EXPECT_EQ(authority_text(request.host), "b.example:8443");
  EXPECT_EQ(request.prefix, "/render");
}

TEST(Forwarded, WhatCanNotBeIsNotBelieved) {
  for (const char* prefix :
       {"render", "//evil.example", "/a//b", "/a b", "/a\"b", "https://evil.example", "/<b>", "/", ""}) {
    EXPECT_EQ(received("127.0.0.1", {{"X-Forwarded-Prefix", prefix}}, kTrusted).prefix, "") << prefix;
  }
  for (const char* host : {"a b", "a:port", "user@a", "[::1", "localhos%7", ""}) {
    EXPECT_EQ(received("127.0.0.1", {{"Host", "own"}, {"X-Forwarded-Host", host}}, kTrusted).host.name, "own") << host;
  }
  EXPECT_EQ(received("127.0.0.1", {{"X-Forwarded-Proto", "wss"}}, kTrusted).scheme, "");
}

}  // namespace
}  // namespace tilelight::server
