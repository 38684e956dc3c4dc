// SPDX-License-Identifier: Apache-2.0
// HttpClient: an HTTP/1.1 client of its own over a POSIX socket, so that what the server says is judged by somebody who
// shares no code with it.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tilelight::service {

struct HttpAnswer {
  int status = 0;                              // 0: the connection ended or the time was over before an answer
  std::map<std::string, std::string> headers;  // names in lower case
  std::string body;

  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
  }
};

using Fields = std::vector<std::pair<std::string, std::string>>;

class HttpClient {
 public:
  explicit HttpClient(int port);
  ~HttpClient();
  HttpClient(const HttpClient&) = delete;
  HttpClient& operator=(const HttpClient&) = delete;

  // One request on this connection, with Host and Content-Length added where they are not given.
  HttpAnswer send(std::string_view method, std::string_view path, Fields fields = {}, std::string_view body = "");
  void write(std::string_view bytes);
  // Reads one answer; `head_only` where the request was HEAD.
  HttpAnswer read(bool head_only = false);
  // The bytes up to and with the first such end, and so many; fewer where the connection ends before.
  std::string take_through(std::string_view end);
  std::string take(size_t count);
  // True if the server closes the connection without another byte.
  bool at_end();
  void shut_down_sending();
  // Leaves at once, as a process that is killed over unread data does: by a reset.
  void abort_connection();
  // Whether something has come that was not read.
  bool has_bytes() const;
  // Reads at most so many bytes and forgets them. 0: the connection has ended.
  size_t skip(size_t most);

 private:
  bool fill();  // reads some bytes; false at the end, on an error and after a minute
  int fd_ = -1;
  int port_ = 0;
  std::string buffer_;
};

// A request on a connection of its own.
HttpAnswer ask(int port, std::string_view method, std::string_view path, Fields fields = {},
               std::string_view body = "");

// A POST or PUT of JSON.
HttpAnswer ask_json(int port, std::string_view method, std::string_view path, std::string_view json,
                    Fields fields = {});

}  // namespace tilelight::service
