// SPDX-License-Identifier: Apache-2.0
// J2: documents as large as the limits allow. Each is answered in seconds and in memory of a few times its size.
#include <malloc.h>

#include <algorithm>
#include <cstdint>
#include <ctime>
#include <fstream>
#include <limits>
#include <string>

#include "renderer/check/rows/inputs.h"
#include "renderer/scene/parse.h"

namespace tilelight::check {
namespace {

// begin, then part(0), part(1), ... while they and the end fit, then the end.
template <class Part>
std::string filled(size_t bytes, std::string begin, const Part& part, const std::string& end, int most = 1 << 30) {
  std::string text = std::move(begin);
  text.reserve(bytes);
  for (int i = 0; i < most; ++i) {
    const std::string more = part(i);
    if (text.size() + more.size() + end.size() > bytes) break;
    text += more;
  }
  return text + end;
}

std::string numbered(const std::string& prefix, int i) {
  const std::string digits = std::to_string(i);
  return prefix + std::string(8 - digits.size(), '0') + digits;
}

// As many names as may be, each 64 letters long and nearly alike, and as many objects that name none of them rightly.
std::string misspelt_names() {
  const std::string stem(55, 'a');
  std::string text = R"({"materials": {)";
  for (int i = 0; i < 9'999; ++i) text += (i ? ", \"" : "\"") + numbered(stem + "m", i) + "\": {}";
  text += R"(}, "objects": [)";
  for (int i = 0; i < 9'999; ++i)
    text += (i ? ", " : "") + std::string(R"({"type": "sphere", "material": ")") + numbered(stem + "x", i) + "\"}";
  return text + "]}";
}

std::vector<std::string> large_documents(size_t bytes) {
  const auto same = [](std::string part) { return [part](int) { return part; }; };
  const std::string tail = R"(, "objects": [{"type": "sphere"}]})",
                    radius = R"({"objects": [{"type": "sphere", "radius": )";
  const auto list_of = [&](const char* part) {
    return filled(bytes, R"({"extras": [)", same(std::string(part) + ","), "0]" + tail);
  };
  return {
      filled(bytes, "", same("["), ""),
      filled(bytes, R"({"extras": )", same("{\"a\":["), ""),
      filled(bytes, radius, same("1"), "}]}"),
      filled(bytes, radius + "0.", same("0"), "1}]}"),
      filled(bytes, radius + "1e", same("9"), "}]}"),
      filled(bytes, radius + "1e-", same("9"), "}]}"),
      filled(bytes, R"({"extras": ")", same("\\u0000"), "\"" + tail),
      filled(bytes, "{\"", same("k"), "\": 1" + tail),
      filled(bytes, "{\"x-a\": 1", same(", \"x-a\": 1"), tail, 900'000),
      filled(
          bytes, "{\"a\": 1", [](int i) { return numbered(", \"key", i) + "\": 1"; }, tail, 900'000),
      filled(
          bytes, "{\"a\": 1", [](int i) { return ", \"" + std::string(9'000, 'k') + numbered("", i) + "\": 1"; }, tail),
      filled(bytes, R"({"objects": [0)", same(",{}"), "]}", 900'000),
      filled(bytes, R"({"objects": [{"type": "sphere"})", same(R"(,{"type":"sphere"})"), "]}", 20'000),
      list_of("1e-5"),
      list_of("[]"),
      filled(bytes, R"({"extras": [0)", same(",1"), ",null]" + tail),
      filled(bytes, "", same(" "), "{}"),
      misspelt_names()};
}

double thread_cpu_s() {
  timespec now{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// The most memory of this process since the mark was last set, MiB.
double peak_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024.0;
  return std::numeric_limits<double>::quiet_NaN();
}
void set_peak_mark() {
  ::malloc_trim(0);                               // what earlier work has freed would hide what is taken
  std::ofstream("/proc/self/clear_refs") << "5";  // where it is not allowed the mark stays: less is seen, never more
}

// A reader that calls itself for every bracket: where its stack ends.
uintptr_t textbook_read(const std::string& text, size_t at) {
  const volatile char bracket = text[at];
  const auto here = reinterpret_cast<uintptr_t>(&bracket);
  const uintptr_t deepest = at + 1 < text.size() ? textbook_read(text, at + 1) : here;
  return bracket == '[' ? deepest : here;
}

// The stack that it takes, MiB, by what a thousand brackets take.
double textbook_stack_mib(size_t brackets) {
  const uintptr_t one = textbook_read("[", 0), many = textbook_read(std::string(1001, '['), 0);
  return static_cast<double>(std::max(one, many) - std::min(one, many)) / 1000.0 * static_cast<double>(brackets) /
         0x1p20;
}

}  // namespace

Outcome of_large_documents(const Context& context) {
  const size_t bytes = context.is_quick ? 1u << 20 : static_cast<size_t>(Limits{}.bytes);
  double slowest_s = 0.0, most_mib = 0.0;
  int64_t unanswered = 0, most_errors = 0;
  for (const std::string& text : large_documents(bytes)) {
    set_peak_mark();
    const double mib = peak_mib(), start = thread_cpu_s();
    const auto parsed = parse_scene(text, Limits{});
    note(slowest_s, thread_cpu_s() - start);
    note(most_mib, peak_mib() - mib);
    if (parsed) continue;
    unanswered += parsed.error().errors.empty() || parsed.error().errors[0].detail.empty();
    most_errors = std::max(most_errors, static_cast<int64_t>(parsed.error().errors.size()));
  }
  return {{at_most(0, "documents without an answer", static_cast<double>(unanswered)),
           at_most(100, "errors in one answer", static_cast<double>(most_errors)),
           at_most(5 * kSlowdown, "the slowest, s on one core", slowest_s),
           at_most(512, "memory beside the text, MiB", most_mib)},
          {at_most(8, "stack for 16 MiB of brackets, MiB", textbook_stack_mib(16u << 20))}};
}

}  // namespace tilelight::check
