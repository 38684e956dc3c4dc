// SPDX-License-Identifier: Apache-2.0
#include "server/jobs/jobs.h"

#include <algorithm>

#include "server/random_id.h"

namespace tilelight::server {

std::shared_ptr<Jobs> Jobs::make(std::unique_ptr<JobStore> store, const Clock& clock, Options options) {
  return std::shared_ptr<Jobs>(new Jobs(std::move(store), clock, options));
}

Result<JobRecord> Jobs::keep(WorkLease lease, const std::string& client, ImageFormat format) {
  const WorkPtr work = lease.work();
  const RenderRequest& request = work->request();
  work->keep_film();
  JobRecord record;
  record.id = random_id();
  record.client = client;
  record.scene_id = request.scene->parsed.scene_id;
  if (request.refines) record.refines = request.refines->job_id;
  record.exposure = request.view.image.exposure;
  record.priority = request.priority;
  record.format = format;  // not request.format: identical renders share work whatever their formats
  record.warnings = request.warnings;
  record.status = work->status();
  if (!store_->put(record)) return fail("store_refused", "the record of the render could not be kept");
  {
    const std::lock_guard lock(mutex_);
    held_[record.id] = std::move(lease);
  }
  work->watch([weak = weak_from_this(), id = record.id] {
    if (const auto self = weak.lock()) self->note_change(id);
  });
  note_change(record.id);  // it may have changed before anybody watched
  return find(record.id).value_or(record);
}

WorkPtr Jobs::work(const std::string& id) const {
  const std::lock_guard lock(mutex_);
  const auto held = held_.find(id);
  return held == held_.end() ? nullptr : held->second.work();
}

void Jobs::refresh(JobRecord& record) const {
  if (const WorkPtr work = this->work(record.id)) record.status = work->status();
}

std::optional<JobRecord> Jobs::find(const std::string& id) const {
  auto record = store_->find(id);
  if (record) refresh(*record);
  return record;
}

std::vector<JobRecord> Jobs::list(const JobFilter& filter) const {
  auto records = store_->list(filter);
  for (JobRecord& record : records) refresh(record);
  return records;
}

bool Jobs::forget(const std::string& id) {
  WorkLease lease;  // released after the lock: that may end the work, which calls back
  {
    const std::lock_guard lock(mutex_);
    if (const auto held = held_.find(id); held != held_.end()) {
      lease = std::move(held->second);
      held_.erase(held);
    }
    ended_.erase(std::remove(ended_.begin(), ended_.end(), id), ended_.end());
  }
  return store_->erase(id);
}

void Jobs::note_change(const std::string& id) {
  auto record = store_->find(id);
  if (!record) return;
  refresh(*record);
  store_->update(*record);
  if (!is_final(record->status.state)) return;
  {
    const std::lock_guard lock(mutex_);
    if (held_.count(id) == 0 || std::find(ended_.begin(), ended_.end(), id) != ended_.end()) return;
    ended_.push_back(id);
  }
  if (const WorkPtr work = this->work(id)) films_.add(work);
  drop_oldest_results();
}

void Jobs::drop_oldest_results() {
  std::vector<std::pair<std::string, WorkPtr>> kept;  // oldest first
  {
    const std::lock_guard lock(mutex_);
    for (const std::string& id : ended_) kept.emplace_back(id, held_.at(id).work());
  }
  int64_t bytes = 0;
  for (const auto& [id, work] : kept) bytes += work->result_bytes();
  // The linear image weighs ten times the encoded one and serves only who asks for another format: it goes first.
  for (const auto& [id, work] : kept) {
    if (bytes <= options_.max_result_bytes) break;
    bytes -= work->result_bytes();
    work->drop_image();
    bytes += work->result_bytes();
  }
  size_t expired = 0;
  for (; expired + 1 < kept.size(); ++expired) {
    const bool too_many = kept.size() - expired > static_cast<size_t>(options_.max_results);
    if (!too_many && bytes <= options_.max_result_bytes) break;
    bytes -= kept[expired].second->result_bytes();
  }
  for (size_t i = 0; i < expired; ++i) {
    const std::string& id = kept[i].first;
    if (auto record = store_->find(id)) {
      record->status = kept[i].second->status();
      record->result_expired = true;
      store_->update(*record);
    }
    WorkLease lease;  // declared before the lock, so released after it
    const std::lock_guard lock(mutex_);
    ended_.erase(std::remove(ended_.begin(), ended_.end(), id), ended_.end());
    if (const auto held = held_.find(id); held != held_.end()) {
      lease = std::move(held->second);
      held_.erase(held);
    }
  }
}

}  // namespace tilelight::server
