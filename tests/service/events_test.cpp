// SPDX-License-Identifier: Apache-2.0
// Server-Sent Events of renders, over real sockets and by themselves.
#include "server/http/event_stream.h"

#include <thread>

#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

struct Event {
  std::string name, id;
  Json data;
};

// By the rules of the standard, as far as they are used.
std::vector<Event> read_events(const std::string& text) {
  std::vector<Event> out;
  Event event;
  size_t at = 0;
  for (size_t end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = text.substr(at, end - at);
    if (line.empty() && !event.name.empty()) out.push_back(std::exchange(event, {}));
    if (line.rfind("event: ", 0) == 0) event.name = line.substr(7);
    if (line.rfind("id: ", 0) == 0) event.id = line.substr(4);
    if (line.rfind("data: ", 0) == 0) event.data = Json::parse(line.substr(6));
  }
  return out;
}

std::vector<std::string> names_of(const std::vector<Event>& events) {
  std::vector<std::string> out;
  for (const Event& event : events) out.push_back(event.name + (event.id.empty() ? "" : " " + event.id));
  return out;
}

using Names = std::vector<std::string>;

// A stream as it is read from its socket, chunk by chunk.
class OpenStream {
 public:
  OpenStream(const Service& service, const std::string& path) : client_(service.port()) {
    client_.write("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
    head_ = client_.take_through("\r\n\r\n");
  }
  const std::string& head() const { return head_; }
  // The next chunk; empty at the end.
  std::string chunk() {
    const std::string bytes = client_.take(std::stoul(client_.take_through("\r\n"), nullptr, 16));
    EXPECT_EQ(client_.take(2), "\r\n");
    return bytes;
  }
  std::string rest() {
    std::string out;
    for (std::string piece; !(piece = chunk()).empty();) out += piece;
    return out;
  }
  HttpClient& client() { return client_; }

 private:
  HttpClient client_;
  std::string head_;
};

using Events = ServiceTest;

TEST_F(Events, OfADoneRenderAreItsPointsAndItsEnd) {
  const std::string location = service_->post("/v1/renders", small_scene(1)).header("location");
  const Json job = service_->wait_for_end(location);
  const HttpAnswer answer = service_->get(location + "/events");
  ASSERT_EQ(answer.status, 200);
  EXPECT_EQ(answer.header("content-type"), "text/event-stream");
  const auto events = read_events(answer.body);
  EXPECT_EQ(names_of(events), (Names{"state", "point 1", "point 2", "done end"}));
  EXPECT_EQ(events[1].data, job.at("report").at("points").at(0));
  EXPECT_EQ(events[3].data.at("state"), "done");
  EXPECT_EQ(events[3].data.at("stop"), "samples");
  // Who comes again gets what it has missed, and after the end nothing more.
  EXPECT_EQ(names_of(read_events(service_->get(location + "/events", {{"Last-Event-ID", "1"}}).body)),
            (Names{"state", "point 2", "done end"}));
  EXPECT_EQ(service_->get(location + "/events", {{"Last-Event-ID", "end"}}).status, 204);
  EXPECT_EQ(service_->get(location + "/events", {{"Accept", "application/json"}}).status, 406);
  EXPECT_EQ(service_->get("/v1/renders/none/events").status, 404);
}

TEST_F(Events, ComeAsTheyHappenAndTheConnectionLivesOn) {
  Service own;
  const std::string location = own.post("/v1/renders", endless_scene()).header("location");
  OpenStream stream(own, location + "/events");
  EXPECT_NE(stream.head().find("Transfer-Encoding: chunked\r\n"), std::string::npos) << stream.head();
  EXPECT_EQ(stream.head().find("Content-Length"), std::string::npos);
  EXPECT_TRUE(own.metric_reaches("tilelight_event_streams", 1));
  std::string text;
  while (text.find("event: progress") == std::string::npos) text += stream.chunk();
  ask(own.port(), "DELETE", location);
  text += stream.rest();
  const auto events = read_events(text);
  ASSERT_GE(events.size(), 3u);
  EXPECT_EQ(events.front().name, "state");
  EXPECT_EQ(events.back().name, "done");
  EXPECT_EQ(events.back().data.at("state"), "cancelled");
  EXPECT_EQ(own.metric("tilelight_event_streams"), 0);
  EXPECT_EQ(stream.client().send("GET", "/v1/limits").status, 200) << "the next request on the same connection";
}

TEST_F(Events, OfManyClientsHoldNoWorkers) {
  server::Config config;
  config.max_waiting = 0;  // 32 workers
  config.max_streams = 64;
  Service own(config);
  const std::string location = own.post("/v1/renders", endless_scene()).header("location");
  std::vector<std::unique_ptr<OpenStream>> streams;
  for (int i = 0; i < 48; ++i) streams.push_back(std::make_unique<OpenStream>(own, location + "/events"));
  for (const auto& stream : streams) EXPECT_NE(stream->head().find(" 200 "), std::string::npos);
  EXPECT_EQ(own.get(location + "/events").status, 429) << "three quarters are one client's share";
  EXPECT_EQ(own.get("/v1/limits").status, 200);
  streams.clear();  // who leaves gives its place back
  const auto until = server::after_ms(30'000.0);
  while (own.metric("tilelight_event_streams") > 0.0 && server::Steady::now() < until) continue;
  for (int i = 0; i < 2; ++i) streams.push_back(std::make_unique<OpenStream>(own, location + "/events"));
  ask(own.port(), "DELETE", location);
  for (const auto& stream : streams) EXPECT_NE(stream->rest().find("event: done"), std::string::npos);
}

TEST_F(Events, OfAnHttp10ClientEndWithTheConnection) {
  Service own;
  const std::string location = own.post("/v1/renders", endless_scene()).header("location");
  HttpClient client(own.port());
  client.write("GET " + location + "/events HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
  std::string text = client.take_through("\r\n\r\nevent: state");
  EXPECT_EQ(text.find("chunked"), std::string::npos);
  ask(own.port(), "DELETE", location);
  text += client.take(1 << 20);
  EXPECT_EQ(text.substr(text.size() - 2), "\n\n");
  EXPECT_NE(text.find("event: done"), std::string::npos);
}

TEST_F(Events, EndWhenTheServerStops) {
  auto own = std::make_unique<Service>();
  const std::string location = own->post("/v1/renders", endless_scene()).header("location");
  OpenStream stream(*own, location + "/events");
  std::thread stop([&] { own->app().stop(); });
  EXPECT_NE(stream.rest().find("\"state\":\"cancelled\""), std::string::npos);
  stop.join();
}

TEST(EventStream, TellsProgressFourTimesASecondAndACommentEvery15Seconds) {
  HandClock clock;
  server::WaitSlots slots(4);
  auto scene = std::make_shared<server::StoredScene>();
  const auto work = std::make_shared<server::RenderWork>(server::RenderRequest{scene, View{}}, "key", 1);
  server::EventStream stream(work, {}, clock, std::move(*slots.take("client")));
  EXPECT_EQ(names_of(read_events(stream.next().value())), (Names{"state"}));
  EXPECT_EQ(stream.next(), "") << "it waits";
  work->set_running(2, 0.0);
  EXPECT_EQ(names_of(read_events(stream.next().value())), (Names{"state", "progress"}));
  clock.advance_ms(249.0);
  EXPECT_EQ(stream.next(), "");
  clock.advance_ms(1.0);
  EXPECT_EQ(names_of(read_events(stream.next().value())), (Names{"progress"}));
  clock.advance_ms(14'750.0);
  const std::string later = stream.next().value();
  EXPECT_EQ(later.substr(later.size() - 3), ":\n\n");
  work->set_ended(server::JobState::done, "", 3);
  EXPECT_EQ(names_of(read_events(stream.next().value())), (Names{"state", "done end"}));
  EXPECT_EQ(stream.next(), std::nullopt);
}

TEST(EventStream, OfAReportOfAnyLengthComesInPieces) {
  server::WorkStatus status;
  status.state = server::JobState::done;
  status.report.points.resize(1024);
  server::EventCursor cursor;
  std::string all;
  for (std::string piece; !(piece = server::next_events(status, cursor)).empty(); all += piece)
    EXPECT_LT(piece.size(), server::kEventBytes + 4096);
  EXPECT_EQ(read_events(all).size(), 1u + 1024 + 1);
}

}  // namespace
}  // namespace tilelight::service
