// SPDX-License-Identifier: Apache-2.0
#include "server/descriptor_writer.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <climits>
#include <string>

namespace tilelight::server {
namespace {

int64_t now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(steady_clock::now().time_since_epoch()).count();
}

bool is_kind(int fd, mode_t kind) {
  struct stat status {};
  return fstat(fd, &status) == 0 && (status.st_mode & S_IFMT) == kind;
}

bool may_write(int fd) {
  const int flags = fcntl(fd, F_GETFL);
  return flags >= 0 && (flags & O_ACCMODE) != O_RDONLY;
}

// A pipe or a terminal opened anew, so that it can be non-blocking for this object alone. Linux; it may be refused,
// for example where the terminal belongs to another user.
int open_anew(int fd) {
  if (!may_write(fd) || (!is_kind(fd, S_IFIFO) && !is_kind(fd, S_IFCHR))) return -1;
  const std::string path = "/proc/self/fd/" + std::to_string(fd);
  return open(path.c_str(), O_WRONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
}

}  // namespace

DescriptorWriter::DescriptorWriter(int fd)
    : fd_(fd),
      nonblocking_fd_(open_anew(fd)),
      may_write_(may_write(fd)),
      is_socket_(is_kind(fd, S_IFSOCK)),
      wake_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

DescriptorWriter::~DescriptorWriter() {
  if (nonblocking_fd_ >= 0) close(nonblocking_fd_);
  if (wake_ >= 0) close(wake_);
}

void DescriptorWriter::limit_wait_ms(double ms) {
  deadline_ms_.store(now_ms() + static_cast<int64_t>(ms), std::memory_order_release);
  if (wake_ >= 0) eventfd_write(wake_, 1);
}

bool DescriptorWriter::wait_writable() {
  for (;;) {
    const int64_t deadline_ms = deadline_ms_.load(std::memory_order_acquire);
    const int64_t left_ms = deadline_ms == kNever ? -1 : std::max<int64_t>(0, deadline_ms - now_ms());
    // The event stays set, so it is asked only until there is a limit.
    pollfd asked[] = {{nonblocking_fd_ >= 0 ? nonblocking_fd_ : fd_, POLLOUT, 0}, {wake_, POLLIN, 0}};
    const int found = poll(asked, deadline_ms == kNever ? 2 : 1, static_cast<int>(std::min<int64_t>(left_ms, INT_MAX)));
    if (found < 0 && errno != EINTR) return false;
    if (found > 0 && asked[0].revents != 0) return true;  // also where there is an error, which writing tells
    if (found == 0) return errno = ETIMEDOUT, false;
  }
}

bool DescriptorWriter::write(std::string_view bytes) {
  if (!may_write_) return errno = EBADF, false;  // poll would wait for ever
  while (!bytes.empty()) {
    if (!wait_writable()) return false;
    // Where the descriptor blocks, this much fits at once once poll says that something does.
    const size_t size = std::min<size_t>(bytes.size(), PIPE_BUF);
    const ssize_t written = is_socket_ ? send(fd_, bytes.data(), size, MSG_DONTWAIT | MSG_NOSIGNAL)
                                       : ::write(nonblocking_fd_ >= 0 ? nonblocking_fd_ : fd_, bytes.data(), size);
    if (written >= 0) {
      bytes.remove_prefix(static_cast<size_t>(written));
    } else if (errno != EAGAIN && errno != EINTR) {
      return false;
    }
  }
  return true;
}

}  // namespace tilelight::server
