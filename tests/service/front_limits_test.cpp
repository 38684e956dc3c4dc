// SPDX-License-Identifier: Apache-2.0
// The front by itself, under small budgets: whom it drops when clients send or read slowly.
#include <poll.h>

#include <new>

#include "server/http/front.h"
#include "tests/service/http_client.h"
#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

constexpr size_t kLarge = 32 << 20;  // well over what the kernel takes of a response that nobody reads

std::string answer_of(size_t body_bytes) {
  return "HTTP/1.1 200 OK\r\nContent-Length: " + std::to_string(body_bytes) + "\r\n\r\n" + std::string(body_bytes, 'x');
}

// A front that answers /large with kLarge bytes and everything else with none. is_memory_short: for refusals there is
// none.
class OwnFront {
 public:
  explicit OwnFront(server::FrontOptions options, bool is_memory_short = false) {
    options.workers = 2;
    const auto serve = [](server::Exchange& exchange) {
      const bool is_large = exchange.head.request.path == "/large";
      return server::Served{answer_of(is_large ? kLarge : 0)};
    };
    const auto refuse = [is_memory_short](const server::Problem& problem, const std::string&, bool) {
      if (is_memory_short) throw std::bad_alloc();
      return server::Served{"HTTP/1.1 " + std::to_string(problem.status) + " Refused\r\nContent-Length: 0\r\n\r\n",
                            nullptr, true};
    };
    front_ = std::move(*server::Front::bind(std::move(options), serve, refuse));
    front_->start();
  }
  server::Front* operator->() { return front_.get(); }

  // A client that has sent this and reads nothing yet.
  std::unique_ptr<HttpClient> client(const std::string& bytes) {
    auto client = std::make_unique<HttpClient>(front_->port());
    client->write(bytes);
    return client;
  }

 private:
  std::unique_ptr<server::Front> front_;
};

const std::string kGetLarge = "GET /large HTTP/1.1\r\nHost: a\r\n\r\n";

std::string post(size_t declared, size_t sent) {
  return "POST / HTTP/1.1\r\nHost: a\r\nContent-Length: " + std::to_string(declared) + "\r\n\r\n" +
         std::string(sent, 'x');
}

// Waits until the condition holds; false after half a minute.
template <class Condition>
bool comes_true(Condition condition) {
  const auto until = server::after_ms(30'000.0);
  while (!condition()) {
    if (server::Steady::now() >= until) return false;
  }
  return true;
}

TEST(Front, DropsTheLargestBodyThatStallsAndNotTheNextThatComes) {
  server::FrontOptions options;
  options.max_buffered_bytes = 1 << 20;
  OwnFront front(options);
  const auto largest = front.client(post(900'000, 600'000)), large = front.client(post(900'000, 400'000));
  const auto newcomer = front.client(post(300'000, 200'000));
  EXPECT_EQ(largest->read().status, 503);
  newcomer->write(std::string(100'000, 'x'));
  EXPECT_EQ(newcomer->read().status, 200);
  large->write(std::string(500'000, 'x'));
  EXPECT_EQ(large->read().status, 200);
}

TEST(Front, RefusesALargeResponseRatherThanCutOffClientsThatRead) {
  server::FrontOptions options;
  options.max_unread_bytes = 2 * kLarge + 4096;
  options.brisk_bytes_per_ms = 0.0;  // whoever reads at all is fast enough
  OwnFront front(options);
  const auto one = front.client(kGetLarge), two = front.client(kGetLarge);
  ASSERT_TRUE(comes_true([&] { return front->unread_bytes() > static_cast<int64_t>(2 * kLarge); }));
  EXPECT_EQ(front.client(kGetLarge)->read().status, 503);
  EXPECT_EQ(front.client("GET / HTTP/1.1\r\nHost: a\r\n\r\n")->read().status, 200);
  EXPECT_EQ(one->read().body.size(), kLarge);
  EXPECT_EQ(two->read().body.size(), kLarge);
}

TEST(Front, CutsOffResponsesThatNobodyReadsWhereOthersNeedTheMemory) {
  server::FrontOptions options;
  options.max_unread_bytes = 2 * kLarge + 4096;
  options.brisk_bytes_per_ms = 1e12;
  options.write_timeout_ms = 1e6;  // not what ends them
  OwnFront front(options);
  std::vector<std::unique_ptr<HttpClient>> idle;
  for (int i = 0; i < 6; ++i) {
    idle.push_back(front.client(kGetLarge));
    EXPECT_EQ(idle.back()->skip(1), 1u) << "a response that has begun is older than those that follow";
  }
  EXPECT_EQ(front.client(kGetLarge)->read().body.size(), kLarge);
  EXPECT_TRUE(comes_true([&] { return front->connection_count() <= 2; }));
}

TEST(Front, EndsAResponseThatIsReadTooSlowly) {
  server::FrontOptions options;
  options.write_timeout_ms = 1'000.0;
  options.min_bytes_per_ms = 1e6;
  OwnFront front(options);
  const auto client = front.client(kGetLarge);
  size_t got = 0;
  // A megabyte ten times a second, so no time-out is near: the slowness is what is tested.
  for (size_t some = 1; some > 0; got += some) {
    some = 0;
    while (some < (1 << 20)) {
      const size_t part = client->skip(64 << 10);
      if (part == 0) break;
      some += part;
    }
    poll(nullptr, 0, 100);
  }
  EXPECT_LT(got, kLarge);
}

TEST(Front, WhereMemoryIsShortForOneConnectionItIsClosedAndTheOthersGoOn) {
  server::FrontOptions options;
  options.max_unread_bytes = 1;
  options.max_buffered_bytes = 100'000;
  options.head_timeout_ms = 2'000.0;  // long beside what a whole request takes
  OwnFront front(options, true);
  const std::pair<const char*, std::string> refused[] = {{"no request", "GET / HTTP/2.0\r\n\r\n"},
                                                         {"too large a response", kGetLarge},
                                                         {"too large a body", post(900'000, 200'000)},
                                                         {"a request that stalls", "GET / HT"}};
  for (const auto& [what, bytes] : refused) {
    EXPECT_EQ(front.client(bytes)->read().status, 0) << what;
    EXPECT_EQ(front.client("GET / HTTP/1.1\r\nHost: a\r\n\r\n")->read().status, 200) << "after " << what;
  }
}

}  // namespace
}  // namespace tilelight::service
