// SPDX-License-Identifier: Apache-2.0
#include "server/http/head.h"

#include <algorithm>
#include <charconv>

#include "server/http/text.h"

namespace tilelight::server {
namespace {

constexpr std::string_view kMethods[] = {"GET", "HEAD", "POST", "PUT", "DELETE", "PATCH", "OPTIONS"};

// Not for the HTTP library: ranges and encodings are not offered (it would build 600 ranges in memory), Expect is
// answered by the front, and it takes REMOTE_ADDR and its kin for its own.
constexpr std::string_view kDropped[] = {"range",       "accept-encoding", "expect",    "remote_addr",
                                         "remote_port", "local_addr",      "local_port"};

bool is_token(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) || std::string_view("!#$%&'*+-.^_`|~").find(static_cast<char>(c)) != std::string_view::npos;
  });
}

::tl::unexpected<Problem> bad(std::string detail) { return problem(400, "bad_request", std::move(detail)); }

::tl::expected<void, Problem> check_request_line(std::string_view line, const HeadLimits& limits) {
  const size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) {
    return bad("the first line is not 'METHOD target HTTP/1.1'");
  }
  const std::string_view method = line.substr(0, first), target = line.substr(first + 1, last - first - 1),
                         version = line.substr(last + 1);
  if (!is_token(method)) return bad("the method is not a token");
  if (version != "HTTP/1.1" && version != "HTTP/1.0") {
    return problem(505, "http_version", "this server speaks HTTP/1.1 and HTTP/1.0");
  }
  if (std::find(std::begin(kMethods), std::end(kMethods), method) == std::end(kMethods)) {
    return problem(501, "unknown_method", "no resource of this server knows the method " + std::string(method));
  }
  if (target.size() > limits.target_bytes) {
    return problem(414, "uri_too_long", "path and query may take " + std::to_string(limits.target_bytes) + " bytes");
  }
  const bool printable =
      std::all_of(target.begin(), target.end(), [](unsigned char c) { return c > 0x20 && c != 0x7f; });
  if (target.empty() || target.front() != '/' || !printable) return bad("the target must be a path that begins with /");
  return {};
}

// Reads the fields one by one into a Head.
class FieldReader {
 public:
  FieldReader(Head& head, const HeadLimits& limits) : head_(head), limits_(limits) {}

  ::tl::expected<void, Problem> add(std::string_view line) {
    if (++count_ > limits_.fields) {
      return problem(431, "too_many_fields", "a head may have " + std::to_string(limits_.fields) + " fields");
    }
    if (line.size() > limits_.field_bytes) {
      return problem(431, "field_too_large",
                     "a header line may take " + std::to_string(limits_.field_bytes) + " bytes");
    }
    const size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) {
      return bad("a header line is not 'name: value'");
    }
    const std::string_view name = line.substr(0, colon), value = trim(line.substr(colon + 1));
    const bool clean =
        std::all_of(value.begin(), value.end(), [](unsigned char c) { return c == '\t' || (c >= 0x20 && c != 0x7f); });
    if (!clean) return bad("the header " + std::string(name) + " holds a control character");
    const bool is_dropped = std::any_of(std::begin(kDropped), std::end(kDropped),
                                        [&](std::string_view dropped) { return is_same_name(name, dropped); });
    if (!is_dropped) head_.text.append(name).append(": ").append(value).append("\r\n");
    return note(name, value);
  }

  ::tl::expected<void, Problem> finish(bool is_http_1_1) const {
    if (hosts_ > 1 || (is_http_1_1 && hosts_ == 0)) return bad("a request has exactly one Host header");
    return {};
  }

 private:
  ::tl::expected<void, Problem> note(std::string_view name, std::string_view value) {
    if (is_same_name(name, "host")) ++hosts_;
    if (is_same_name(name, "transfer-encoding")) {
      return problem(411, "length_required", "send Content-Length; chunked bodies are not accepted");
    }
    if (is_same_name(name, "content-encoding") && !is_same_name(value, "identity")) {
      return problem(415, "content_encoding",
                     "send the body unencoded; Content-Encoding " + std::string(value) + " is not accepted");
    }
    if (is_same_name(name, "expect")) {
      if (!is_same_name(value, "100-continue"))
        return problem(417, "expectation", "only Expect: 100-continue is understood");
      head_.expects_continue = true;
    }
    if (is_same_name(name, "content-length")) return note_length(value);
    return {};
  }

  ::tl::expected<void, Problem> note_length(std::string_view value) {
    const bool digits =
        !value.empty() && std::all_of(value.begin(), value.end(), [](unsigned char c) { return std::isdigit(c); });
    if (!digits || lengths_++ > 0) return bad("Content-Length must be one whole number");
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), head_.body_bytes);
    if (error == std::errc::result_out_of_range || head_.body_bytes > limits_.body_bytes) {
      return problem(413, "limit",
                     "a body may have " + std::to_string(limits_.body_bytes) +
                         " bytes (limit bytes); this one declares " + std::string(value));
    }
    return {};
  }

  Head& head_;
  const HeadLimits& limits_;
  int count_ = 0, hosts_ = 0, lengths_ = 0;
};

}  // namespace

::tl::expected<std::optional<Head>, Problem> scan_head(std::string_view buffer, const HeadLimits& limits) {
  const size_t end = buffer.substr(0, limits.head_bytes).find("\r\n\r\n");
  if (end == std::string_view::npos) {
    const bool has_line = buffer.substr(0, limits.head_bytes).find("\r\n") != std::string_view::npos;
    if (!has_line && buffer.size() > limits.target_bytes + 32) {
      return problem(414, "uri_too_long", "path and query may take " + std::to_string(limits.target_bytes) + " bytes");
    }
    if (buffer.size() >= limits.head_bytes) {
      return problem(431, "head_too_large", "a head may take " + std::to_string(limits.head_bytes) + " bytes");
    }
    return std::nullopt;
  }
  Head head;
  head.bytes = end + 4;
  std::string_view rest = buffer.substr(0, end + 2);
  const std::string_view line = rest.substr(0, rest.find("\r\n"));
  if (auto checked = check_request_line(line, limits); !checked) return ::tl::unexpected(checked.error());
  head.text.append(line).append("\r\n");
  rest.remove_prefix(line.size() + 2);
  FieldReader fields(head, limits);
  while (!rest.empty()) {
    const size_t length = rest.find("\r\n");
    if (auto added = fields.add(rest.substr(0, length)); !added) return ::tl::unexpected(added.error());
    rest.remove_prefix(length + 2);
  }
  if (auto done = fields.finish(line.back() == '1'); !done) return ::tl::unexpected(done.error());
  head.text += "\r\n";
  return head;
}

}  // namespace tilelight::server
