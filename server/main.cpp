// SPDX-License-Identifier: Apache-2.0
// tilelightd: the render server. Ends with 0 on SIGTERM and SIGINT, 2 where its configuration is refused, 1 where it
// cannot listen.
#include <malloc.h>
#include <sys/resource.h>

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <exception>

#include "server/app.h"
#include "server/descriptor_writer.h"

namespace tilelight::server {
namespace {

// A connection is a descriptor, and the usual soft limit of 1,024 is older than servers of many connections.
void raise_descriptor_limit() {
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
  limit.rlim_cur = std::max(limit.rlim_cur, std::min<rlim_t>(limit.rlim_max, 16'384));
  setrlimit(RLIMIT_NOFILE, &limit);
}

// Renders of small pictures take and give back the same few megabytes again and again. Pages that went back to the
// system in between would have to be made anew, one by one, which takes longer than to fill them.
void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 4 << 20);
  mallopt(M_TRIM_THRESHOLD, 32 << 20);
#endif
}

// False, with errno: it could not be written, or nobody has read it for seconds.
bool write_text(int descriptor, const std::string& text) {
  constexpr double kPatienceMs = 5'000.0;
  DescriptorWriter writer(descriptor);
  writer.limit_wait_ms(kPatienceMs);
  return writer.write(text);
}

int exit_with_error(int code, const std::string& what) {
  write_text(STDERR_FILENO, printable_lines("tilelightd: " + what) + "\n");
  return code;
}

int run(int argc, const char* const* argv) {
  hold_standard_streams();
  // Blocked in all threads; sigwait below takes them. Before any thread exists.
  sigset_t ending;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  sigaddset(&ending, SIGINT);
  pthread_sigmask(SIG_BLOCK, &ending, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a log may reach the limit of a file's size: the write fails, and is counted
  raise_descriptor_limit();
  keep_freed_memory();

  const auto request = load_config(argc, argv, process_environment());
  if (!request) return exit_with_error(2, request.error().detail);
  if (request->help_or_version) {
    if (write_text(STDOUT_FILENO, request->text)) return 0;
    return exit_with_error(1, std::string("cannot write standard output: ") + std::strerror(errno));
  }
  const SystemClock clock;
  auto app = App::open(request->config, clock);
  if (!app) return exit_with_error(1, app.error().detail);
  (*app)->start();
  const Log& log = (*app)->log();
  const Config& config = request->config;
  if (config.allow_open) {
    log.write(LogLevel::warn, "open",
              {{"host", config.host}, {"detail", "whoever reaches this address may render: there are no keys"}});
  }
  const std::string url = (*app)->url(), admin_url = (*app)->admin_url();
  if (!write_text(STDOUT_FILENO, "Tilelight is at " + url + "\nHealth and metrics are at " + admin_url + "metrics\n")) {
    log.write(LogLevel::warn, "unannounced",
              {{"url", url}, {"admin", admin_url}, {"cause", std::string("standard output: ") + std::strerror(errno)}});
  }

  int signal = 0;
  sigwait(&ending, &signal);
  log.write(LogLevel::info, "stopping", {{"signal", int64_t{signal}}});
  (*app)->stop();
  return 0;
}

}  // namespace
}  // namespace tilelight::server

int main(int argc, char** argv) {
  using namespace tilelight::server;
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {  // what the machine refuses before a request comes: threads, memory
    return exit_with_error(1, std::string("cannot start: ") + error.what());
  }
}
