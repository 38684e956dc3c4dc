// SPDX-License-Identifier: Apache-2.0
// The daemon as a process: what it prints, and how it ends.
#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/service/service_fixture.h"

namespace tilelight::service {
namespace {

// tilelightd with these flags; its standard output can be read line by line.
class Daemon {
 public:
  explicit Daemon(std::vector<std::string> flags) {
    flags.insert(flags.begin(), TILELIGHTD);
    std::vector<char*> arguments;
    for (std::string& flag : flags) arguments.push_back(flag.data());
    arguments.push_back(nullptr);
    int out[2];
    if (pipe2(out, O_CLOEXEC) != 0) return;
    pid_ = fork();
    if (pid_ == 0) {
      dup2(out[1], STDOUT_FILENO);
      execv(TILELIGHTD, arguments.data());
      _exit(127);
    }
    ::close(out[1]);
    out_ = fdopen(out[0], "r");
  }
  ~Daemon() {
    if (pid_ > 0) kill(pid_, SIGKILL), waitpid(pid_, nullptr, 0);
    if (out_) fclose(out_);
  }
  std::string line() {
    char text[512];
    return fgets(text, sizeof text, out_) ? text : "";
  }
  void signal(int number) const { kill(pid_, number); }
  // The exit status; -1 where a signal ended it.
  int wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  FILE* out_ = nullptr;
};

int port_in(const std::string& line) {
  const size_t colon = line.find(':', line.find("http://") + 7);
  return colon == std::string::npos ? 0 : std::atoi(line.c_str() + colon + 1);
}

const std::vector<std::string> kAnyPorts = {"--port", "0", "--admin-port", "0", "--quiet"};

TEST(DaemonProcess, PrintsWhereItIsAndEndsCleanlyOnSigtermInTheMiddleOfWork) {
  Daemon daemon(kAnyPorts);
  const int port = port_in(daemon.line()), admin_port = port_in(daemon.line());
  ASSERT_GT(port, 0);
  ASSERT_EQ(ask(port, "GET", "/").status, 200);
  ASSERT_EQ(ask_json(port, "POST", "/v1/renders", endless_scene()).status, 202);
  HttpClient waiter(port);
  const std::string scene = endless_scene(1);
  waiter.write(
      "POST /v1/renders HTTP/1.1\r\nHost: localhost\r\nAccept: image/png\r\nContent-Type: application/json\r\n"
      "Content-Length: " +
      std::to_string(scene.size()) + "\r\n\r\n" + scene);
  HttpClient idle(port);
  while (ask(admin_port, "GET", "/metrics").body.find("\ntilelight_requests_waiting 1\n") == std::string::npos) {
  }
  daemon.signal(SIGTERM);
  EXPECT_EQ(waiter.read().status, 503);
  EXPECT_EQ(daemon.wait(), 0);
}

TEST(DaemonProcess, RefusesToStartWhereItsConfigurationIsWrong) {
  EXPECT_EQ(Daemon({"--host", "0.0.0.0", "--port", "0"}).wait(), 2);
  EXPECT_EQ(Daemon({"--no-such-flag"}).wait(), 2);
}

TEST(DaemonProcess, SaysWhenItsPortIsTaken) {
  Service other;
  EXPECT_EQ(Daemon({"--port", std::to_string(other.port()), "--admin-port", "0"}).wait(), 1);
}

TEST(DaemonProcess, HelpAndVersionEndWithZero) {
  Daemon version({"--version"});
  EXPECT_EQ(version.line().rfind("tilelightd ", 0), 0u);
  EXPECT_EQ(version.wait(), 0);
  EXPECT_EQ(Daemon({"--help"}).wait(), 0);
}

}  // namespace
}  // namespace tilelight::service
