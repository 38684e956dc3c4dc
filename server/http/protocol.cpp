// SPDX-License-Identifier: Apache-2.0
#include "server/http/protocol.h"

#include <httplib.h>

#include <cstring>

namespace tilelight::server {
namespace {

// What httplib takes for a connection: reads a head, collects a response.
class MemoryStream final : public httplib::Stream {
 public:
  MemoryStream(const std::string& in, std::string& out) : in_(in), out_(out) {}
  bool is_readable() const override { return at_ < in_.size(); }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, size_t size) override {
    const size_t count = std::min(size, in_.size() - at_);
    std::memcpy(to, in_.data() + at_, count);
    at_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* from, size_t size) override {
    out_.append(from, size);
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return INVALID_SOCKET; }

 private:
  const std::string& in_;
  std::string& out_;
  size_t at_ = 0;
};

Request from_httplib(const httplib::Request& in) {
  Request request;
  request.method = in.method;
  request.path = in.path;
  request.query.insert(in.params.begin(), in.params.end());
  for (const auto& [name, value] : in.headers) request.headers.emplace(name, value);
  return request;
}

// The body, unless it is shared: that one goes around httplib, which would copy it.
void to_httplib(Response&& from, bool is_head, httplib::Response& out) {
  out.status = from.status;
  for (const auto& [name, value] : from.headers) out.set_header(name, value);
  if (!from.content_type.empty()) out.set_header("Content-Type", from.content_type);
  if (is_head) out.set_header("Accept-Ranges", "none");  // else httplib promises bytes
  out.body = std::move(from.body);
}

// One request's worth of an httplib server: everything happens before its routing, so that none of its own rules about
// bodies, files and patterns apply. Making one costs a microsecond.
class OneRequest final : private httplib::Server {
 public:
  explicit OneRequest(const std::function<Response(Request&&)>& handle) {
    set_keep_alive_max_count(1'000'000);
    set_keep_alive_timeout(60);
    set_pre_routing_handler([this, &handle](const httplib::Request& in, httplib::Response& out) {
      Response response = handle(from_httplib(in));
      was_understood_ = true;
      is_head_ = in.method == "HEAD";
      is_http_1_0_ = in.version == "HTTP/1.0";
      shared_ = response.shared;
      stream_ = response.stream;
      to_httplib(std::move(response), is_head_, out);
      return HandlerResponse::Handled;
    });
  }

  std::optional<Served> run(const std::string& head, bool close_after) {
    Served served;
    MemoryStream stream(head, served.bytes);
    served.close = close_after;
    const bool alive = process_request(stream, close_after, served.close, nullptr);
    if (!was_understood_) return std::nullopt;
    served.close |= close_after || !alive || (stream_ && is_http_1_0_);
    correct_length(served.bytes);
    served.is_chunked = !is_http_1_0_;
    if (!is_head_) served.body = std::move(shared_), served.stream = std::move(stream_);
    return served;
  }

 private:
  // httplib writes a Content-Length of 0 where the body is shared or a stream, and where RFC 9110 (8.6) wants none:
  // 204, and 304 whose length would be the 200's.
  void correct_length(std::string& bytes) const {
    constexpr std::string_view kFalse = "Content-Length: 0\r\n";
    const bool has_no_body = bytes.rfind("HTTP/1.1 204", 0) == 0 || bytes.rfind("HTTP/1.1 304", 0) == 0;
    if (!shared_ && !stream_ && !has_no_body) return;
    const size_t at = bytes.find("\r\n" + std::string(kFalse));
    if (at == std::string::npos) return;
    std::string field;
    if (shared_) field = "Content-Length: " + std::to_string(shared_->size()) + "\r\n";
    if (stream_ && !is_http_1_0_) field = "Transfer-Encoding: chunked\r\n";
    bytes.replace(at + 2, kFalse.size(), field);
  }

  bool was_understood_ = false, is_head_ = false, is_http_1_0_ = false;
  SharedBytes shared_;
  std::shared_ptr<BodyStream> stream_;
};

}  // namespace

std::optional<Served> serve_head(const std::string& head, bool close_after,
                                 const std::function<Response(Request&&)>& handle) {
  return OneRequest(handle).run(head, close_after);
}

std::string closing_response(const Response& response) {
  return serve_head("GET / HTTP/1.1\r\nConnection: close\r\n\r\n", true, [&](Request&&) { return response; })->bytes;
}

}  // namespace tilelight::server
