// SPDX-License-Identifier: Apache-2.0
#include "server/http/protocol.h"

#include <httplib.h>

#include <cstring>

#include "server/clock.h"

namespace tilelight::server {
namespace {

// What httplib takes for a connection: reads a head, collects a response.
class MemoryStream final : public httplib::Stream {
 public:
  MemoryStream(std::string_view in, std::string& out) : in_(in), out_(out) {}
  bool is_readable() const override { return !in_.empty(); }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, size_t size) override {
    const size_t count = in_.copy(to, size);
    in_.remove_prefix(count);
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
  std::string_view in_;
  std::string& out_;
};

// The body, unless it is shared: that one goes around httplib, which would copy it.
void to_httplib(Response&& from, ResponseForm form, httplib::Response& out) {
  out.status = from.status;
  out.set_header("Date", http_date(SystemClock().wall_ms()));
  for (const auto& [name, value] : from.headers) out.set_header(name, value);
  if (!from.content_type.empty()) out.set_header("Content-Type", from.content_type);
  if (form.is_head) out.set_header("Accept-Ranges", "none");  // else httplib promises bytes
  if (form.is_http_1_0 && !form.close) out.set_header("Connection", "keep-alive");
  out.body = std::move(from.body);
}

// httplib writes responses as a part of serving requests, so it is given one that says how, and no more. Everything
// happens before its routing, so that none of its own rules about bodies, files and patterns apply. Making a server
// costs a microsecond.
class ResponseWriter final : private httplib::Server {
 public:
  ResponseWriter() {
    set_keep_alive_max_count(1'000'000);
    set_keep_alive_timeout(60);
  }

  std::string write(Response&& response, ResponseForm form) {
    set_pre_routing_handler([&](const httplib::Request&, httplib::Response& out) {
      to_httplib(std::move(response), form, out);
      return HandlerResponse::Handled;
    });
    std::string request = form.is_head ? "HEAD / HTTP/1.1\r\n" : "GET / HTTP/1.1\r\n";
    request += form.close ? "Connection: close\r\n\r\n" : "\r\n";
    std::string bytes;
    MemoryStream stream(request, bytes);
    bool closes = false;
    process_request(stream, form.close, closes, nullptr);
    return bytes;
  }
};

// httplib writes a Content-Length of 0 where the body is shared or a stream, and where RFC 9110 (8.6) wants none: 204,
// and 304 whose length would be the 200's. `field` takes its place.
void replace_length(std::string& bytes, std::string_view field) {
  constexpr std::string_view kFalse = "\r\nContent-Length: 0\r\n";
  if (const size_t at = bytes.find(kFalse); at != std::string::npos) bytes.replace(at + 2, kFalse.size() - 2, field);
}

}  // namespace

Served write_response(Response&& response, ResponseForm form) {
  Served served;
  served.body = std::move(response.shared);
  served.stream = std::move(response.stream);
  served.is_chunked = !form.is_http_1_0;
  if (served.stream && form.is_http_1_0) form.close = true;  // nothing else can say where it ends
  served.close = form.close;
  const bool has_no_body = response.status == 204 || response.status == 304;
  served.bytes = ResponseWriter().write(std::move(response), form);
  if (served.stream) {
    replace_length(served.bytes, served.is_chunked ? "Transfer-Encoding: chunked\r\n" : "");
  } else if (served.body) {
    replace_length(served.bytes, "Content-Length: " + std::to_string(served.body->size()) + "\r\n");
  } else if (has_no_body) {
    replace_length(served.bytes, "");
  }
  if (form.is_head) served.body = nullptr, served.stream = nullptr;
  return served;
}

}  // namespace tilelight::server
