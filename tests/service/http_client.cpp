// SPDX-License-Identifier: Apache-2.0
#include "tests/service/http_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace tilelight::service {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

HttpClient::HttpClient(int port) : port_(port) {
  fd_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval minute{60, 0};
  setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &minute, sizeof minute);
  if (connect(fd_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    ::close(fd_);
    fd_ = -1;
  }
}

HttpClient::~HttpClient() {
  if (fd_ >= 0) ::close(fd_);
}

void HttpClient::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent <= 0) return;  // the server has closed; its answer may still be read
    bytes.remove_prefix(static_cast<size_t>(sent));
  }
}

bool HttpClient::fill() {
  char bytes[64 << 10];
  const ssize_t got = recv(fd_, bytes, sizeof bytes, 0);
  if (got > 0) buffer_.append(bytes, static_cast<size_t>(got));
  return got > 0;
}

HttpAnswer HttpClient::send(std::string_view method, std::string_view path, Fields fields, std::string_view body) {
  std::string head = std::string(method) + " " + std::string(path) + " HTTP/1.1\r\n";
  const auto has = [&](std::string_view name) {
    return std::any_of(fields.begin(), fields.end(), [&](const auto& field) { return lower(field.first) == name; });
  };
  if (!has("host")) head += "Host: 127.0.0.1:" + std::to_string(port_) + "\r\n";
  if (!body.empty() && !has("content-length")) head += "Content-Length: " + std::to_string(body.size()) + "\r\n";
  for (const auto& [name, value] : fields) head += name + ": " + value + "\r\n";
  write(head + "\r\n" + std::string(body));
  return read(method == "HEAD");
}

HttpAnswer HttpClient::read(bool head_only) {
  HttpAnswer answer;
  size_t end;
  while ((end = buffer_.find("\r\n\r\n")) == std::string::npos) {
    if (!fill()) return answer;
  }
  size_t line = buffer_.find("\r\n");
  answer.status = std::atoi(buffer_.c_str() + std::string_view("HTTP/1.1 ").size());
  while (line < end) {
    const size_t next = buffer_.find("\r\n", line + 2), colon = buffer_.find(": ", line);
    answer.headers[lower(buffer_.substr(line + 2, colon - line - 2))] = buffer_.substr(colon + 2, next - colon - 2);
    line = next;
  }
  buffer_.erase(0, end + 4);
  const bool has_body = !head_only && answer.status >= 200 && answer.status != 204 && answer.status != 304;
  const size_t length = has_body ? std::strtoull(answer.header("content-length").c_str(), nullptr, 10) : 0;
  while (buffer_.size() < length) {
    if (!fill()) return {};
  }
  answer.body = buffer_.substr(0, length);
  buffer_.erase(0, length);
  return answer;
}

std::string HttpClient::take_through(std::string_view end) {
  while (buffer_.find(end) == std::string::npos && fill()) continue;
  const size_t at = buffer_.find(end);
  return take(at == std::string::npos ? buffer_.size() : at + end.size());
}

std::string HttpClient::take(size_t count) {
  while (buffer_.size() < count && fill()) continue;
  const std::string bytes = buffer_.substr(0, count);
  buffer_.erase(0, bytes.size());
  return bytes;
}

bool HttpClient::at_end() { return buffer_.empty() && !fill() && buffer_.empty(); }

size_t HttpClient::skip(size_t most) {
  std::string bytes(most, '\0');
  const ssize_t got = recv(fd_, bytes.data(), bytes.size(), 0);
  return got > 0 ? static_cast<size_t>(got) : 0;
}

bool HttpClient::has_bytes() const {
  char byte;
  return !buffer_.empty() || recv(fd_, &byte, 1, MSG_PEEK | MSG_DONTWAIT) > 0;
}

void HttpClient::abort_connection() {
  const linger at_once{1, 0};
  setsockopt(fd_, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  ::close(std::exchange(fd_, -1));
}

void HttpClient::shut_down_sending() { shutdown(fd_, SHUT_WR); }

HttpAnswer ask(int port, std::string_view method, std::string_view path, Fields fields, std::string_view body) {
  return HttpClient(port).send(method, path, std::move(fields), body);
}

HttpAnswer ask_json(int port, std::string_view method, std::string_view path, std::string_view json, Fields fields) {
  fields.emplace_back("Content-Type", "application/json");
  return ask(port, method, path, std::move(fields), json);
}

}  // namespace tilelight::service
