// SPDX-License-Identifier: Apache-2.0
// Jobs and idempotency keys by themselves.
#include "server/jobs/jobs.h"
#include "server/jobs/idempotency.h"
#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

class RefusingStore final : public server::JobStore {
 public:
  bool put(server::JobRecord&) override { return false; }
  void update(const server::JobRecord&) override {}
  std::optional<server::JobRecord> find(const std::string&) const override { return std::nullopt; }
  bool erase(const std::string&) override { return false; }
  std::vector<server::JobRecord> list(const server::JobFilter&) const override { return {}; }
  int64_t count() const override { return 0; }
};

TEST(Jobs, WhoseRecordIsRefusedAreNoJobsAndTheirWorkStops) {
  const HandClock clock;
  const server::Log log("off", false);
  server::Metrics metrics;
  TilePool pool(1);
  const auto compiled = server::CompiledCache::make(pool, metrics, 1 << 20);
  const auto queue = server::JobQueue::make(pool, compiled, metrics, log, clock, {});
  const auto jobs = server::Jobs::make(std::make_unique<RefusingStore>(), clock, {});
  auto scene = std::make_shared<server::StoredScene>();
  scene->parsed = parse_scene(endless_scene(), Limits{}).value();
  auto lease = queue->submit({scene, scene->parsed.view, ImageFormat::png, Priority::batch, {}, 0.0});
  ASSERT_TRUE(lease);
  const server::WorkPtr work = lease->work();
  const auto kept = jobs->keep(std::move(*lease), "client", ImageFormat::png);
  ASSERT_FALSE(kept);
  EXPECT_EQ(kept.error().code, "store_refused");
  EXPECT_TRUE(work->wait_end({}, server::after_ms(30'000.0)));
  EXPECT_EQ(work->state(), server::JobState::cancelled);
  queue->drain(0.0);
}

TEST(RenderWork, KeepsTheLinesOfADrawingBesideItsImageCountsThemAndDropsThemWithIt) {
  const HandClock clock;
  const server::Log log("off", false);
  server::Metrics metrics;
  TilePool pool(1);
  const auto compiled = server::CompiledCache::make(pool, metrics, 1 << 20);
  const auto queue = server::JobQueue::make(pool, compiled, metrics, log, clock, {});
  auto scene = std::make_shared<server::StoredScene>();
  scene->parsed = parse_scene(line_scene(), Limits{}).value();
  const auto lease = queue->submit({scene, scene->parsed.view, ImageFormat::png, Priority::batch, {}, 0.0});
  ASSERT_TRUE(lease);
  const server::WorkPtr work = lease->work();
  ASSERT_TRUE(work->wait_end({}, server::after_ms(30'000.0)));
  const int64_t line_bytes = static_cast<int64_t>(work->lines_svg().size());
  EXPECT_GT(line_bytes, 0);
  const int64_t before = work->result_bytes();
  work->drop_image();
  EXPECT_EQ(before - work->result_bytes(), 48 * 32 * (3 + 1) * 4 + line_bytes) << "colours, errors and lines";
  EXPECT_EQ(work->lines_svg(), "");
  EXPECT_EQ(work->encoded(ImageFormat::svg, pool).error().code, "expired");
  EXPECT_TRUE(work->encoded(ImageFormat::png, pool)) << "encoded before";
  queue->drain(0.0);
}

TEST(IdempotencyKeys, OfTriesThatOverlapHoldTheFirstJob) {
  const HandClock clock;
  server::IdempotencyKeys keys(clock);
  const auto first = keys.claim("client", "key", "body"), second = keys.claim("client", "key", "body");
  EXPECT_EQ(keys.bind(second, "b"), "b");
  EXPECT_EQ(keys.bind(first, "a"), "b");
  keys.release(first);  // a try that fails takes nothing from the one that did not
  EXPECT_EQ(keys.claim("client", "key", "body").job_id, "b");
  EXPECT_TRUE(keys.claim("client", "key", "other").is_other_body);
  EXPECT_TRUE(keys.claim("another", "key", "other").job_id.empty());
}

TEST(IdempotencyKeys, OfAFailedTryAreFreeAndOneThatOverlappedStillBinds) {
  const HandClock clock;
  server::IdempotencyKeys keys(clock);
  const auto failed = keys.claim("client", "key", "body"), retry = keys.claim("client", "key", "body");
  keys.release(failed);
  EXPECT_EQ(keys.bind(retry, "b"), "b");
  EXPECT_EQ(keys.claim("client", "key", "body").job_id, "b");
}

}  // namespace
}  // namespace tilelight::service
