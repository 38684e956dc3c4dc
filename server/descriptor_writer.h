// SPDX-License-Identifier: Apache-2.0
// DescriptorWriter: writes to a descriptor that somebody may have stopped reading (a pipe, a terminal), and waits for
// that reader no longer than it may. A leaf. One thread writes; any thread may limit.
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

namespace tilelight::server {

class DescriptorWriter {
 public:
  // The descriptor stays the caller's. Its flags stay as they are too: other processes share them.
  explicit DescriptorWriter(int fd);
  ~DescriptorWriter();
  DescriptorWriter(const DescriptorWriter&) = delete;
  DescriptorWriter& operator=(const DescriptorWriter&) = delete;

  // False, with errno: not all could be written. Waits until the limit, without one for ever.
  bool write(std::string_view bytes);
  // All that is written from now on waits `ms` at most, together; what waits now is told. ETIMEDOUT after that.
  void limit_wait_ms(double ms);

 private:
  bool wait_writable();

  const int fd_;
  const int nonblocking_fd_;  // of the same file; -1 where there is none to be had
  const bool may_write_, is_socket_;
  const int wake_;                             // an eventfd: there is a limit
  std::atomic<int64_t> deadline_ms_ = kNever;  // steady clock; release by limit_wait_ms(), acquire by the writer
  static constexpr int64_t kNever = INT64_MAX;
};

}  // namespace tilelight::server
