// SPDX-License-Identifier: Apache-2.0
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iterator>
#include <nlohmann/json.hpp>

#include "server/config.h"

namespace tilelight::server {
namespace {

using nlohmann::json;

constexpr size_t kMostBytes = size_t{1} << 20;
constexpr int kPatienceMs = 5'000;  // with a pipe into which nobody writes

struct Descriptor {
  ~Descriptor() {
    if (fd >= 0) close(fd);
  }
  int fd = -1;
};

// The file's bytes; what is read of a pipe comes to its end, or to ours.
Result<std::string> read_file(const std::string& path) {
  const auto cannot = [&](const std::string& why) { return fail("no_file", path + ": cannot be read: " + why); };
  // Without waiting, since a named pipe without a writer would never be opened.
  const Descriptor file{open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC)};
  struct stat status {};
  if (file.fd < 0 || fstat(file.fd, &status) != 0) return cannot(std::strerror(errno));
  if (S_ISDIR(status.st_mode)) return cannot("it is a directory; name a JSON file in it");
  std::string text;
  char block[16384];
  for (;;) {
    pollfd ready{file.fd, POLLIN, 0};
    if (poll(&ready, 1, kPatienceMs) == 0)
      return cannot("it is a pipe, and nobody has written into it for " + std::to_string(kPatienceMs / 1000) + " s");
    const ssize_t got = read(file.fd, block, sizeof block);
    if (got == 0) return text;
    if (got < 0 && errno != EINTR && errno != EAGAIN) return cannot(std::strerror(errno));
    if (got > 0) text.append(block, static_cast<size_t>(got));
    if (text.size() > kMostBytes)
      return cannot("it has more than " + std::to_string(kMostBytes) + " bytes, which no configuration has");
  }
}

// Counts what has been read, by which the places of errors are known.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** furthest) : at_(at), furthest_(furthest) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() { return *furthest_ = ++at_, *this; }
  CountingIterator operator++(int) {
    const CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char** furthest_;
};

// Receives the events of nlohmann's parser and stops it at the first thing that is not of a flat object.
class Reader {
 public:
  Reader(std::string_view text, const std::string& path) : text_(text), path_(path), at_(text.data()) {}

  Result<std::vector<ConfigMember>> read() {
    if (const size_t nul = text_.find('\0'); nul != std::string_view::npos)
      return fail("not_json", where(nul) + "found a NUL byte; expected one JSON object as text");
    if (text_.find_first_not_of(" \t\r\n") == std::string_view::npos)
      return fail("not_json", path_ + ": is empty; expected one JSON object, like {\"max_queue\": 64}");
    const char* const end = text_.data() + text_.size();
    if (json::sax_parse(CountingIterator(at_, &at_), CountingIterator(end, &at_), this)) return std::move(members_);
    return ::tl::unexpected(error_);
  }

  bool null() { return refuse("null"); }
  bool boolean(bool value) { return take(ConfigMember::Type::truth, value ? "true" : "false", "a truth value"); }
  bool number_integer(int64_t value) { return take(ConfigMember::Type::whole, std::to_string(value), "a number"); }
  bool number_unsigned(uint64_t value) { return take(ConfigMember::Type::whole, std::to_string(value), "a number"); }
  bool number_float(double, const std::string& token) { return refuse("the number " + token); }
  bool string(const std::string& text) { return take(ConfigMember::Type::text, text, "a string"); }
  bool binary(json::binary_t&) { return false; }  // JSON text has none
  bool start_array(size_t) { return refuse("a list"); }
  bool start_object(size_t) {
    if (is_open_) return refuse("an object");
    is_open_ = true;
    passed_ = at_;
    return true;
  }
  bool key(const std::string& key) {
    // Between the values there are only white space and commas.
    const size_t start = text_.find('"', static_cast<size_t>(passed_ - text_.data()));
    const Place place = place_of(start);
    members_.push_back({key, "", ConfigMember::Type::text, place.line, place.column});
    return true;
  }
  bool end_object() { return true; }
  bool end_array() { return true; }
  bool parse_error(size_t position, const std::string&, const json::exception& error) {
    // Without its prefix, which tells the place once more.
    std::string_view what = error.what();
    const size_t column = what.find("column ");
    const size_t colon = what.find(": ", column == std::string_view::npos ? 0 : column);
    if (colon != std::string_view::npos) what.remove_prefix(colon + 2);
    error_ = {"not_json", where(position > 0 ? position - 1 : 0) + "not JSON: " + std::string(what)};
    return false;
  }

 private:
  struct Place {
    int line, column;
  };
  Place place_of(size_t offset) const {
    const std::string_view before = text_.substr(0, std::min(offset, text_.size()));
    const auto line = std::count(before.begin(), before.end(), '\n');
    const size_t feed = before.rfind('\n');
    return {static_cast<int>(line) + 1,
            static_cast<int>(before.size() - (feed == std::string_view::npos ? 0 : feed + 1)) + 1};
  }
  std::string where(size_t offset) const {
    const Place place = place_of(offset);
    return path_ + ":" + std::to_string(place.line) + ":" + std::to_string(place.column) + ": ";
  }

  bool take(ConfigMember::Type type, std::string value, const char* what) {
    if (!is_open_) return refuse(what);
    members_.back().type = type;
    members_.back().value = std::move(value);
    passed_ = at_;
    return true;
  }

  bool refuse(const std::string& found) {
    if (!is_open_) {
      error_ = {"wrong_type", path_ + ": expected one JSON object, like {\"max_queue\": 64}; found " + found};
    } else {
      const ConfigMember& member = members_.back();
      error_ = {"wrong_type", path_ + ":" + std::to_string(member.line) + ":" + std::to_string(member.column) + ": '" +
                                  member.key + "' is " + found + "; allowed: a string, a whole number, true or false"};
    }
    return false;
  }

  const std::string_view text_;
  const std::string& path_;
  const char* at_;                // how far the parser has read
  const char* passed_ = nullptr;  // the end of the last value
  bool is_open_ = false;
  std::vector<ConfigMember> members_;
  Error error_;
};

}  // namespace

Result<std::vector<ConfigMember>> read_config_file(const std::string& path) {
  const auto text = read_file(path);
  if (!text) return ::tl::unexpected(text.error());
  return Reader(*text, path).read();
}

}  // namespace tilelight::server
