// SPDX-License-Identifier: Apache-2.0
// The front: what it takes from a socket, what it refuses, and whom it does not wait for.
#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

using FrontOfService = ServiceTest;

HttpAnswer raw(int port, std::string_view bytes) {
  HttpClient client(port);
  client.write(bytes);
  return client.read();
}

const std::string kPost = "POST /v1/renders HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n";

TEST_F(FrontOfService, AGigabyteIsRefusedBeforeItIsSent) {
  HttpClient client(service_->port());
  client.write(kPost + "Content-Length: 1073741824\r\n\r\n");
  const auto answer = client.read();
  EXPECT_EQ(answer.status, 413);
  EXPECT_NE(answer.body.find("16777216"), std::string::npos) << "the limit is named: " << answer.body;
  EXPECT_EQ(answer.header("connection"), "close");
  EXPECT_TRUE(client.at_end());
}

TEST_F(FrontOfService, ARefusalReachesAClientThatIsStillSending) {
  HttpClient client(service_->port());
  client.write(kPost + "Content-Length: 1073741824\r\n\r\n" + std::string(1 << 20, ' '));
  EXPECT_EQ(client.read().status, 413);
}

TEST_F(FrontOfService, BodiesWithoutALengthOrEncodedAreRefused) {
  EXPECT_EQ(raw(service_->port(), kPost + "Transfer-Encoding: chunked\r\n\r\n2\r\n{}\r\n0\r\n\r\n").status, 411);
  EXPECT_EQ(raw(service_->port(), kPost + "Transfer-Encoding: gzip, chunked\r\n\r\n").status, 501);
  const auto coded = raw(service_->port(), kPost + "Content-Encoding: gzip\r\nContent-Length: 4\r\n\r\nabcd");
  EXPECT_EQ(coded.status, 415);
  EXPECT_EQ(coded.header("accept-encoding"), "identity") << "RFC 9110, 15.5.16";
}

TEST_F(FrontOfService, RequestsThatTwoReadersCouldCutDifferentlyAreRefused) {
  const std::string line = "POST /v1/renders HTTP/1.1\r\n";
  for (const std::string& head : {
           line + "Host: a\r\nContent-Length: 2\r\nContent-Length: 3\r\n\r\n",
           line + "Host: a\r\nContent-Length: +2\r\n\r\n",
           line + "Host: a\r\nContent-Length: -1\r\n\r\n",
           line + "Host: a\r\nHost: b\r\n\r\n",
           line + "\r\n",
           line + "Host: a\r\nX: y\r\n folded\r\n\r\n",
           line + "Host: a\r\nX : y\r\n\r\n",
           line + "Host: a\r\nX: a\nY: b\r\n\r\n",
           line + "Host: a\r\nContent-Length: 2, 2\r\n\r\n",
           line + "Host: a\r\nContent-Length: 2\r\nTransfer-Encoding: chunked\r\n\r\n",
           std::string("POST /v1/renders HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n"),
           std::string("GET /v1/limits HTTP/1.1\nHost: a\n\n"),
           std::string("POST  /v1/renders HTTP/1.1 \r\nHost: a\r\n\r\n"),
           std::string("GET\r\n\r\n"),
           std::string("\x16\x03\x01\x02\r\n\r\n"),
       }) {
    HttpClient client(service_->port());
    client.write(head);
    const auto answer = client.read();
    EXPECT_TRUE(answer.status == 400 || answer.status == 505) << answer.status << " for " << head;
    EXPECT_EQ(answer.header("content-type"), "application/problem+json");
    EXPECT_TRUE(client.at_end());
  }
  EXPECT_EQ(raw(service_->port(), "BREW / HTTP/1.1\r\nHost: localhost\r\n\r\n").status, 501);
  EXPECT_EQ(raw(service_->port(), "GET / HTTP/3.0\r\nHost: localhost\r\n\r\n").status, 505);
}

TEST_F(FrontOfService, LongTargetsAndHeadsAreRefused) {
  EXPECT_EQ(raw(service_->port(), "GET /" + std::string(5000, 'a') + " HTTP/1.1\r\nHost: localhost\r\n\r\n").status,
            414);
  EXPECT_EQ(raw(service_->port(), "GET /" + std::string(100'000, 'a')).status, 414);
  EXPECT_EQ(
      raw(service_->port(), "GET / HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(20'000, 'a') + "\r\n\r\n").status,
      431);
  // A line alone, in a head that is not too large.
  for (const size_t length : {7'999, 8'100, 8'190, 9'000}) {
    const std::string line = "X:" + std::string(length - 2, 'a');
    const auto answer = raw(service_->port(), "GET / HTTP/1.1\r\nHost: localhost\r\n" + line + "\r\n\r\n");
    EXPECT_EQ(answer.status, length > 8'000 ? 431 : 200) << length;
    EXPECT_FALSE(answer.header("request-id").empty()) << length;
  }
  std::string many = "GET / HTTP/1.1\r\nHost: localhost\r\n";
  for (int i = 0; i < 200; ++i) many += "X: y\r\n";
  EXPECT_EQ(raw(service_->port(), many + "\r\n").status, 431);
}

TEST_F(FrontOfService, OneConnectionServesManyRequestsAlsoPipelined) {
  HttpClient client(service_->port());
  for (int i = 0; i < 50; ++i) ASSERT_EQ(client.send("GET", "/v1/limits").status, 200) << i;
  const std::string get = "GET /v1/limits HTTP/1.1\r\nHost: localhost\r\n\r\n";
  std::string many;
  for (int i = 0; i < 20; ++i) many += get;
  client.write(many);
  for (int i = 0; i < 20; ++i) ASSERT_EQ(client.read().status, 200) << i;
  const auto last = client.send("GET", "/v1/limits", {{"Connection", "close"}});
  EXPECT_EQ(last.header("connection"), "close");
  EXPECT_TRUE(client.at_end());
}

TEST_F(FrontOfService, ABodyThatManyReadSlowlyIsInMemoryOnce) {
  Service own;
  const std::string scene = small_scene() + std::string(8 << 20, ' ');
  const std::string path = own.post("/v1/scenes", scene).header("location");
  std::vector<std::unique_ptr<HttpClient>> readers;
  for (int i = 0; i < 20; ++i) {
    readers.push_back(std::make_unique<HttpClient>(own.port()));
    readers.back()->write("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  ASSERT_TRUE(own.metric_reaches("tilelight_http_requests_total{route=\"/v1/scenes/{id}\",status=\"200\"}", 20));
  EXPECT_TRUE(own.metric_reaches("tilelight_http_unread_bytes", 8 << 20));
  EXPECT_LT(own.metric("tilelight_http_unread_bytes"), 9 << 20);
  for (const auto& reader : readers) EXPECT_EQ(reader->read().body, scene);
  const auto head = HttpClient(own.port()).send("HEAD", path);
  EXPECT_EQ(head.header("content-length"), std::to_string(scene.size()));
}

TEST_F(FrontOfService, HeadHasTheHeadersOfGetAndNoBody) {
  HttpClient client(service_->port());
  const auto get = client.send("GET", "/v1/limits"), head = client.send("HEAD", "/v1/limits");
  EXPECT_EQ(head.status, 200);
  EXPECT_EQ(head.header("content-length"), get.header("content-length"));
  EXPECT_EQ(head.header("etag"), get.header("etag"));
  EXPECT_EQ(client.send("GET", "/v1/limits").body, get.body);  // nothing was left over from the HEAD
}

TEST_F(FrontOfService, RangesAreIgnored) {
  std::string ranges = "bytes=0-1";
  for (int i = 0; i < 600; ++i) ranges += ",0-";
  const auto answer = service_->get("/openapi.json", {{"Range", ranges}});
  EXPECT_EQ(answer.status, 200);
  EXPECT_EQ(answer.body, service_->get("/openapi.json").body);
}

TEST_F(FrontOfService, ALargeBodyIsInvitedAndArrivesInPieces) {
  const std::string scene = small_scene(20);
  HttpClient client(service_->port());
  client.write(kPost + "Accept: image/png\r\nExpect: 100-continue\r\nContent-Length: " + std::to_string(scene.size()) +
               "\r\n\r\n");
  EXPECT_EQ(client.read().status, 100);
  for (const char c : scene) client.write(std::string_view(&c, 1));
  EXPECT_EQ(client.read().status, 200);
}

TEST_F(FrontOfService, SlowClientsDoNotKeepOthersWaiting) {
  server::Config config;
  config.max_waiting = 1;  // 33 workers
  Service own(config);
  std::vector<std::unique_ptr<HttpClient>> slow;
  for (int i = 0; i < 300; ++i) {
    slow.push_back(std::make_unique<HttpClient>(own.port()));
    slow.back()->write(i % 2 ? "GET /v1/limits HTTP/1.1\r\nHost: loc" : kPost + "Content-Length: 1000\r\n\r\n{");
  }
  EXPECT_EQ(own.post("/v1/renders", small_scene(), {{"Accept", "image/png"}}).status, 200);
  // The slow ones are served when they have said what they want.
  slow[1]->write("alhost\r\n\r\n");
  EXPECT_EQ(slow[1]->read().status, 200);
}

TEST_F(FrontOfService, ARequestThatNeverEndsIsAnswered408) {
  server::Config config;
  config.head_timeout_ms = 20.0;
  Service own(config);
  HttpClient client(own.port());
  client.write("GET /v1/limits HTTP/1.1\r\n");
  EXPECT_EQ(client.read().status, 408);
  EXPECT_TRUE(client.at_end());
}

TEST_F(FrontOfService, WaitersBeyondTheirBudgetAreAnswered503AndOthersAreNotTouched) {
  server::Config config;
  config.max_waiting = 1;
  Service own(config);
  HttpClient waiter(own.port());
  const std::string scene = endless_scene();
  waiter.write(kPost + "Accept: image/png\r\nContent-Length: " + std::to_string(scene.size()) + "\r\n\r\n" + scene);
  ASSERT_TRUE(own.metric_reaches("tilelight_requests_waiting", 1));
  const auto answer = own.post("/v1/renders", small_scene(), {{"Accept", "image/png"}});
  EXPECT_EQ(answer.status, 503);
  EXPECT_FALSE(answer.header("retry-after").empty());
  EXPECT_EQ(own.post("/v1/renders", small_scene()).status, 202);
  EXPECT_EQ(own.get("/v1/limits").status, 200);
}

TEST(WaitSlots, LeaveAQuarterToOtherClients) {
  server::WaitSlots slots(4);
  {
    std::vector<server::WaitSlots::Slot> held;
    for (int i = 0; i < 3; ++i) held.push_back(std::move(*slots.take("one")));
    EXPECT_EQ(slots.take("one").error().status, 429);
    const auto other = slots.take("two");
    ASSERT_TRUE(other);
    EXPECT_EQ(slots.take("three").error().status, 503);
  }
  EXPECT_EQ(slots.free(), 4);
  EXPECT_TRUE(slots.take("one"));
}

TEST_F(FrontOfService, WhatAClientClaimsAboutItsAddressIsIgnored) {
  Service own;
  own.post("/v1/renders", small_scene(), {{"REMOTE_ADDR", "10.9.8.7"}});
  EXPECT_EQ(Json::parse(own.get("/v1/renders").body).at("renders").size(), 1);
}

}  // namespace
}  // namespace tilelight::service
