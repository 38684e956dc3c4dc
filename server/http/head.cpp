// SPDX-License-Identifier: Apache-2.0
#include "server/http/head.h"

#include <algorithm>

#include "server/http/negotiate.h"
#include "server/http/origin.h"
#include "server/http/target.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

constexpr std::string_view kMethods[] = {"GET", "HEAD", "POST", "PUT", "DELETE", "PATCH", "OPTIONS"};

// Of two values each reader would take another one.
constexpr const char* kFieldsAllowedOnce[] = {"Host",   "Content-Length", "Content-Type",   "Authorization",
                                              "Origin", "Last-Event-ID",  "Idempotency-Key"};

::tl::unexpected<Problem> bad(std::string detail) { return problem(400, "bad_request", std::move(detail)); }

::tl::unexpected<Problem> too_long_target(const HeadLimits& limits) {
  return problem(414, "uri_too_long", "path and query may take " + std::to_string(limits.target_bytes) + " bytes");
}

// A minor version above 1 is read as 1.1 (RFC 9110, 2.5).
::tl::expected<void, Problem> read_version(std::string_view text, Head& head) {
  const bool is_version = text.size() == 8 && text.substr(0, 5) == "HTTP/" && is_digits(text.substr(5, 1)) &&
                          text[6] == '.' && is_digits(text.substr(7));
  if (!is_version) return bad("the first line is not 'METHOD target HTTP/1.1'");
  if (text[5] != '1') return problem(505, "http_version", "this server speaks HTTP/1.1 and HTTP/1.0");
  head.is_http_1_0 = text[7] == '0';
  return {};
}

// The authority of the target, if it has one, is left in the request's headers as the first Host.
::tl::expected<void, Problem> read_target(std::string_view text, const HeadLimits& limits, Request& request) {
  if (text.size() > limits.target_bytes) return too_long_target(limits);
  const auto target = split_target(request.method, text);
  if (!target) return ::tl::unexpected(target.error());
  auto segments = path_segments(target->path);
  auto query = query_parameters(target->query);
  if (!segments || !query) {
    return bad("a % in the target is followed by two hexadecimal digits; a % itself is written %25");
  }
  request.path = target->path;
  request.segments = std::move(*segments);
  request.query = std::move(*query);
  if (!target->authority.empty()) request.headers.emplace("Host", target->authority);
  return {};
}

::tl::expected<void, Problem> read_request_line(std::string_view line, const HeadLimits& limits, Head& head) {
  const size_t first = line.find(' '), last = line.rfind(' ');
  if (first == std::string_view::npos || first == last) return bad("the first line is not 'METHOD target HTTP/1.1'");
  const std::string_view method = line.substr(0, first);
  if (!is_token(method)) return bad("the method is not a token");
  if (auto version = read_version(line.substr(last + 1), head); !version) return version;
  if (std::find(std::begin(kMethods), std::end(kMethods), method) == std::end(kMethods)) {
    return problem(501, "unknown_method", "no resource of this server knows the method " + std::string(method));
  }
  head.request.method = method;
  return read_target(line.substr(first + 1, last - first - 1), limits, head.request);
}

::tl::expected<void, Problem> read_field(std::string_view line, const HeadLimits& limits, Headers& headers) {
  if (line.size() > limits.field_bytes) {
    return problem(431, "field_too_large", "a header line may take " + std::to_string(limits.field_bytes) + " bytes");
  }
  const size_t colon = line.find(':');
  if (colon == std::string_view::npos || !is_token(line.substr(0, colon))) {
    return bad("a header line is not 'name: value'");
  }
  const std::string_view name = line.substr(0, colon), value = trim(line.substr(colon + 1));
  const bool clean =
      std::all_of(value.begin(), value.end(), [](unsigned char c) { return c == '\t' || (c >= 0x20 && c != 0x7f); });
  if (!clean) return bad("the header " + std::string(name) + " holds a control character");
  headers.emplace(name, value);
  return {};
}

// REQUIRES: the fields are read. The target's host counts (RFC 9112, 3.2.2), and Host must be right all the same.
::tl::expected<void, Problem> settle_host(bool is_in_target, Head& head) {
  Headers& headers = head.request.headers;
  const auto from_target = is_in_target ? headers.extract(headers.find("Host")) : Headers::node_type();
  if (headers.count("Host") > 1 || (headers.count("Host") == 0 && !head.is_http_1_0)) {
    return bad("a request has exactly one Host header");
  }
  const std::string_view host = head.request.header("Host").value_or("");
  if (!host.empty() && !parse_authority(host)) return bad("the header Host is not a host with or without a port");
  if (!from_target) return {};
  headers.erase("Host");
  headers.emplace("Host", from_target.mapped());
  return {};
}

::tl::expected<void, Problem> check_fields_allowed_once(const Headers& headers) {
  for (const char* name : kFieldsAllowedOnce) {
    if (headers.count(name) > 1) return bad("the header " + std::string(name) + " may come once");
  }
  return {};
}

// What is said about the body: its length alone counts, and no coding is taken.
::tl::expected<void, Problem> read_framing(const HeadLimits& limits, Head& head) {
  const Request& request = head.request;
  const auto length = request.header("Content-Length");
  if (request.header("Transfer-Encoding")) {
    // Both, or the newer way in the older version: what smuggles a request past a proxy looks so (RFC 9112, 6.1).
    if (length || head.is_http_1_0)
      return bad("a request with Transfer-Encoding has no Content-Length and is HTTP/1.1");
    const auto codings = header_list(request, "Transfer-Encoding");
    if (codings.size() != 1 || !is_same_name(codings[0], "chunked")) {
      return problem(501, "transfer_coding", "no transfer coding is understood; send Content-Length");
    }
    return problem(411, "length_required", "send Content-Length; chunked bodies are not accepted");
  }
  for (const std::string& coding : header_list(request, "Content-Encoding")) {
    if (is_same_name(coding, "identity")) continue;
    Problem refused{415,
                    "content_encoding",
                    "send the body unencoded; Content-Encoding " + coding.substr(0, 100) + " is not accepted",
                    {},
                    {}};
    return ::tl::unexpected<Problem>(refused.with("Accept-Encoding", "identity"));
  }
  if (!length) return {};
  if (!is_digits(*length)) return bad("Content-Length must be one whole number");
  const auto bytes = whole_number<int64_t>(*length);
  if (!bytes || *bytes > limits.body_bytes) {
    return problem(413, "limit",
                   "a body may have " + std::to_string(limits.body_bytes) + " bytes (limit bytes); this one declares " +
                       std::string(length->substr(0, 100)));
  }
  head.body_bytes = *bytes;
  return {};
}

// HTTP/1.0 knows no expectations, and its connections stay open only where that is asked for (RFC 9112, 9.3).
::tl::expected<void, Problem> read_connection(Head& head) {
  const auto options = header_list(head.request, "Connection");
  const auto has = [&](std::string_view option) {
    return std::any_of(options.begin(), options.end(), [&](const auto& o) { return is_same_name(o, option); });
  };
  head.closes = has("close") || (head.is_http_1_0 && !has("keep-alive"));
  if (head.is_http_1_0) return {};
  for (const std::string& expectation : header_list(head.request, "Expect")) {
    if (!is_same_name(expectation, "100-continue")) {
      return problem(417, "expectation", "only Expect: 100-continue is understood");
    }
    head.expects_continue = true;
  }
  return {};
}

// The head is not complete: nothing yet, or what no more bytes can mend.
::tl::expected<std::optional<Head>, Problem> check_incomplete(std::string_view buffer, const HeadLimits& limits) {
  const std::string_view seen = buffer.substr(0, limits.head_bytes);
  for (size_t at = seen.find('\n'); at != std::string_view::npos; at = seen.find('\n', at + 1)) {
    if (at == 0 || seen[at - 1] != '\r') return bad("the lines of a head end with CR and LF");
    if (at == 1) return bad("the first line is empty");
  }
  if (seen.find("\r\n") == std::string_view::npos && buffer.size() > limits.target_bytes + 32) {
    return too_long_target(limits);
  }
  if (buffer.size() >= limits.head_bytes) {
    return problem(431, "head_too_large", "a head may take " + std::to_string(limits.head_bytes) + " bytes");
  }
  return std::nullopt;
}

::tl::expected<void, Problem> read_head(std::string_view text, const HeadLimits& limits, Head& head) {
  const auto take_line = [&text] {
    const std::string_view line = text.substr(0, text.find("\r\n"));
    text.remove_prefix(line.size() + 2);
    return line;
  };
  if (auto read = read_request_line(take_line(), limits, head); !read) return read;
  Headers& headers = head.request.headers;
  const bool is_host_in_target = !headers.empty();
  for (int count = 1; !text.empty(); ++count) {
    if (count > limits.fields) {
      return problem(431, "too_many_fields", "a head may have " + std::to_string(limits.fields) + " fields");
    }
    if (auto read = read_field(take_line(), limits, headers); !read) return read;
  }
  if (auto settled = settle_host(is_host_in_target, head); !settled) return settled;
  if (auto checked = check_fields_allowed_once(headers); !checked) return checked;
  if (auto read = read_framing(limits, head); !read) return read;
  return read_connection(head);
}

}  // namespace

::tl::expected<std::optional<Head>, Problem> scan_head(std::string_view buffer, const HeadLimits& limits) {
  const size_t end = buffer.substr(0, limits.head_bytes).find("\r\n\r\n");
  if (end == std::string_view::npos) return check_incomplete(buffer, limits);
  Head head;
  head.bytes = end + 4;
  if (auto read = read_head(buffer.substr(0, end + 2), limits, head); !read) return ::tl::unexpected(read.error());
  return std::optional<Head>(std::move(head));
}

}  // namespace tilelight::server
