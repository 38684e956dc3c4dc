// SPDX-License-Identifier: Apache-2.0
// Clients that end their sending and wait, and clients that leave: the first are answered, and the work of the others
// is cancelled.
#include <condition_variable>
#include <mutex>

#include "server/http/front.h"
#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

const std::string kGet = "GET /v1/limits HTTP/1.1\r\nHost: localhost\r\n\r\n";

// A front whose answers come when the test lets them, unless the client leaves before.
class HeldFront {
 public:
  explicit HeldFront(double probe_ms) {
    server::FrontOptions options;
    options.workers = 2;
    options.probe_ms = probe_ms;
    const auto serve = [this](server::Exchange& exchange) {
      std::unique_lock lock(mutex_);
      const auto until = server::after_ms(60'000.0);
      ++begun_;
      changed_.notify_all();
      changed_.wait_until(lock, exchange.gone.get_token(), until, [&] { return is_released_; });
      left_ += exchange.gone.stop_requested();
      changed_.notify_all();
      return server::Served{kAnswer};
    };
    const auto refuse = [](const server::Problem&, const std::string&, bool) { return server::Served{}; };
    front_ = std::move(*server::Front::bind(std::move(options), serve, refuse));
    front_->start();
  }
  ~HeldFront() { release(); }

  static inline const std::string kAnswer = "HTTP/1.1 200 OK\r\nContent-Length: 3\r\n\r\nyes";

  // A client whose request a worker has.
  std::unique_ptr<HttpClient> client() {
    auto client = std::make_unique<HttpClient>(front_->port());
    client->write(kGet);
    ++expected_;
    EXPECT_TRUE(wait_for([&] { return begun_ == expected_; }));
    return client;
  }
  void release() {
    const std::lock_guard lock(mutex_);
    is_released_ = true;
    changed_.notify_all();
  }
  bool sees_the_client_leave() {
    return wait_for([&] { return left_ == 1; });
  }

 private:
  template <class Condition>
  bool wait_for(Condition condition) {
    std::unique_lock lock(mutex_);
    return changed_.wait_until(lock, server::after_ms(30'000.0), condition);
  }

  std::mutex mutex_;
  std::condition_variable_any changed_;
  bool is_released_ = false;
  int expected_ = 0, begun_ = 0, left_ = 0;
  std::unique_ptr<server::Front> front_;  // last: its threads use the others
};

constexpr double kAtOnceMs = 1.0, kNeverMs = 1e12;

TEST(HalfClose, TheFirstBytesOfTheAnswerGoAheadAndTheRestFollows) {
  HeldFront front(kAtOnceMs);
  const auto client = front.client();
  client->shut_down_sending();
  const std::string ahead = client->take(2);  // what tells a client that waits from one that has left
  EXPECT_EQ(ahead, "HT");
  front.release();
  EXPECT_EQ(ahead + client->take(1'000), HeldFront::kAnswer) << "and the connection ends";
}

TEST(HalfClose, AnAnswerThatComesSoonComesWhole) {
  HeldFront front(kNeverMs);
  const auto client = front.client();
  client->shut_down_sending();
  front.release();
  EXPECT_EQ(client->take(1'000), HeldFront::kAnswer);
}

TEST(HalfClose, AClientThatClosesItsConnectionIsNoticed) {
  HeldFront front(kAtOnceMs);
  front.client().reset();
  EXPECT_TRUE(front.sees_the_client_leave());
}

TEST(HalfClose, AClientThatLeavesAfterItsHalfCloseIsNoticed) {
  HeldFront front(kAtOnceMs);
  auto client = front.client();
  client->shut_down_sending();
  EXPECT_EQ(client->take(1), "H");
  client.reset();
  EXPECT_TRUE(front.sees_the_client_leave());
}

TEST(HalfClose, AResetIsNoticedWithoutAProbe) {
  HeldFront front(kNeverMs);
  front.client()->abort_connection();
  EXPECT_TRUE(front.sees_the_client_leave());
}

TEST(HalfClose, AClientThatOnlyWaitsIsSentNothingAhead) {
  HeldFront front(kAtOnceMs);
  const auto waiting = front.client(), closed = front.client();
  closed->shut_down_sending();
  EXPECT_EQ(closed->take(2), "HT") << "all connections have been looked at twice";
  EXPECT_FALSE(waiting->has_bytes());
}

using HalfCloseOfService = ServiceTest;

// All that comes for these bytes after the sending side was shut down.
std::string answers_to(int port, const std::string& bytes) {
  HttpClient client(port);
  client.write(bytes);
  client.shut_down_sending();
  return client.take(64 << 20);
}

int count(const std::string& text, std::string_view part) {
  int found = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

std::string post_of(const std::string& path, const std::string& body, const std::string& fields = "") {
  return "POST " + path + " HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n" + fields +
         "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}

TEST_F(HalfCloseOfService, EveryPipelinedRequestIsAnsweredAndThenTheConnectionEnds) {
  std::string many;
  for (int i = 0; i < 200; ++i) many += kGet;  // more than is read at a time
  const std::string text = answers_to(service_->port(), many + std::string(90'000, 'x').insert(0, "GET /"));
  EXPECT_EQ(count(text, "HTTP/1.1 200 OK\r\n"), 200);
  EXPECT_EQ(count(text, "HTTP/1.1 414 "), 1) << "what is no request is refused in its turn";
}

TEST_F(HalfCloseOfService, AnAnswerThatClosesIsNotLostOverWhatFollowsIt) {
  std::string rest;
  for (int i = 0; i < 4'000; ++i) rest += kGet;  // stays unread
  const std::string text =
      answers_to(service_->port(), "GET /openapi.json HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n" + rest);
  EXPECT_EQ(count(text, "HTTP/1.1 "), 1);
  EXPECT_EQ(text.back(), '}') << "to its last byte";
}

TEST_F(HalfCloseOfService, APictureAndALongPollAreAnswered) {
  const std::string picture =
      answers_to(service_->port(), post_of("/v1/renders", small_scene(40), "Accept: image/png\r\n"));
  EXPECT_EQ(picture.rfind("HTTP/1.1 200 OK\r\n", 0), 0u) << picture.substr(0, 200);
  EXPECT_NE(picture.find("IEND"), std::string::npos);
  const std::string location = service_->post("/v1/renders", small_scene(41)).header("location");
  const std::string polled =
      answers_to(service_->port(), "GET " + location + " HTTP/1.1\r\nHost: localhost\r\nPrefer: wait=20\r\n\r\n");
  EXPECT_EQ(polled.rfind("HTTP/1.1 200 OK\r\n", 0), 0u) << polled.substr(0, 200);
}

TEST_F(HalfCloseOfService, AStreamOfEventsGoesOnToItsEnd) {
  const std::string location = service_->post("/v1/renders", endless_scene(42)).header("location");
  for (const char* version : {"1.1", "1.0"}) {
    HttpClient client(service_->port());
    client.write("GET " + location + "/events HTTP/" + version + "\r\nHost: localhost\r\n\r\n");
    client.shut_down_sending();
    EXPECT_NE(client.take_through("event: progress").find("event: progress"), std::string::npos);
    service_->clock().advance_ms(1'000.0);
    EXPECT_NE(client.take_through("event: progress").find("event: progress"), std::string::npos) << "and still";
    if (version == std::string("1.0")) {
      ask(service_->port(), "DELETE", location);
      EXPECT_NE(client.take(1 << 20).find("event: done"), std::string::npos);
    }
  }
}

TEST_F(HalfCloseOfService, ARequestThatCanNoLongerBecomeCompleteIsRefused) {
  for (const char* part : {"GET /v1/limits HTTP/1.1\r\nHost: loc", "G",
                           "POST /v1/plan HTTP/1.1\r\nHost: a\r\nContent-Length: 9\r\n\r\n{}"}) {
    EXPECT_EQ(answers_to(service_->port(), part).rfind("HTTP/1.1 400 ", 0), 0u) << part;
  }
  EXPECT_EQ(answers_to(service_->port(), ""), "");
  EXPECT_EQ(answers_to(service_->port(), "\r\n"), "") << "an empty line is no request";
}

}  // namespace
}  // namespace tilelight::service
