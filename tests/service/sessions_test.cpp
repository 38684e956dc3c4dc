// SPDX-License-Identifier: Apache-2.0
// Sessions: the newest view wins, frames are numbered, and nobody's session stays for ever.
#include <thread>

#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

using SessionsOfService = ServiceTest;

std::string open_session(const Service& service, const std::string& scene) {
  const auto answer = service.post("/v1/sessions", scene);
  EXPECT_EQ(answer.status, 201) << answer.body;
  return answer.header("location");
}

HttpAnswer put_view(const Service& service, const std::string& session, const std::string& view) {
  return ask_json(service.port(), "PUT", session + "/view", view);
}

// The final frame of a view: asks for frame after frame.
HttpAnswer final_frame(const Service& service, const std::string& session, const std::string& view_seq) {
  std::string after = "0";
  for (;;) {
    const auto frame = service.get(session + "/frame?after=" + after);
    if (frame.status != 200) return frame;
    if (frame.header("view-seq") == view_seq && frame.header("frame-final") == "?1") return frame;
    after = frame.header("frame-seq");
  }
}

TEST_F(SessionsOfService, OpeningOneTellsTheCameraAndStartsTheFirstView) {
  const auto answer = service_->post("/v1/sessions", small_scene());
  ASSERT_EQ(answer.status, 201) << answer.body;
  const Json session = Json::parse(answer.body);
  EXPECT_EQ(answer.header("location"), "/v1/sessions/" + session.at("id").get<std::string>());
  EXPECT_EQ(session.at("view_seq"), 0);
  EXPECT_EQ(session.at("image").at("width"), 48);
  EXPECT_EQ(session.at("camera").at("position").size(), 3);
  EXPECT_EQ(session.at("bounds").at("min").size(), 3);
  const auto frame = final_frame(*service_, answer.header("location"), "0");
  EXPECT_EQ(frame.status, 200);
  EXPECT_EQ(png_size(frame.body), std::pair(48, 32));
  EXPECT_NE(frame.header("render-info").find("spp=2"), std::string::npos);
}

TEST_F(SessionsOfService, AnUnmovedSessionShowsThePictureOfTheScene) {
  const std::string session = open_session(*service_, small_scene(9));
  const auto picture = service_->post("/v1/renders", small_scene(9), {{"Accept", "image/png"}});
  EXPECT_EQ(final_frame(*service_, session, "0").body, picture.body);
}

TEST_F(SessionsOfService, TheNewestViewWinsAndCancelsTheOlder) {
  const std::string session = open_session(*service_, small_scene());
  const std::string endless = R"("image": {"width": 2048, "height": 2048}, "render": {"samples": 4096})";
  EXPECT_EQ(put_view(*service_, session, R"({"seq": 1, )" + endless + "}").status, 204);
  EXPECT_EQ(put_view(*service_, session, R"({"seq": 3, "camera": {"fov_y_deg": 20}})").status, 204);
  EXPECT_EQ(put_view(*service_, session, R"({"seq": 2, )" + endless + "}").status, 204) << "older: ignored";
  const auto frame = final_frame(*service_, session, "3");
  EXPECT_EQ(frame.status, 200);
  EXPECT_EQ(png_size(frame.body), std::pair(48, 32)) << "merged over the scene, not over the view before";
}

TEST_F(SessionsOfService, WhileMovingOneSampleAPixelIsEnough) {
  const std::string session = open_session(*service_, small_scene());
  put_view(*service_, session, R"({"seq": 1, "moving": true})");
  EXPECT_NE(final_frame(*service_, session, "1").header("render-info").find("spp=1,"), std::string::npos);
  put_view(*service_, session, R"({"seq": 2, "moving": false})");
  EXPECT_NE(final_frame(*service_, session, "2").header("render-info").find("spp=2,"), std::string::npos);
}

TEST_F(SessionsOfService, AFrameThatIsNotThereYetIsWaitedForOr204) {
  const std::string session = open_session(*service_, small_scene());
  const std::string last = final_frame(*service_, session, "0").header("frame-seq");
  EXPECT_EQ(service_->get(session + "/frame?after=" + last, {{"Prefer", "wait=0"}}).status, 204);
  HttpAnswer next;
  std::thread waiter([&] { next = service_->get(session + "/frame?after=" + last); });
  put_view(*service_, session, R"({"seq": 1})");
  waiter.join();
  EXPECT_EQ(next.status, 200);
  EXPECT_GT(std::stoi(next.header("frame-seq")), std::stoi(last));
}

TEST_F(SessionsOfService, ClosingOneAnswersWhoWaitsInIt) {
  const std::string session = open_session(*service_, small_scene());
  const std::string last = final_frame(*service_, session, "0").header("frame-seq");
  HttpClient waiter(service_->port());
  waiter.write("GET " + session + "/frame?after=" + last + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  ASSERT_TRUE(service_->metric_reaches("tilelight_requests_waiting", 1));
  ask(service_->port(), "DELETE", session);
  EXPECT_EQ(waiter.read().status, 410);
  EXPECT_EQ(service_->get(session + "/frame").status, 404);
}

TEST_F(SessionsOfService, AnIdleSessionEndsAfterFiveMinutes) {
  Service own;
  const std::string used = open_session(own, small_scene()), idle = open_session(own, small_scene());
  own.clock().advance_ms(4 * 60'000.0);
  EXPECT_EQ(own.get(used + "/frame").status, 200);
  own.clock().advance_ms(2 * 60'000.0);
  EXPECT_EQ(own.get(idle + "/frame").status, 404);
  EXPECT_EQ(own.get(used + "/frame").status, 200);
}

TEST_F(SessionsOfService, TheirNumberIsLimited) {
  server::Config config;
  config.max_sessions = 2;
  Service own(config);
  open_session(own, small_scene());
  open_session(own, small_scene());
  const auto third = own.post("/v1/sessions", small_scene());
  EXPECT_EQ(third.status, 503);
  EXPECT_FALSE(third.header("retry-after").empty());
}

TEST_F(SessionsOfService, TheirPixelsAreLimitedTogether) {
  TilePool pool(1);
  const HandClock clock;
  server::Sessions sessions(pool, clock, 4);
  const ParsedScene parsed = parse_scene(small_scene(), Limits{}).value();
  const auto compiled = compile_scene(parsed.scene, pool);
  const std::string one = (*sessions.open(compiled, parsed.view))->id();
  const std::string two = (*sessions.open(compiled, parsed.view))->id();
  EXPECT_TRUE(sessions.reserve(one, 2, {8000, 8000, 0.0}));
  EXPECT_FALSE(sessions.reserve(two, 1, {4000, 4000, 0.0}));
  EXPECT_TRUE(sessions.reserve(one, 1, {640, 480, 0.0})) << "older: ignored";
  EXPECT_FALSE(sessions.reserve(two, 1, {4000, 4000, 0.0})) << "and gives nothing back";
  EXPECT_TRUE(sessions.reserve(one, 3, {640, 480, 0.0}));
  EXPECT_TRUE(sessions.reserve(two, 1, {4000, 4000, 0.0})) << "what one gave back";
}

// A server with one thread, which a session without end keeps for itself.
class BusyService : public Service {
 public:
  static server::Config config() {
    server::Config config;
    config.threads = 1;
    return config;
  }
  BusyService() : Service(config()) {}
  void keep_busy() const { open_session(*this, endless_scene()); }
};

TEST_F(SessionsOfService, KeepNobodyFromAnAnswerThatNeedsNoRendering) {
  BusyService own;
  const std::string job = own.post("/v1/renders", small_scene()).header("location");
  own.wait_for_end(job);
  own.keep_busy();
  EXPECT_EQ(own.post("/v1/scenes", small_scene() + std::string(100 << 10, ' ')).status, 201)
      << "a large body's parsing";
  EXPECT_EQ(own.get(job + "/image", {{"Accept", "image/jpeg"}}).status, 200) << "another format";
}

TEST_F(SessionsOfService, AClientThatLeavesBeforeItsSceneIsCompiledIsNoErrorOfTheServer) {
  BusyService own;
  const std::string scene = small_scene(), job = own.post("/v1/renders", scene).header("location");
  own.wait_for_end(job);
  own.keep_busy();
  {
    HttpClient client(own.port());
    const std::string other = R"({"objects": [{"type": "sphere", "radius": 3}]})";
    client.write("POST /v1/plan HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: " +
                 std::to_string(other.size()) + "\r\n\r\n" + other);
    ASSERT_TRUE(own.metric_reaches("tilelight_requests_waiting", 1));
  }
  EXPECT_TRUE(own.metric_reaches("tilelight_http_requests_total{route=\"/v1/plan\",status=\"408\"}", 1));
}

// A render that has failed, or still runs, before its first pass.
class BlankRender final : public Render {
 public:
  explicit BlankRender(RenderState state) : state_(state) {}
  void cancel() override {}
  RenderProgress progress() const override {
    RenderProgress progress;
    progress.state = state_;
    if (state_ == RenderState::failed) progress.error = "a tile broke";
    return progress;
  }
  RenderReport report() const override { return {}; }
  std::shared_ptr<const std::vector<float>> error_bounds() const override { return nullptr; }
  std::shared_ptr<const ExposedFilm> exposed_film() const override { return nullptr; }
  std::shared_ptr<const Image> image() const override { return nullptr; }
  std::string lines_svg() const override { return {}; }
  bool wait_ms(double) const override { return true; }

 private:
  const RenderState state_;
};

class FailingSession final : public server::Session {
 public:
  using Session::Session;
  RenderState state = RenderState::failed;
  bool throws = false;

 private:
  std::shared_ptr<Render> start_render(const View&, RenderOptions) override {
    if (throws) throw std::bad_alloc();
    return std::make_shared<BlankRender>(state);
  }
};

TEST_F(SessionsOfService, WhoWaitsForAFrameOfARenderThatFailsIsToldSo) {
  TilePool pool(1);
  const auto session = std::make_shared<FailingSession>("id", pool, nullptr, View{});
  ASSERT_TRUE(session->set_view(1, View{}, false));
  const auto failed = session->wait_frame(0, {}, server::after_ms(0.0));
  ASSERT_TRUE(failed);
  EXPECT_EQ(failed->image, nullptr);
  EXPECT_EQ(failed->error, "a tile broke");
  session->throws = true;
  ASSERT_TRUE(session->set_view(2, View{}, false));
  const auto thrown = session->wait_frame(failed->seq, {}, server::after_ms(0.0));
  ASSERT_TRUE(thrown);
  EXPECT_EQ(thrown->view_seq, 2);
  EXPECT_FALSE(thrown->error.empty());
}

TEST_F(SessionsOfService, AFailureIsNotToldOnceAnotherViewWasSent) {
  TilePool pool(1);
  const auto session = std::make_shared<FailingSession>("id", pool, nullptr, View{});
  ASSERT_TRUE(session->set_view(1, View{}, false));
  session->state = RenderState::running;
  ASSERT_TRUE(session->set_view(2, View{}, false));
  EXPECT_FALSE(session->wait_frame(0, {}, server::after_ms(0.0)));
}

TEST_F(SessionsOfService, AFrameTellsWhichWaitWasGrantedToTheMillisecond) {
  const std::string frame = open_session(*service_, small_scene()) + "/frame?after=";
  EXPECT_EQ(service_->get(frame + "0", {{"Prefer", "wait=600"}}).header("preference-applied"), "wait=40");
  const auto none = service_->get(frame + "1000", {{"Prefer", "wait=0.05"}});
  EXPECT_EQ(none.status, 204);
  EXPECT_EQ(none.header("preference-applied"), "wait=0.05");
}

TEST_F(SessionsOfService, ABadViewIs422AndChangesNothing) {
  const std::string session = open_session(*service_, small_scene());
  EXPECT_EQ(put_view(*service_, session, R"({"camera": {}})").status, 422) << "no seq";
  EXPECT_EQ(put_view(*service_, session, R"({"seq": 1.5})").status, 422);
  EXPECT_EQ(put_view(*service_, session, R"({"seq": 1, "camera": {"fov_y_deg": 200}})").status, 422);
  EXPECT_EQ(put_view(*service_, session, R"({"seq": 1, "objects": []})").status, 422);
  EXPECT_EQ(put_view(*service_, session, R"({"seq": 1,)").status, 400);
  EXPECT_EQ(final_frame(*service_, session, "0").status, 200);
}

}  // namespace
}  // namespace tilelight::service
