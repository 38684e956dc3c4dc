// SPDX-License-Identifier: Apache-2.0
#include "server/http/json_members.h"

#include <algorithm>
#include <cmath>

#include "server/http/text.h"

namespace tilelight::server {
namespace {

constexpr size_t kMaxMembers = 256;  // what wraps a scene has half a dozen

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  size_t at() const { return at_; }
  bool at_end() const { return at_ == text_.size(); }
  char peek() const { return at_end() ? '\0' : text_[at_]; }
  void skip_space() {
    while (!at_end() && is_space(text_[at_])) ++at_;
  }
  void skip_mark() {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.substr(at_).starts_with(kByteOrderMark)) at_ += kByteOrderMark.size();
  }
  bool take(char c) {
    if (peek() != c) return false;
    ++at_;
    return true;
  }
  bool skip_string() {
    if (!take('"')) return false;
    for (; !at_end(); ++at_) {
      if (text_[at_] == '\\') {
        ++at_;
        if (at_end()) return false;
      } else if (text_[at_] == '"') {
        ++at_;
        return true;
      }
    }
    return false;
  }
  bool skip_value() {
    if (peek() == '"') return skip_string();
    if (peek() != '{' && peek() != '[') return skip_scalar();
    size_t depth = 0;
    while (!at_end()) {
      const char c = text_[at_];
      if (c == '"') {
        if (!skip_string()) return false;
        continue;
      }
      depth += c == '{' || c == '[';
      if (c == '}' || c == ']') --depth;
      ++at_;
      if (depth == 0) return true;
    }
    return false;
  }

 private:
  bool skip_scalar() {
    const size_t begin = at_;
    while (!at_end() && !is_space(text_[at_]) &&
           std::string_view(",:]}[{\"").find(text_[at_]) == std::string_view::npos)
      ++at_;
    return at_ > begin;
  }

  const std::string_view text_;
  size_t at_ = 0;
};

std::string blank(std::string_view text) {
  std::string out(text);
  std::replace_if(
      out.begin(), out.end(), [](char c) { return c != '\n' && c != '\r'; }, ' ');
  return out;
}

}  // namespace

std::optional<std::vector<JsonMember>> scan_members(std::string_view text) {
  Scanner scan(text);
  std::vector<JsonMember> members;
  scan.skip_mark();
  scan.skip_space();
  if (!scan.take('{')) return std::nullopt;
  scan.skip_space();
  bool more = scan.peek() != '}';
  if (!more) scan.take('}');
  while (more) {
    JsonMember member;
    scan.skip_space();
    member.begin = scan.at();
    if (!scan.skip_string()) return std::nullopt;
    member.key = text.substr(member.begin + 1, scan.at() - member.begin - 2);
    scan.skip_space();
    if (!scan.take(':')) return std::nullopt;
    scan.skip_space();
    const size_t value = scan.at();
    if (!scan.skip_value()) return std::nullopt;
    member.end = scan.at();
    member.value = text.substr(value, member.end - value);
    if (members.size() == kMaxMembers) return std::nullopt;
    members.push_back(member);
    scan.skip_space();
    more = scan.take(',');
    if (!more && !scan.take('}')) return std::nullopt;
  }
  scan.skip_space();
  if (!scan.at_end()) return std::nullopt;
  return members;
}

std::string keep_members(std::string_view text, const std::vector<JsonMember>& members,
                         const std::vector<std::string_view>& keys) {
  std::string out = blank(text);
  out[text.find('{')] = '{';
  out[text.rfind('}')] = '}';
  size_t comma_at = std::string::npos;  // right after the member kept last; what stood there was blanked out
  for (const JsonMember& member : members) {
    if (std::find(keys.begin(), keys.end(), member.key) == keys.end()) continue;
    if (comma_at != std::string::npos) out[comma_at] = ',';
    text.copy(out.data() + member.begin, member.end - member.begin, member.begin);
    comma_at = member.end;
  }
  return out;
}

std::string keep_value(std::string_view text, const JsonMember& member) {
  std::string out = blank(text);
  const size_t begin = member.end - member.value.size();
  text.copy(out.data() + begin, member.value.size(), begin);
  return out;
}

std::string without_value(std::string_view text, const JsonMember& member) {
  std::string out(text);
  const size_t begin = member.end - member.value.size();
  out.replace(begin, member.value.size(), blank(member.value));
  out[begin] = '0';
  return out;
}

const JsonMember* find_member(const std::vector<JsonMember>& members, std::string_view key) {
  const auto found = std::find_if(members.begin(), members.end(), [&](const JsonMember& m) { return m.key == key; });
  return found == members.end() ? nullptr : &*found;
}

std::optional<int64_t> json_whole_number(std::string_view value) {
  if (const auto whole = whole_number<int64_t>(value)) return whole;
  constexpr double kExact = 9007199254740992.0;  // 2^53
  double number = 0.0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  const bool is_number = error == std::errc() && end == value.data() + value.size();
  if (!is_number || std::floor(number) != number || std::abs(number) > kExact) return std::nullopt;
  return static_cast<int64_t>(number);
}

std::optional<std::string_view> plain_string(std::string_view value) {
  if (value.size() < 2 || value.front() != '"' || value.find('\\') != std::string_view::npos) return std::nullopt;
  return value.substr(1, value.size() - 2);
}

}  // namespace tilelight::server
