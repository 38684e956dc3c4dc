// SPDX-License-Identifier: Apache-2.0
#include "server/http/render_body.h"

#include <algorithm>
#include <map>

#include "server/http/json_members.h"
#include "server/http/text.h"

namespace tilelight::server {
namespace {

// Under it, parsing takes under 2 ms, less than a busy pool would keep it waiting.
constexpr size_t kParseHereBytes = 64 << 10;

constexpr std::string_view kViewKeys[] = {"camera", "image", "render"};

std::string join(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ", ") + word;
  return out;
}

// What is wrong with the members around a scene, collected.
class MemberErrors {
 public:
  // key: empty for the whole body.
  void add(std::string_view key, std::string code, std::string detail, std::vector<std::string> allowed = {},
           std::string hint = "") {
    if (errors_.errors.size() == kMaxErrors) return;
    errors_.errors.push_back({(key.empty() ? "" : "/") + std::string(key), std::move(code), std::move(detail),
                              std::move(allowed), std::move(hint), 0, 0});
  }
  // Every key is known and none comes twice.
  void check_keys(const std::vector<JsonMember>& members, const std::vector<std::string>& known) {
    for (size_t i = 0; i < members.size(); ++i) {
      const std::string key(members[i].key);
      if (std::find(known.begin(), known.end(), key) == known.end()) {
        add(key, "unknown_key", "unknown key '" + key + "'; here are allowed: " + join(known), known);
      }
      const bool is_repeated = std::any_of(members.begin(), members.begin() + static_cast<std::ptrdiff_t>(i),
                                           [&](const JsonMember& m) { return m.key == key; });
      if (is_repeated) add(key, "duplicate_key", "the key '" + key + "' comes twice");
    }
  }
  bool empty() const { return errors_.errors.empty(); }
  ::tl::unexpected<Problem> problem() const { return scene_problem(errors_); }

 private:
  static constexpr size_t kMaxErrors = 32;  // a short request must not make a long answer

  SceneErrors errors_;
};

// The word of a member that names one of a few things.
template <class T, class Find>
std::optional<T> read_word(const std::vector<JsonMember>& members, std::string_view key, Find find,
                           const std::vector<std::string>& allowed, MemberErrors& errors) {
  const JsonMember* member = find_member(members, key);
  if (!member) return std::nullopt;
  const auto word = plain_string(member->value);
  std::optional<T> value = word ? find(*word) : std::nullopt;
  if (!value) {
    errors.add(key, "unknown_name", "found " + std::string(member->value.substr(0, 40)) + "; allowed: " + join(allowed),
               allowed);
  }
  return value;
}

std::vector<std::string> names_of(const std::vector<ImageFormat>& formats) {
  std::vector<std::string> names;
  for (const ImageFormat format : formats) names.emplace_back(image_format_name(format));
  return names;
}

std::optional<ImageFormat> read_format(const std::vector<JsonMember>& members, MemberErrors& errors) {
  return read_word<ImageFormat>(members, "format", find_image_format, names_of(image_formats(true)), errors);
}

// Whether there is that format of the view's picture.
void check_format(std::optional<ImageFormat> format, const View& view, MemberErrors& errors) {
  const std::vector<ImageFormat> formats = image_formats(view);
  if (!format || std::find(formats.begin(), formats.end(), *format) != formats.end()) return;
  const auto names = names_of(formats);
  if (const auto fits = check_image_size(*format, view.image.width, view.image.height); !fits) {
    errors.add("format", fits.error().code, fits.error().detail, names, "/v1/limits has the limits of all formats");
    return;
  }
  errors.add("format", "no_lines",
             "found \"" + std::string(image_format_name(*format)) +
                 "\", which is of lines, and this picture has none; allowed: " + join(names),
             names, "lines are drawn by the algorithm roberts");
}

std::optional<Priority> find_batch_or_normal(std::string_view name) {
  if (name == "normal") return Priority::normal;
  if (name == "batch") return Priority::batch;
  return std::nullopt;
}

::tl::expected<ScenePtr, Problem> parse_whole(std::string_view text, const Limits& limits, std::string_view prefix) {
  auto parsed = parse_scene(text, limits);
  if (!parsed) {
    SceneErrors errors = std::move(parsed.error());
    for (SceneError& error : errors.errors) error.pointer.insert(0, prefix);
    return scene_problem(errors);
  }
  auto scene = std::make_shared<StoredScene>();
  scene->parsed = std::move(*parsed);
  scene->text = text;
  return scene;
}

// The scene that the member names by id or holds.
::tl::expected<ScenePtr, Problem> read_scene_member(Services& services, std::string_view body,
                                                    const JsonMember& member) {
  if (member.value.front() == '{') {
    auto scene = parse_whole(keep_value(body, member), services.config.limits, "/scene");
    return scene;
  }
  MemberErrors errors;
  const auto id = plain_string(member.value);
  if (!id) {
    errors.add("scene", "wrong_type", "'scene' must be the id of a stored scene or a scene object");
    return errors.problem();
  }
  ScenePtr scene = services.scenes.find(std::string(*id));
  if (!scene) {
    errors.add("scene", "unknown_scene",
               "no scene '" + std::string(id->substr(0, 80)) +
                   "' is stored (any more); store it with POST /v1/scenes or send it along");
    return errors.problem();
  }
  return scene;
}

::tl::expected<RenderBody, Problem> parse_body(Services& services, std::string_view body,
                                               std::initializer_list<std::string_view> wishes) {
  const Limits& limits = services.config.limits;
  RenderBody out;
  const auto members = scan_members(body);
  const JsonMember* scene_member = members ? find_member(*members, "scene") : nullptr;
  if (!scene_member || find_member(*members, "objects")) {
    auto scene = parse_whole(body, limits, "");
    if (!scene) return ::tl::unexpected(scene.error());
    out.scene = std::move(*scene);
    out.view = out.scene->parsed.view;
    out.warnings = out.scene->parsed.warnings;
    return out;
  }
  // The scene's own parser reads it; the rest has to be JSON to the last byte too.
  const bool is_inline = scene_member->value.front() == '{';
  if (const auto broken = find_json_errors(is_inline ? without_value(body, *scene_member) : std::string(body), limits))
    return scene_problem(*broken);
  std::vector<std::string> known = {"scene", "camera", "image", "render"};
  for (const std::string_view wish : wishes) known.emplace_back(wish);
  MemberErrors errors;
  errors.check_keys(*members, known);
  out.format = read_format(*members, errors);
  out.priority = read_word<Priority>(*members, "priority", find_batch_or_normal, {"normal", "batch"}, errors);
  if (!errors.empty()) return errors.problem();
  auto scene = read_scene_member(services, body, *scene_member);
  if (!scene) return ::tl::unexpected(scene.error());
  out.scene = std::move(*scene);
  out.warnings = out.scene->parsed.warnings;
  auto view = parse_view(keep_members(body, *members, {std::begin(kViewKeys), std::end(kViewKeys)}),
                         out.scene->parsed.view, limits);
  if (!view) return scene_problem(view.error());
  out.view = std::move(*view);
  check_format(out.format, out.view, errors);
  if (!errors.empty()) return errors.problem();
  return out;
}

// The members of a body that is one JSON object, of which every byte has been read.
::tl::expected<std::vector<JsonMember>, Problem> read_members(std::string_view body, const Limits& limits) {
  if (const auto broken = find_json_errors(body, limits)) return scene_problem(*broken);
  if (auto members = scan_members(body)) return std::move(*members);
  const auto view = parse_view(body, View{}, limits);  // says what it is in place of an object
  return view ? problem(422, "wrong_type", "the body must be a JSON object of few members")
              : scene_problem(view.error());
}

constexpr std::string_view kRules[] = {"samples", "rmse", "time_ms"};

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// The stop rules of a refining body, read as those of a scene are.
::tl::expected<View, Problem> read_rules(std::string_view body, const std::vector<JsonMember>& members,
                                         const Limits& limits) {
  constexpr std::string_view kAround = "{\"render\": ";
  const std::string rules = keep_members(body, members, {std::begin(kRules), std::end(kRules)});
  auto view = parse_view(std::string(kAround) + rules + "}", View{}, limits);
  if (view) return std::move(*view);
  for (SceneError& error : view.error().errors) {
    if (error.pointer.rfind("/render", 0) == 0) error.pointer.erase(0, std::string_view("/render").size());
    if (error.line == 1) error.column -= static_cast<int>(kAround.size());
  }
  return scene_problem(view.error());
}

// Says which rule leaves nothing to do, and what would.
void add_if_met(const RenderSpec& rules, const RenderReport& report, const Limits& limits, MemberErrors& errors) {
  const std::string met = rule_met(rules, report);
  const ReportPoint& last = report.points.back();
  const std::string spp = number_text(last.spp);
  if (met == "samples" && (rules.samples_implied || last.spp >= limits.samples)) {
    errors.add(
        "", "already_reached",
        "the render has " + spp + " samples a pixel, of " + std::to_string(limits.samples) + " that it may have");
  } else if (met == "samples") {
    errors.add("samples", "already_reached",
               "the render has " + spp + " samples a pixel, so " + std::to_string(*rules.samples) + " add nothing",
               {"over " + spp + ", up to " + std::to_string(limits.samples)},
               "'samples' counts the whole picture: to add as many again, ask for " +
                   number_text(std::min<double>(2.0 * last.spp, limits.samples)));
  } else if (met == "rmse") {
    errors.add("rmse", "already_reached",
               "the error of the render is below " + number_text(last.error.high) + ", so " + number_text(*rules.rmse) +
                   " adds nothing",
               {"below " + number_text(last.error.high)}, "ask for a smaller error, or for samples or time");
  } else if (met == "time") {
    errors.add("time_ms", "out_of_range", "found " + number_text(*rules.time_ms) + ", too little for any pass",
               {"3 or more"});
  }
}

// A number list of a query as a JSON array, or a single number; nothing if it holds anything else, so that no text of a
// query can pose as JSON.
std::optional<std::string> query_numbers(std::string_view text, bool is_vector) {
  const bool clean = !text.empty() && text.find_first_not_of("0123456789+-.eE,") == std::string_view::npos;
  if (!clean || (!is_vector && text.find(',') != std::string_view::npos)) return std::nullopt;
  return is_vector ? "[" + std::string(text) + "]" : std::string(text);
}

// Runs parse() here or, for a large body, on the pool: before all rendering, since a worker waits for it that holds no
// slot to wait in.
template <class Parse>
auto parse_where_it_fits(Services& services, std::string_view body, Parse parse) {
  return body.size() <= kParseHereBytes ? parse() : services.pool.submit(Priority::interactive, parse).get();
}

}  // namespace

::tl::expected<ScenePtr, Problem> read_scene(Services& services, std::string_view body) {
  return parse_where_it_fits(services, body, [&] { return parse_whole(body, services.config.limits, ""); });
}

::tl::expected<RenderBody, Problem> read_render_body(Services& services, std::string_view body,
                                                     std::initializer_list<std::string_view> wishes) {
  const auto start = Steady::now();
  auto out = parse_where_it_fits(services, body, [&] { return parse_body(services, body, wishes); });
  if (out) out->parse_ms = ms_since(start);
  return out;
}

::tl::expected<RefineBody, Problem> read_refine_body(std::string_view body, const View& source,
                                                     const RenderReport& report, const Limits& limits) {
  const auto start = Steady::now();
  const auto members = read_members(body, limits);
  if (!members) return ::tl::unexpected(members.error());
  MemberErrors errors;
  errors.check_keys(*members, {"samples", "rmse", "time_ms", "format", "priority"});
  RefineBody out;
  out.format = read_format(*members, errors);
  out.priority = read_word<Priority>(*members, "priority", find_batch_or_normal, {"normal", "batch"}, errors);
  const bool has_rule = std::any_of(std::begin(kRules), std::end(kRules),
                                    [&](std::string_view rule) { return find_member(*members, rule) != nullptr; });
  if (!has_rule)
    errors.add("", "missing_key", "one of 'samples', 'rmse' and 'time_ms' must say how far to go",
               {std::begin(kRules), std::end(kRules)});
  if (!errors.empty()) return errors.problem();
  auto rules = read_rules(body, *members, limits);
  if (!rules) return ::tl::unexpected(rules.error());
  out.view = source;
  RenderSpec& render = out.view.render;
  render.samples = rules->render.samples;
  render.samples_implied = rules->render.samples_implied;
  render.rmse = rules->render.rmse;
  render.time_ms = rules->render.time_ms;
  render.passes.clear();
  add_if_met(render, report, limits, errors);
  check_format(out.format, source, errors);
  if (!errors.empty()) return errors.problem();
  out.parse_ms = ms_since(start);
  return out;
}

::tl::expected<ViewBody, Problem> read_view_body(std::string_view body, const View& base, const Limits& limits) {
  const auto members = read_members(body, limits);
  if (!members) return ::tl::unexpected(members.error());
  MemberErrors errors;
  errors.check_keys(*members, {"seq", "camera", "image", "render", "moving"});
  ViewBody out;
  const JsonMember* seq = find_member(*members, "seq");
  out.seq = (seq ? json_whole_number(seq->value) : std::nullopt).value_or(0);
  if (out.seq < 1) {
    errors.add("seq", seq ? "wrong_type" : "missing_key", "'seq' must be a whole number from 1, larger with each view");
  }
  if (const JsonMember* moving = find_member(*members, "moving")) {
    out.is_moving = moving->value == "true";
    if (!out.is_moving && moving->value != "false")
      errors.add("moving", "wrong_type", "'moving' must be true or false");
  }
  if (!errors.empty()) return errors.problem();
  auto view = parse_view(keep_members(body, *members, {std::begin(kViewKeys), std::end(kViewKeys)}), base, limits);
  if (!view) return scene_problem(view.error());
  out.view = std::move(*view);
  return out;
}

::tl::expected<View, Problem> read_view_query(const Request& request, const View& base, const Limits& limits) {
  struct Param {
    const char *name, *group;
    bool is_vector;
  };
  static constexpr Param kParams[] = {{"position", "camera", true}, {"target", "camera", true},
                                      {"up", "camera", true},       {"fov_y_deg", "camera", false},
                                      {"width", "image", false},    {"height", "image", false},
                                      {"exposure", "image", false}, {"samples", "render", false}};
  std::map<std::string, std::string> groups;
  MemberErrors errors;
  for (const Param& param : kParams) {
    const std::string name = param.name;
    const auto text = request.param(name);
    if (!text) continue;
    const auto value = query_numbers(*text, param.is_vector);
    if (!value) {
      errors.add(std::string(param.group) + "/" + name, "wrong_type",
                 std::string(param.is_vector ? "three numbers with commas, like 4,5,9" : "a number") + "; found '" +
                     std::string(text->substr(0, 64)) + "'" +
                     (text->find(' ') == std::string_view::npos ? "" : " (a + in a query is a blank; write %2B)"));
      continue;
    }
    std::string& group = groups[param.group];
    group += (group.empty() ? "\"" : ", \"") + name + "\": " + *value;
  }
  if (!errors.empty()) return errors.problem();
  std::string text;
  for (const auto& [group, body] : groups) text += (text.empty() ? "\"" : ", \"") + group + "\": {" + body + "}";
  auto view = parse_view("{" + text + "}", base, limits);
  if (!view) {
    // The text was made here: its lines and columns mean nothing to the client. A number that is no JSON is a 422.
    for (SceneError& error : view.error().errors) error.line = error.column = 0;
    if (view.error().kind == SceneErrors::Kind::not_json) view.error().kind = SceneErrors::Kind::invalid;
    return scene_problem(view.error());
  }
  return std::move(*view);
}

}  // namespace tilelight::server
