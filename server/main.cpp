// SPDX-License-Identifier: Apache-2.0
// tilelightd: the render server. Ends with 0 on SIGTERM and SIGINT, 2 where its configuration is refused, 1 where it
// cannot listen.
#include <malloc.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "server/app.h"

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

int run(int argc, const char* const* argv) {
  // Blocked in all threads; sigwait below takes them. Before any thread exists.
  sigset_t ending;
  sigemptyset(&ending);
  sigaddset(&ending, SIGTERM);
  sigaddset(&ending, SIGINT);
  pthread_sigmask(SIG_BLOCK, &ending, nullptr);
  std::signal(SIGPIPE, SIG_IGN);
  raise_descriptor_limit();
  keep_freed_memory();

  const auto request = load_config(argc, argv, process_environment());
  if (!request) {
    std::fprintf(stderr, "tilelightd: %s\n", request.error().detail.c_str());
    return 2;
  }
  if (request->help_or_version) {
    std::fputs(request->text.c_str(), stdout);
    return 0;
  }
  const SystemClock clock;
  auto app = App::open(request->config, clock);
  if (!app) {
    std::fprintf(stderr, "tilelightd: %s\n", app.error().detail.c_str());
    return 1;
  }
  (*app)->start();
  const Config& config = request->config;
  if (config.allow_open) {
    (*app)->log().write(
        LogLevel::warn, "open",
        {{"host", config.host}, {"detail", "whoever reaches this address may render: there are no keys"}});
  }
  std::printf("Tilelight is at %s\nHealth and metrics are at http://%s:%d/metrics\n", (*app)->url().c_str(),
              config.admin_host.c_str(), (*app)->admin_port());
  std::fflush(stdout);

  int signal = 0;
  sigwait(&ending, &signal);
  (*app)->log().write(LogLevel::info, "stopping", {{"signal", int64_t{signal}}});
  (*app)->stop();
  return 0;
}

}  // namespace
}  // namespace tilelight::server

int main(int argc, char** argv) { return tilelight::server::run(argc, argv); }
