// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/laws.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string_view>

namespace tilelight::laws {
namespace {

using Names = std::set<std::string>;
using Order = std::map<std::string, Names>;

// What stands directly to the left of a room; left of that is left too.
const Order kRenderer = {{"base", {}},           {"scene", {"base"}},          {"schedule", {"base"}},
                         {"film", {"base"}},     {"geometry", {"scene"}},      {"compile", {"geometry", "schedule"}},
                         {"shade", {"compile"}}, {"trace", {"shade", "film"}}, {"raster", {"trace"}},
                         {"render", {"raster"}}, {"measure", {"render"}},      {"renderer", {"measure"}},
                         {"study", {"measure"}}, {"check", {"measure"}},       {"cli", {"check", "renderer", "study"}}};
const Order kServer = {{"address", {}},
                       {"clock", {}},
                       {"process", {}},
                       {"random_id", {}},
                       {"descriptor_writer", {}},
                       {"config", {"address"}},
                       {"log", {"clock", "descriptor_writer"}},
                       {"metrics", {"clock"}},
                       {"scenes", {"config", "log", "metrics", "random_id"}},
                       {"jobs", {"scenes"}},
                       {"sessions", {"scenes"}},
                       {"http", {"jobs", "sessions"}},
                       {"app", {"http", "process"}},
                       {"main", {"app"}}};

Names left_of(const Order& order, const std::string& room) {
  Names left;
  for (const std::string& next : order.at(room)) {
    left.insert(next);
    left.merge(left_of(order, next));
  }
  return left;
}

std::string join(const auto& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : ", ") + std::string(word);
  return text.empty() ? "nothing" : text;
}

struct Include {
  int line;
  bool quoted;
  std::string target;
};

std::vector<Include> includes_of(const std::string& text) {
  static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
  std::vector<Include> found;
  std::istringstream lines(text);
  std::string line;
  std::smatch match;
  for (int number = 1; std::getline(lines, line); ++number)
    if (std::regex_match(line, match, pattern)) found.push_back({number, match[1] == "\"", match[2]});
  return found;
}

struct Place {
  std::string house, room;  // "renderer", "film"; a file at the top of a house is its own room, by its stem
};

Place place_of(const std::string& path) {
  const size_t slash = path.find('/');
  const std::string rest = path.substr(slash + 1);
  std::string room = rest.substr(0, rest.find('/'));
  if (rest.find('/') == std::string::npos) room = std::regex_replace(room, std::regex(R"((_json|_simd)?\.\w+$)"), "");
  return {path.substr(0, slash), room};
}

std::string at(const SourceFile& file, int line) { return file.path + ":" + std::to_string(line) + ": "; }

bool starts_with(const std::string& text, std::string_view prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}
bool matches(const std::string& path, const char* pattern) { return std::regex_match(path, std::regex(pattern)); }

// Comments, strings and character literals become blanks; lines stay where they are.
std::string code_of(const std::string& text) {
  static const std::regex skipped(
      R"re(//[^\n]*|/\*[^*]*\*+(?:[^/*][^*]*\*+)*/|R"\w*\([\s\S]*?\)\w*"|"(?:[^"\\\n]|\\.)*"|\b\d[\w.']*|'(?:[^'\\\n]|\\.)+')re");
  std::string code = text;
  for (std::sregex_iterator it(text.begin(), text.end(), skipped), end; it != end; ++it) {
    const auto first = code.begin() + it->position(), last = first + it->length();
    std::replace_if(
        first, last, [](char c) { return c != '\n'; }, ' ');
  }
  return code;
}

// Whether a using-declaration or directive makes a bare name one of elementary's.
bool brings_in_ours(const std::string& code, const std::string& name) {
  static const Names ours = {"sin", "cos",  "tan",  "acos",  "atan2", "exp",
                             "log", "exp2", "log2", "log1p", "expm1", "pow"};
  return ours.contains(name) &&
         std::regex_search(
             code, std::regex(R"(using\s+(namespace\s+(tilelight::)?elementary|(tilelight::)?elementary::)" + name +
                              R"()\s*;)"));
}

int line_at(const std::string& text, size_t position) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n'));
}

}  // namespace

std::vector<SourceFile> read_sources(const std::filesystem::path& root) {
  std::vector<SourceFile> files;
  for (const char* house : {"renderer", "server"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root / house)) {
      const auto extension = entry.path().extension();
      if (extension != ".h" && extension != ".cpp") continue;
      std::ifstream in(entry.path());
      files.push_back({std::filesystem::relative(entry.path(), root).generic_string(),
                       std::string(std::istreambuf_iterator<char>(in), {})});
    }
  }
  std::sort(files.begin(), files.end(), [](const auto& a, const auto& b) { return a.path < b.path; });
  return files;
}

std::vector<std::string> public_headers_of(const SourceFile& renderer_h) {
  std::vector<std::string> headers = {renderer_h.path};
  for (const Include& include : includes_of(renderer_h.text))
    if (include.quoted) headers.push_back(include.target);
  return headers;
}

Violations broken_room_laws(const SourceFile& file, const std::vector<std::string>& public_headers) {
  const Place here = place_of(file.path);
  const Order& order = here.house == "renderer" ? kRenderer : kServer;
  if (!order.contains(here.room)) return {at(file, 1) + "no law knows the room " + here.room};
  Names allowed = left_of(order, here.room);
  allowed.insert(here.room);
  Violations broken;
  for (const Include& include : includes_of(file.text)) {
    if (!include.quoted) continue;
    const Place there = place_of(include.target);
    const std::string found = at(file, include.line) + "includes " + include.target + "; ";
    if (there.house != "renderer" && there.house != "server") {
      broken.push_back(found + "our own headers are named from the root, others in <>");
    } else if (here.house == "server" && there.house == "renderer") {
      if (std::find(public_headers.begin(), public_headers.end(), include.target) == public_headers.end())
        broken.push_back(found + "the server may use only " + join(public_headers));
    } else if (there.house != here.house) {
      broken.push_back(found + "the renderer never includes the server");
    } else if (!allowed.contains(there.room)) {
      broken.push_back(found + here.room + " may include only " + join(allowed));
    }
  }
  return broken;
}

Violations broken_door_laws(const SourceFile& file) {
  struct Door {
    const char *library, *path, *where;
  };
  static constexpr Door kDoors[] = {
      {R"(hwy/.*)", R"(renderer/(shade|trace|raster)/[^/]*(_simd[^/]*|-inl\.h))",
       "*_simd* and *-inl.h of shade, trace and raster"},
      {R"(nlohmann/.*)", R"(.*_json\.cpp)", "*_json.cpp"},
      {R"(OpenImageIO/.*)", R"(renderer/film/image_io\.cpp)", "renderer/film/image_io.cpp"},
      {R"(libdeflate\.h)", R"(renderer/film/png\.cpp)", "renderer/film/png.cpp"},
      {R"(j(error|peglib)\.h)", R"(renderer/film/jpeg\.cpp)", "renderer/film/jpeg.cpp"},
      {R"(utf8proc\.h)", R"(renderer/base/characters\.cpp)", "renderer/base/characters.cpp"},
      {R"((cpp-)?httplib(\.h|/.*))", R"(server/http/.*)", "server/http"},
      {R"(spdlog/.*)", R"(server/.*)", "the server"},
      {R"(sqlite3\.h)", R"(server/jobs/[^/]*store[^/]*\.cpp)", "one store in server/jobs"},
      {R"(CLI/.*)", R"((renderer/cli|server)/.*\.cpp)", "the two programs"}};
  Violations broken;
  for (const Include& include : includes_of(file.text))
    for (const Door& door : kDoors)
      if (matches(include.target, door.library) && !matches(file.path, door.path))
        broken.push_back(at(file, include.line) + "includes " + include.target + "; its only door is " + door.where);
  return broken;
}

Violations broken_maths_law(const SourceFile& file) {
  if (!starts_with(file.path, "renderer/") || starts_with(file.path, "renderer/base/elementary")) return {};
  static const std::regex call(
      R"(([\w:.>]*\s?)\b(a?(?:sin|cos|tan)h?|atan2|sincos|exp(?:2|10|m1)?|log(?:2|10|1p|b)?|pow|cbrt|hypot|erfc?|[lt]gamma)[fl]?\s*\()");
  static const std::regex of_glm(
      R"(\bglm::(rotate|angleAxis|angle|slerp|perspective\w*|euler\w*|orientate\w*|yawPitchRoll|toQuat|(?:sin|cos|tan|asin|acos|atan|exp2?|log2?|pow)\s*\())");
  const std::string code = code_of(file.text);
  Violations broken;
  for (std::sregex_iterator it(code.begin(), code.end(), of_glm), end; it != end; ++it)
    broken.push_back(at(file, line_at(code, it->position())) + it->str() + " uses the C library; use elementary::");
  for (std::sregex_iterator it(code.begin(), code.end(), call), end; it != end; ++it) {
    const std::string before = (*it)[1], name = (*it)[2];
    const bool of_library = matches(before, R"((.*\b)?std::|::)");
    // Another's function: a member, one of elementary:: or of another namespace, or a declaration after its type.
    const bool bare = matches(before, R"(\s?|(return|else|case|co_return)\s|.*[^\w:.>]\s?)");
    const bool brought_in = brings_in_ours(code, name);
    const bool own =
        std::regex_search(code, std::regex(R"(\b(void|bool|int|auto|[A-Z]\w*)[&*]?\s+)" + name + R"(\s*\()"));
    if (of_library || (bare && !brought_in && !own))
      broken.push_back(at(file, line_at(code, it->position(2))) + before + name +
                       " of the C library has other bits on other CPUs; use elementary::");
  }
  return broken;
}

Violations broken_form_laws(const SourceFile& file) {
  Violations broken;
  if (!starts_with(file.text, "// SPDX-License-Identifier: Apache-2.0\n"))
    broken.push_back(at(file, 1) + "the first line is not the SPDX licence line");
  const auto lines = std::count(file.text.begin(), file.text.end(), '\n');
  if (lines > 600)
    broken.push_back(at(file, 601) + std::to_string(lines) + " lines; a file has one idea and at most 600");
  return broken;
}

}  // namespace tilelight::laws
